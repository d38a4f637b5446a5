// The arguments that the commands `run` and `resume` have in common.
#pragma once

#include <CLI/CLI.hpp>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "parallel/communicator.h"
#include "run/run_options.h"

namespace tailwater {

struct RunArguments {
  RunOptions run;
  std::vector<std::string> overrides;
  std::optional<int> ranks;
  std::optional<int> jobs;  ///< of a sweep
  std::string wall_time;
  int pictures = 0;
  bool quiet = false;
};

/// The options -n and --wall-time.
void add_rank_and_time_options(CLI::App& command, RunArguments& arguments, const std::string& about_ranks);

/// The option --jobs, for sweeps.
void add_jobs_option(CLI::App& command, RunArguments& arguments);

/// The options --pictures and --quiet.
void add_picture_and_voice_options(CLI::App& command, RunArguments& arguments);

/// Call first in a command that runs a case. Messages go to the user, from the root alone and unless `quiet`, and
/// SIGHUP no longer ends the process. (A running run writes a checkpoint then: run/requests.h.)
void ignore_hangup_and_open_messages(const Communicator& ranks, bool quiet);

/// Throws InputError for a number of ranks with which this program cannot run.
void require_possible(int ranks);

/// "3h", "90min", "1h30min", "45s" or "2:30:00"; empty for an empty text. Throws InputError.
std::optional<std::chrono::duration<double>> wall_time_of(const std::string& text);

/// Calls `run` with MPI running, prints how the run ended if it did not fail, and draws the pictures.
ExitCode run_here(const RunArguments& arguments, const Communicator& ranks, const std::function<ExitCode()>& run);

}  // namespace tailwater
