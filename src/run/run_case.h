// A run: from a validated case to a folder of results.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "case/spec.h"
#include "io/run_folder.h"
#include "parallel/communicator.h"

namespace tailwater {

struct RunOptions {
  std::filesystem::path case_file;  ///< named in the summary
  std::filesystem::path out;
  bool force = false;  ///< replace the results of an earlier run
  bool quiet = false;  ///< no progress lines
};

/// The case's geometry as `check` sees it; called by `run` before anything is written. Warnings go to standard error.
/// Throws InputError with all errors found.
void require_sound_geometry(const CaseSpec& spec, bool quiet);

/// Runs the case to its end, or until it is interrupted, on all ranks together. Returns done or interrupted. Throws
/// InputError and IoError before anything is written, SolverError when a step fails; summary.json then says so, and
/// failure/ holds the last good fields. An IoError of later is thrown only on the rank that met it.
ExitCode run_case(const CaseSpec& spec, const RunOptions& options, const Communicator& ranks = {});

}  // namespace tailwater
