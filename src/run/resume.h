// Resumes a run that was stopped, was killed or is done, in its folder.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "case/spec.h"
#include "parallel/communicator.h"
#include "run/run_options.h"

namespace tailwater {

/// Resumes the run in options.out from its newest intact checkpoint, or from its start if it has written none.
/// `overrides` may change the end and the output of the run, but no computed values. On the number of ranks that wrote
/// the checkpoint the results are bit-identical. Throws InputError if the folder is not that of a run, if the
/// checkpoint belongs to another case or has another format, or if an override is not allowed. Throws IoError if
/// checkpoints exist but none is intact, and otherwise the exceptions of run_case. Collective.
ExitCode resume_run(RunOptions options, const std::vector<std::string>& overrides, const Communicator& ranks = {});

/// The first key in which two cases differ: "it has [time] end = 1 instead of [time] end = 2".
std::string first_difference(const CaseSpec& wanted, const CaseSpec& found);

/// The number of ranks that wrote the newest checkpoint in the folder of a run; without a checkpoint that of the run; 1
/// if it is unknown.
int ranks_of_run(const std::filesystem::path& run);

}  // namespace tailwater
