// How a run gets its ranks, and how all of them end it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "case/spec.h"
#include "parallel/communicator.h"

namespace tailwater {

/// Number of ranks with which mpirun, srun or the like started the program that this process belongs to; 0 when nobody
/// did. As the environment says: MPI need not be running.
int ranks_in_environment();

/// Processors that this process may use.
int usable_cores();

/// Most ranks that this program starts: a few per core. No limit in a batch job, whose system knows other machines.
int most_ranks_here();

/// Ranks of a run of which nobody says how many: as many as there are cores to have (parallel/cores.h) and as the case
/// has water for. One where somebody else decides: in a batch job, or where the ranks of mpirun or srun are there; and
/// where there is no mpirun. Throws InputError for shapes that cannot be.
int ranks_by_default(const CaseSpec& spec);

/// Is this the rank that speaks? As above.
bool is_root_in_environment();

/// Starts this program with the same `arguments` on `count` ranks by mpirun and waits for it. Ctrl-C, SIGTERM
/// and SIGUSR1 ask the run to end in order through its folder `out` (run/requests.h), since not every mpirun hands
/// signals on; a second one kills the ranks, as does the first while nothing has been written. SIGHUP asks for a
/// checkpoint. Returns their exit code.
/// Throws InputError when there is no mpirun.
ExitCode launch_ranks(int count, const std::vector<std::string>& arguments, const std::filesystem::path& out);

/// How a command ended: with a message when it failed.
struct Outcome {
  ExitCode code = ExitCode::done;
  std::string message;
};

/// `meeting` has the ranks of `ranks` and is used for nothing else: a rank that waits elsewhere must not be mistaken
/// for one that has come. Shows the error if there is one, and returns the exit code. With several ranks all come here,
/// or all are ended: when every rank has come, one message is shown and all have the same code; a failed rank that has
/// waited two seconds for others, which wait for it elsewhere, shows its message and aborts them.
ExitCode end_together(const Communicator& ranks, MPI_Comm meeting, const Outcome& outcome);

}  // namespace tailwater
