#include "app/sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <map>
#include <system_error>
#include <utility>

#include "app/processes.h"
#include "app/ranks.h"
#include "app/sweep_plan.h"
#include "app/sweep_table.h"
#include "base/text.h"
#include "case/reader.h"
#include "case/writer.h"
#include "io/folder_lock.h"
#include "io/messages.h"
#include "io/run_folder.h"
#include "io/write_file.h"
#include "results/progress.h"
#include "results/run_info.h"
#include "run/resume.h"

namespace tailwater {
namespace {

namespace fs = std::filesystem;

constexpr auto time_between_looks_at_members = std::chrono::milliseconds(500);

/// Minimum remaining wall time with which a member is started.
constexpr std::chrono::duration<double> min_time_for_a_member(1.0);

/// Largest fraction shown for a running member: it has not ended before its last files are written.
constexpr double largest_share_at_work = 0.999;

/// The time [s] that a run has reached, begun or not.
double time_reached(const fs::path& run) {
  const std::map<std::string, double> step = last_step(run);
  const auto time = step.find("time_s");
  return time == step.end() ? 0.0 : time->second;
}

/// Reads the whole text of a file.
std::string text_of(int file) {
  std::string text;
  char part[4096];
  for (ssize_t size = 0; (size = pread(file, part, sizeof(part), static_cast<off_t>(text.size()))) > 0;) {
    text.append(part, static_cast<std::size_t>(size));
  }
  return text;
}

/// The lines of a member's standard error without "error: ", one after the other.
std::string as_message(const std::string& told) {
  constexpr std::string_view error = "error: ";
  std::vector<std::string_view> lines;
  for (std::string_view line : lines_of(told)) {
    if (line.starts_with(error)) line.remove_prefix(error.size());
    if (!line.empty()) lines.push_back(line);
  }
  return fmt::format("{}", fmt::join(lines, "; "));
}

/// The work grows with the particles, as dx^-Dim, and with the steps, as 1/dx.
double expected_work(const CaseSpec& spec) {
  return spec.time.end * std::pow(spec.particles.spacing, -(spec.general.dimension + 1));
}

class Sweep {
 public:
  Sweep(SweepPlan plan, const std::vector<CaseSpec>& cases, const SweepOptions& options)
      : plan_(std::move(plan)), options_(options), news_(plan_.members.size()) {
    for (std::size_t m = 0; m < plan_.members.size(); ++m) {
      Member member{.folder = options.out / plan_.members[m].folder, .end = cases[m].time.end};
      member.work = expected_work(cases[m]);
      member.is_to_do = member_status(member.folder) != "done";
      member.share = member.is_to_do ? std::min(time_reached(member.folder) / member.end, 1.0) : 1.0;
      members_.push_back(std::move(member));
    }
    share_at_start_ = share();
  }

  ExitCode execute() {
    const std::size_t to_do = count([](const Member& member) { return member.is_to_do; });
    tell("sweep of {} members, {} done already", members_.size(), members_.size() - to_do);
    write_table();
    const AwaitedSignals signals;
    while (true) {
      start_what_can_be(signals);
      if (running() == 0) break;
      take(signals.next(time_between_looks_at_members));
      look_for_stop_file();
      for (std::size_t m = 0; m < members_.size(); ++m) look_at(m);
      progress_.show(share(), [this] { return sweep_progress_line(); });
    }
    return finish();
  }

 private:
  struct Member {
    fs::path folder;
    double end = 0.0;   ///< s
    double work = 0.0;  ///< work of the whole run, in any unit
    bool is_to_do = true;
    double share = 0.0;  ///< fraction of its time that it has reached
    pid_t process = 0;
    int standard_error = -1;
  };

  template <class Condition>
  std::size_t count(const Condition& condition) const {
    return static_cast<std::size_t>(std::count_if(members_.begin(), members_.end(), condition));
  }

  std::size_t running() const {
    return count([](const Member& member) { return member.process != 0; });
  }

  double share() const {
    double all = 0.0;
    double reached = 0.0;
    for (const Member& member : members_) {
      all += member.work;
      reached += member.work * member.share;
    }
    return std::min(reached / all, 1.0);
  }

  std::optional<std::chrono::duration<double>> time_left() const {
    if (!options_.wall_time.limit) return std::nullopt;
    return *options_.wall_time.limit - (std::chrono::steady_clock::now() - options_.wall_time.start);
  }

