// What the commands `run` and `resume` have in common on the command line.
#pragma once

#include <CLI/CLI.hpp>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "base/error.h"
#include "parallel/communicator.h"

namespace tailwater {

struct RankArguments {
  std::optional<int> count;
};

/// The options -n and --wall-time.
void add_rank_and_time_options(CLI::App& command, RankArguments& ranks, std::string& wall_time,
                               const std::string& about_ranks);

/// The option --jobs, of sweeps.
void add_jobs_option(CLI::App& command, std::optional<int>& jobs);

/// First of all in a command that runs: what is told goes to the user, on the root alone and unless `quiet`, and the
/// end of the terminal is no reason to die. (Once a run goes, it writes a checkpoint then: run/requests.h.)
void survive_hang_up_and_speak(const Communicator& ranks, bool quiet);

/// Throws InputError for a number of ranks with which this program cannot run.
void require_possible(int ranks);

/// "3h", "90min", "1h30min", "45s" or "2:30:00"; nothing for an empty text. Throws InputError.
std::optional<std::chrono::duration<double>> wall_time_of(const std::string& text);

/// The last line for the user of a run that did not fail.
void tell_end(ExitCode code, const std::filesystem::path& run);

}  // namespace tailwater
