#include "app/ranks.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>

#include "app/processes.h"
#include "app/temporary_folder.h"
#include "base/text.h"
#include "geometry/from_spec.h"
#include "io/messages.h"
#include "parallel/cores.h"
#include "parallel/process_limits.h"
#include "run/estimate.h"
#include "run/inflow_estimate.h"
#include "run/requests.h"
#include "run/run_case.h"
#include "sampling/particle_count.h"

namespace tailwater {
namespace {

/// The first of these variables that holds a number; -1 if none does.
int number_in_environment(std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const char* text = std::getenv(name);
    char* end = nullptr;
    if (text == nullptr) continue;
    const long number = std::strtol(text, &end, 10);
    if (end != text) return static_cast<int>(number);
  }
  return -1;
}

/// Whether a batch system decides where ranks may run; mpirun queries it.
bool is_in_batch_job() {
  const auto is_set = [](const char* name) { return std::getenv(name) != nullptr; };
  return is_set("SLURM_JOB_ID") || is_set("PBS_JOBID") || is_set("LSB_JOBID");
}

/// The mpirun of the MPI with which this program was built, or one that is in PATH.
std::optional<std::string> find_mpirun() {
  if (access(TAILWATER_MPIRUN, X_OK) == 0) return TAILWATER_MPIRUN;
  const char* path = std::getenv("PATH");
  if (path == nullptr || *path == '\0') return std::nullopt;
  for (const std::string_view place : split(path, ':')) {
    const std::filesystem::path file = std::filesystem::path(place) / "mpirun";
    if (access(file.c_str(), X_OK) == 0) return file.string();
  }
  return std::nullopt;
}

/// Mean number of fluid particles of a run; 0 if they need more memory than there is, which the run will report.
template <int Dim>
double particles_of_water(const CaseSpec& spec) {
  const Boundary<Dim> boundary = make_boundary<Dim>(spec);
  if (!check_memory(spec, boundary, available_memory()).empty()) return 0.0;
  const double of_a_particle = std::pow(spec.particles.spacing, Dim);
  const double at_start = expected_particle_count(spec, boundary).fluid;
  return estimate_water(spec, boundary, at_start * of_a_particle).mean / of_a_particle;
}

/// `session` is a folder of its own for each mpirun; if it is empty, Open MPI chooses one. By default several mpirun
/// use one folder, and one that ends may remove a folder that another is just about to use.
std::vector<std::string> mpirun_command(int count, const std::filesystem::path& session,
                                        const std::vector<std::string>& arguments) {
  // Quiet, because this program reports the exit code of a rank itself.
  std::vector<std::string> command{find_mpirun().value_or("mpirun"), "--quiet", "-n", std::to_string(count)};
  if (!session.empty()) command.insert(command.end(), {"--mca", "orte_tmpdir_base", session.string()});
  if (geteuid() == 0) command.emplace_back("--allow-run-as-root");
  // Otherwise ranks of two simultaneous runs would be bound to the same cores.
  if (!is_in_batch_job())
    command.insert(command.end(), {"--oversubscribe", "--use-hwthread-cpus", "--bind-to", "none"});
  command.push_back(this_program());
  command.insert(command.end(), arguments.begin(), arguments.end());
  return command;
}

struct Ending {
  int code;  ///< exit code, or 128 plus the number of the signal that ended the process
  bool was_asked;
};

/// Waits for mpirun. The first SIGINT, SIGTERM or SIGUSR1 requests the end of the ranks. A second one, or the first
/// when their run has not begun, makes mpirun kill them. SIGHUP requests a checkpoint.
Ending wait_for(pid_t mpirun, const AwaitedSignals& signals, RequestSender& requests) {
  bool was_asked = false;
  while (true) {
    if (const std::optional<int> code = ending_of(mpirun)) return {*code, was_asked};
    const int signal = signals.next();
    if (signal == SIGCHLD) continue;
    if (signal == SIGHUP) {
      requests.ask_for_checkpoint();
      continue;
    }
    if (was_asked || !requests.ask_for_stop()) kill(mpirun, SIGTERM);
    was_asked = true;
  }
}

}  // namespace

int ranks_in_environment() {
  return std::max(0, number_in_environment({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"}));
}

int usable_cores() { return static_cast<int>(usable_processors().size()); }

int max_ranks_here() {
  constexpr int ranks_per_core = 8;
  return is_in_batch_job() ? std::numeric_limits<int>::max() : ranks_per_core * usable_cores();
}

int ranks_by_default(const CaseSpec& spec) {
  if (ranks_in_environment() > 0 || is_in_batch_job()) return 1;
  const int cores = cores_of(usable_processors());
  if (cores == 1 || !find_mpirun()) return 1;
  // docs/scaling.md has the gain by a second rank with this number of particles per rank.
  const bool is_2d = spec.general.dimension == 2;
  const double of_a_rank = is_2d ? 50e3 : 20e3;
  const double water =
      with_places(spec, [&] { return is_2d ? particles_of_water<2>(spec) : particles_of_water<3>(spec); });
  return static_cast<int>(std::clamp(water / of_a_rank, 1.0, static_cast<double>(cores)));
}

bool is_root_in_environment() {
  return number_in_environment({"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"}) <= 0;
}

ExitCode launch_ranks(int count, const std::vector<std::string>& arguments, const std::filesystem::path& out) {
  if (!is_in_batch_job() && count > usable_cores()) {
    warn("more-ranks-than-cores", "{} ranks on {} core(s) take turns; remedy: use -n {}", count, usable_cores(),
         usable_cores());
  }
  require_room_for_mpi(count);
  const TemporaryFolder session;
  const std::vector<std::string> command = mpirun_command(count, session.path(), arguments);
  RequestSender requests(out);
  const AwaitedSignals signals;
  const auto start = [&] {
    try {
      return signals.start(command, STDERR_FILENO);
    } catch (const std::system_error& error) {
      throw InputError("-n {}: cannot start {}: {}; remedy: install openmpi-bin", count, command[0],
                       error.code().message());
    }
  };
  const auto [code, was_asked] = wait_for(start(), signals, requests);
  // Ranks that did not end in order were killed.
  return was_asked && !is_own_exit_code(code) ? ExitCode::interrupted : static_cast<ExitCode>(code);
}

ExitCode end_together(const Communicator& ranks, MPI_Comm meeting, const Outcome& outcome) {
  const bool has_failed = !outcome.message.empty();
  if (ranks.is_alone()) {
    tell_error(outcome.message);
    return outcome.code;
  }
  const int own = has_failed ? static_cast<int>(outcome.code) : 0;
  std::vector<int> codes(static_cast<std::size_t>(ranks.size()));
  MPI_Request all_are_here = MPI_REQUEST_NULL;
  MPI_Iallgather(&own, 1, MPI_INT, codes.data(), 1, MPI_INT, meeting, &all_are_here);
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::seconds(2);
  const std::string name = fmt::format("rank {}: ", ranks.rank());
  for (int are_here = 0; !are_here;) {
    MPI_Test(&all_are_here, &are_here, MPI_STATUS_IGNORE);
    if (has_failed && !are_here && Clock::now() > deadline) {
      tell_error(outcome.message, name);
      MPI_Abort(ranks.handle(), own);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const auto first = std::find_if(codes.begin(), codes.end(), [](int code) { return code != 0; });
  if (first == codes.end()) return outcome.code;
  if (first - codes.begin() == ranks.rank()) tell_error(outcome.message, ranks.is_root() ? "" : name);
  return static_cast<ExitCode>(*first);
}

}  // namespace tailwater