  void start_what_can_be(const AwaitedSignals& signals) {
    for (std::size_t m = 0; m < members_.size(); ++m) {
      if (running() >= static_cast<std::size_t>(options_.jobs) || is_asked_to_stop_) return;
      if (!members_[m].is_to_do) continue;
      if (const auto left = time_left(); left && *left < min_time_for_a_member) {
        is_asked_to_stop_ = true;
        return;
      }
      start(m, signals);
    }
  }

  void start(std::size_t m, const AwaitedSignals& signals) {
    Member& member = members_[m];
    member.is_to_do = false;
    std::vector<std::string> command{this_program(), "resume", member.folder.string(), "--quiet"};
    if (options_.ranks) command.insert(command.end(), {"-n", std::to_string(*options_.ranks)});
    if (const auto left = time_left()) {
      command.insert(command.end(), {"--wall-time", fmt::format("{:.3f}s", left->count())});
    }
    member.standard_error = memfd_create("errors", MFD_CLOEXEC);
    member.process = signals.start(std::move(command), member.standard_error);
    news_[m] = {.is_running = true, .exit_code = std::nullopt, .message = ""};
    tell("begins: {}", plan_.members[m].folder);
    write_table();
  }

  /// Forwards requests to the sweep to all running members.
  void take(int signal) {
    if (signal == 0 || signal == SIGCHLD) return;
    if (signal != SIGHUP) is_asked_to_stop_ = true;
    for (const Member& member : members_) {
      if (member.process != 0) kill(member.process, signal);
    }
  }

  void look_for_stop_file() {
    std::error_code error;
    if (fs::remove(options_.out / stop_file_name, error)) take(SIGTERM);
  }

  void look_at(std::size_t m) {
    Member& member = members_[m];
    if (member.process == 0) return;
    member.share = std::min(time_reached(member.folder) / member.end, largest_share_at_work);
    const std::optional<int> code = ending_of(member.process);
    if (!code) return;
    if (*code == 0) member.share = 1.0;
    member.process = 0;
    const std::string message = as_message(text_of(member.standard_error));
    close(member.standard_error);
    const bool has_failed = *code != 0 && (is_own_exit_code(*code) || !is_asked_to_stop_) &&
                            *code != static_cast<int>(ExitCode::interrupted);
    news_[m] = {.is_running = false, .exit_code = *code, .message = message};
    if (has_failed) {
      if (!first_failure_) first_failure_ = *code;
      tell_error(fmt::format("{}: {}", member.folder.string(),
                             message.empty() ? fmt::format("ended with exit code {}", *code) : message));
    } else {
      tell("{}: {}", *code == 0 ? "done" : "interrupted", plan_.members[m].folder);
    }
    write_table();
  }

  std::string sweep_progress_line() const {
    const double gained = share() - share_at_start_;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    std::vector<std::string> parts;
    for (std::size_t m = 0; m < members_.size(); ++m) {
      if (members_[m].process == 0) continue;
      parts.push_back(fmt::format("{} {:.0f} %", plan_.members[m].folder, 100.0 * members_[m].share));
    }
    return fmt::format("{:5.1f} %  ETA {}  {} of {} ended{}{}", 100.0 * share(),
                       gained > 0.0 ? readable_duration(elapsed.count() * (1.0 - share()) / gained) : "?",
                       count([](const Member& member) { return !member.is_to_do && member.process == 0; }),
                       members_.size(), parts.empty() ? "" : "  ", fmt::join(parts, "  "));
  }

  void write_table() const {
    write_text_file(options_.out / sweep_table_name, sweep_table(options_.out, plan_, news_));
  }

  ExitCode finish() {
    write_table();
    const std::size_t done = count([](const Member& member) { return member_status(member.folder) == "done"; });
    const std::string table = (options_.out / sweep_table_name).string();
    if (done == members_.size()) {
      tell("done: {} members; table: {}", done, table);
      return ExitCode::done;
    }
    tell("{} of {} members are done; table: {}; to continue with the others: tailwater resume {}", done,
         members_.size(), table, options_.out.string());
    if (is_asked_to_stop_) return ExitCode::interrupted;
    return first_failure_ ? static_cast<ExitCode>(*first_failure_) : ExitCode::interrupted;
  }

