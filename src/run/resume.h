// To go on with a run that was stopped, was killed or is done, in its folder.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "case/spec.h"
#include "parallel/communicator.h"
#include "run/run_options.h"

namespace tailwater {

/// Goes on with the run in options.out from its newest checkpoint that is whole, or from its start if it has written
/// none. `overrides` may change when the run ends and writes, and nothing that was computed. On the number of ranks
/// that wrote the checkpoint the run goes on bit for bit. Throws InputError if the folder is no run's, the checkpoint
/// is of another case or of another format, or an override is not allowed; IoError if checkpoints are there and none is
/// whole; else as run_case. Collective.
ExitCode resume_run(RunOptions options, const std::vector<std::string>& overrides, const Communicator& ranks = {});

/// The first key in which two cases differ: "it has [time] end = 1 instead of [time] end = 2".
std::string first_difference(const CaseSpec& wanted, const CaseSpec& found);

/// The number of ranks that wrote the newest checkpoint in the folder of a run, or of the run as long as there is none;
/// 1 if nothing tells.
int ranks_of_run(const std::filesystem::path& run);

}  // namespace tailwater
