#include "app/ranks.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <system_error>
#include <thread>

#include "io/messages.h"
#include "run/requests.h"

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

/// A batch system says where ranks may run; mpirun asks it.
bool is_in_batch_job() {
  const auto is_set = [](const char* name) { return std::getenv(name) != nullptr; };
  return is_set("SLURM_JOB_ID") || is_set("PBS_JOBID") || is_set("LSB_JOBID");
}

std::string find_mpirun() {
  if (access(TAILWATER_MPIRUN, X_OK) == 0) return TAILWATER_MPIRUN;
  return "mpirun";  // looked for in PATH
}

std::vector<std::string> mpirun_command(int count, const std::vector<std::string>& arguments) {
  // Quiet: that a rank ended with an exit code is ours to tell.
  std::vector<std::string> command{find_mpirun(), "--quiet", "-n", std::to_string(count)};
  if (geteuid() == 0) command.emplace_back("--allow-run-as-root");
  // Ranks of two runs at once would be bound to the same cores.
  if (!is_in_batch_job())
    command.insert(command.end(), {"--oversubscribe", "--use-hwthread-cpus", "--bind-to", "none"});
  command.push_back(std::filesystem::read_symlink("/proc/self/exe").string());
  command.insert(command.end(), arguments.begin(), arguments.end());
  return command;
}

/// In the new process: becomes mpirun, or says through `failure` why not.
[[noreturn]] void become_mpirun(std::vector<std::string> command, const sigset_t& signals_before, int failure) {
  setpgid(0, 0);  // Ctrl-C goes to the launching process alone
  sigprocmask(SIG_SETMASK, &signals_before, nullptr);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  std::vector<char*> words;
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  execvp(words[0], words.data());
  const int error_number = errno;
  [[maybe_unused]] const ssize_t written = write(failure, &error_number, sizeof(error_number));
  _exit(127);
}

/// What the launching process waits for. They are taken one by one where it waits, so that it need not do its work in a
/// signal handler.
sigset_t awaited_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1, SIGHUP, SIGCHLD}) sigaddset(&signals, signal);
  return signals;
}

struct Ending {
  int code;  ///< exit code, or 128 and the number of the signal that ended the process
  bool was_asked;
};

/// Waits for mpirun. The first SIGINT, SIGTERM or SIGUSR1 asks the ranks to end in order. A second one, or the first
/// when their run has not begun, makes mpirun kill them. SIGHUP asks for a checkpoint.
Ending wait_for(pid_t mpirun, RequestSender& requests) {
  const sigset_t signals = awaited_signals();
  bool was_asked = false;
  int status = 0;
  while (waitpid(mpirun, &status, WNOHANG) == 0) {
    int signal = 0;
    sigwait(&signals, &signal);
    if (signal == SIGCHLD) continue;
    if (signal == SIGHUP) {
      requests.ask_for_checkpoint();
      continue;
    }
    if (was_asked || !requests.ask_for_stop()) kill(mpirun, SIGTERM);
    was_asked = true;
  }
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), was_asked};
}

}  // namespace

int ranks_in_environment() {
  return std::max(0, number_in_environment({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"}));
}

int usable_cores() {
  cpu_set_t cores;
  return sched_getaffinity(0, sizeof(cores), &cores) == 0 ? CPU_COUNT(&cores) : 1;
}

int most_ranks_here() {
  constexpr int ranks_per_core = 8;
  return is_in_batch_job() ? std::numeric_limits<int>::max() : ranks_per_core * usable_cores();
}

bool is_root_in_environment() {
  return number_in_environment({"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"}) <= 0;
}

ExitCode launch_ranks(int count, const std::vector<std::string>& arguments, const std::filesystem::path& out) {
  if (!is_in_batch_job() && count > usable_cores()) {
    warn(fmt::format("{} ranks on {} core(s) take turns; remedy: -n {}", count, usable_cores(), usable_cores()));
  }
  const std::vector<std::string> command = mpirun_command(count, arguments);
  int failure[2];
  if (pipe2(failure, O_CLOEXEC) != 0) throw IoError("cannot make a pipe: " + std::generic_category().message(errno));
  RequestSender requests(out);
  const sigset_t signals = awaited_signals();
  sigset_t signals_before;
  sigprocmask(SIG_BLOCK, &signals, &signals_before);
  std::signal(SIGCHLD, SIG_DFL);  // whoever ignores it hands that on, and would get no word of mpirun's end
  const pid_t process = fork();
  if (process < 0) throw IoError("cannot start a process: " + std::generic_category().message(errno));
  if (process == 0) become_mpirun(command, signals_before, failure[1]);
  close(failure[1]);
  int error_number = 0;
  const bool has_failed = read(failure[0], &error_number, sizeof(error_number)) == sizeof(error_number);
  close(failure[0]);
  const auto [code, was_asked] = wait_for(process, requests);
  if (has_failed) {
    throw InputError(fmt::format("-n {}: cannot start {}: {}; remedy: install openmpi-bin", count, command[0],
                                 std::generic_category().message(error_number)));
  }
  // Ranks that did not end in order were killed.
  const bool is_ours = code == 0 || code == 2 || code == 3 || code == 4;
  return was_asked && !is_ours ? ExitCode::interrupted : static_cast<ExitCode>(code);
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