  SweepPlan plan_;
  SweepOptions options_;
  std::vector<MemberNews> news_;
  std::vector<Member> members_;
  double share_at_start_ = 0.0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  ProgressLine progress_;
  bool is_asked_to_stop_ = false;
  std::optional<int> first_failure_;
};

/// Throws InputError unless the folder can be that of this sweep. It must be empty, or contain a sweep all of whose
/// members are in this one, with the same cases.
void require_same_sweep(const fs::path& out, const SweepPlan& plan, const std::vector<CaseSpec>& cases) {
  std::error_code error;
  if (!is_sweep(out)) {
    const bool is_free = !fs::exists(out, error) || (fs::is_directory(out, error) && fs::is_empty(out, error));
    if (is_free) return;
    throw InputError("--out {}: exists and is not the folder of a sweep; remedy: choose another name", out.string());
  }
  const SweepPlan earlier = read_sweep_record(out);
  if (earlier.keys != plan.keys) {
    throw InputError("--out {}: has a sweep of {}, not of {}; remedy: choose another name", out.string(),
                     fmt::join(earlier.keys, " and "), fmt::join(plan.keys, " and "));
  }
  for (const SweepMember& member : earlier.members) {
    if (std::find(plan.members.begin(), plan.members.end(), member) != plan.members.end()) continue;
    throw InputError(
        "--out {}: the sweep there has the member {}, which this one has not; remedy: add its values, or another name",
        out.string(), member.folder);
  }
  for (std::size_t m = 0; m < cases.size(); ++m) {
    const fs::path case_file = out / plan.members[m].folder / effective_case_name;
    if (!fs::exists(case_file, error)) continue;
    const CaseSpec found = read_effective_case(case_file);
    if (found == cases[m]) continue;
    throw InputError("'{}' is of another case than this one: {}; remedy: tailwater resume {}, or another --out",
                     case_file.string(), first_difference(cases[m], found), out.string());
  }
}

void require_possible_jobs(const SweepOptions& options) {
  const int ranks = options.ranks.value_or(1);
  if (options.jobs < 1) {
    throw InputError("--jobs {}: at least one member runs at a time; remedy: --jobs 1", options.jobs);
  }
  if (options.jobs > max_ranks_here() / ranks) {
    throw InputError("--jobs {}: this machine's cores can share at most {} ranks; remedy: --jobs {}", options.jobs,
                     max_ranks_here(), std::max(1, usable_cores() / ranks));
  }
  if (ranks_in_environment() > 0) {
    throw InputError("a sweep starts its members itself; remedy: tailwater without mpirun, and -n for each member");
  }
}

void make_sweep_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw_io_error("make the folder", folder, error.value());
}

}  // namespace

ExitCode run_sweep(const fs::path& case_file, const std::vector<std::string>& overrides,
                   const std::vector<std::string>& keys, const SweepOptions& options) {
  require_possible_jobs(options);
  const SweepPlan plan = sweep_plan(keys);
  for (const std::string& text : overrides) {
    const std::string key = text.substr(0, text.find('='));
    if (std::find(plan.keys.begin(), plan.keys.end(), key) == plan.keys.end()) continue;
    throw InputError("--set {}: the key is swept; remedy: leave --set {} out", text, key);
  }
  const std::vector<CaseSpec> cases = cases_of_sweep(case_file, overrides, plan);
  require_same_sweep(options.out, plan, cases);
  make_sweep_folder(options.out);
  const FolderLock lock(options.out);
  open_log(options.out / "log.txt");
  write_sweep_record(options.out, plan);
  for (std::size_t m = 0; m < cases.size(); ++m) {
    const fs::path folder = options.out / plan.members[m].folder;
    make_sweep_folder(folder);
    if (!fs::exists(folder / effective_case_name)) {
      write_text_file(folder / effective_case_name, effective_case(cases[m]));
    }
  }
  return Sweep(plan, cases, options).execute();
}

ExitCode resume_sweep(const SweepOptions& options) {
  require_possible_jobs(options);
  const SweepPlan plan = read_sweep_record(options.out);
  std::vector<CaseSpec> cases;
  for (const SweepMember& member : plan.members) {
    const fs::path case_file = options.out / member.folder / effective_case_name;
    std::error_code error;
    if (!fs::exists(case_file, error)) {
      throw InputError(
          "the sweep in '{}' has no {}; remedy: repeat the command that began it, which restores the missing file",
          options.out.string(), (fs::path(member.folder) / effective_case_name).string());
    }
    cases.push_back(read_effective_case(case_file));
  }
  const FolderLock lock(options.out);
  open_log(options.out / "log.txt");
  return Sweep(plan, cases, options).execute();
}

}  // namespace tailwater
