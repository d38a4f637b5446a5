#include "app/run_arguments.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <csignal>
#include <string_view>

#include "app/pictures.h"
#include "app/ranks.h"
#include "io/messages.h"
#include "linear/session.h"

namespace tailwater {
namespace {

/// Takes a number off the front; empty if there is none.
std::optional<double> take_number(std::string_view& text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed);
  if (error != std::errc{} || number < 0.0) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

/// Hours, minutes and seconds with colons between.
std::optional<double> seconds_by_colons(std::string_view text) {
  double seconds = 0.0;
  for (int parts = 1; parts <= 3; ++parts) {
    const std::optional<double> number = take_number(text);
    if (!number) return std::nullopt;
    seconds = 60.0 * seconds + *number;
    if (text.empty()) return parts == 3 ? std::optional(seconds) : std::nullopt;
    if (text.front() != ':') return std::nullopt;
    text.remove_prefix(1);
  }
  return std::nullopt;
}

/// Numbers with units, one after the other.
std::optional<double> seconds_by_units(std::string_view text) {
  struct Unit {
    std::string_view name;
    double seconds;
  };
  constexpr std::array<Unit, 5> units{{{"min", 60.0}, {"d", 86400.0}, {"h", 3600.0}, {"m", 60.0}, {"s", 1.0}}};
  double seconds = 0.0;
  while (!text.empty()) {
    const std::optional<double> number = take_number(text);
    const auto* unit =
        std::find_if(units.begin(), units.end(), [text](const Unit& u) { return text.starts_with(u.name); });
    if (!number || unit == units.end()) return std::nullopt;
    seconds += *number * unit->seconds;
    text.remove_prefix(unit->name.size());
  }
  return seconds;
}

}  // namespace

void add_rank_and_time_options(CLI::App& command, RunArguments& arguments, const std::string& about_ranks) {
  command.add_option("-n", arguments.ranks, about_ranks)->type_name("COUNT");
  command
      .add_option("--wall-time", arguments.wall_time,
                  "Time available, for example 3h, 1h30min or 12:00:00. The run writes a checkpoint and stops in "
                  "time.")
      ->type_name("TIME");
}

void add_jobs_option(CLI::App& command, RunArguments& arguments) {
  command.add_option("--jobs", arguments.jobs, "Number of sweep members that run at the same time (default: 1)")
      ->type_name("COUNT");
}

void add_picture_and_voice_options(CLI::App& command, RunArguments& arguments) {
  command
      .add_option("--pictures", arguments.pictures,
                  "Draw N images when the run ends; in 3D also write the water surface as a mesh for each field file "
                  "(see: tailwater pictures)")
      ->check(CLI::Range(1, 100000).description(""))
      ->type_name("N");
  command.add_flag("--quiet", arguments.quiet, "Print neither progress nor warnings");
}

void ignore_hangup_and_open_messages(const Communicator& ranks, bool quiet) {
  std::signal(SIGHUP, SIG_IGN);
  if (ranks.is_root()) {
    set_voice(quiet ? Voice::quiet : Voice::aloud);
  } else {
    set_voice(Voice::silent);
  }
}

void require_possible(int ranks) {
  if (ranks < 1) throw InputError("-n {}: a run has at least one rank; remedy: -n 2, or leave -n out", ranks);
  if (const int most = max_ranks_here(); ranks > most) {
    throw InputError(
        "-n {}: this machine's cores can share at most {} ranks; remedy: -n {}, or more nodes in a batch job", ranks,
        most, usable_cores());
  }
  const int started = ranks_in_environment();
  if (started > 0 && ranks != started) {
    throw InputError("-n {}: mpirun (or srun) has started {} rank(s) already; remedy: leave -n out", ranks, started);
  }
}

std::optional<std::chrono::duration<double>> wall_time_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  std::optional<double> seconds = seconds_by_colons(text);
  if (!seconds) seconds = seconds_by_units(text);
  if (!seconds || !(*seconds > 0.0)) {
    throw InputError(
        "--wall-time {}: not a time above 0; remedy: a number with its unit, as in 3h, 90min, 1h30min or 45s, or "
        "hours:minutes:seconds, as in 12:00:00",
        text);
  }
  return std::chrono::duration<double>(*seconds);
}

ExitCode run_here(const RunArguments& arguments, const Communicator& ranks, const std::function<ExitCode()>& run) {
  std::optional<LinearSession> session;  // several ranks have one already
  if (ranks.is_alone()) session.emplace();
  const ExitCode code = run();
  const std::string out = arguments.run.out.string();
  if (code == ExitCode::done) {
    tell("done: results in {}", out);
  } else {
    tell("interrupted: results in {}; to continue: tailwater resume {}", out, out);
  }
  if (arguments.pictures > 0) draw_pictures(out, arguments.pictures, ranks);
  return code;
}

}  // namespace tailwater
