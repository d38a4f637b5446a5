// A run: from a validated case to a folder of results.
#pragma once

#include "base/finding.h"
#include "case/spec.h"
#include "io/sealed_file.h"
#include "parallel/communicator.h"
#include "run/run_options.h"

namespace tailwater {

/// Remedy for a case that needs more memory than is available.
inline constexpr const char* remedy_for_memory = "remedy: a larger particles.spacing (see: tailwater check)";

/// Calls `work`, and adds the positions in the case file to a CaseError that it throws.
template <class Work>
auto with_places(const CaseSpec& spec, const Work& work) {
  try {
    return work();
  } catch (const CaseError& error) {
    throw CaseError(spec.sources.located(error.findings()));
  }
}

/// Warnings are left out where an earlier run of the case has printed them, or its own run will.
enum class CaseWarnings { told, left_out };

/// Checks the case's geometry as `check` does; `run` calls it before anything is written. Warnings are printed by
/// io/messages.h. Throws CaseError with all errors found.
void require_sound_geometry(const CaseSpec& spec, const Communicator& ranks = {},
                            CaseWarnings warnings = CaseWarnings::told);

/// Runs the case to its end, or until it is interrupted, on all ranks together. Returns done or interrupted. Throws
/// InputError and IoError before anything is written. Throws SolverError when a step fails; summary.json then has the
/// failure, and failure/ holds the last good fields. If memory is exhausted, summary.json has the failure too, but
/// there are no such fields. Throws a later IoError on all ranks; summary.json records it if it can be written. Resumes
/// from `checkpoint` if it is given on the root.
ExitCode run_case(const CaseSpec& spec, const RunOptions& options, const Communicator& ranks = {},
                  const SealedFile* checkpoint = nullptr);

}  // namespace tailwater
