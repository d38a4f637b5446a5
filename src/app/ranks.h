// The start of the ranks of a run, and their common end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "case/spec.h"
#include "parallel/communicator.h"

namespace tailwater {

/// Number of ranks with which mpirun, srun or the like started the program that this process belongs to; 0 if it was
/// started otherwise. Uses the environment only: MPI need not be running.
int ranks_in_environment();

/// Processors that this process may use.
int usable_cores();

/// Largest number of ranks that this program starts: a few per core. No limit in a batch job, whose system can use
/// other machines.
int max_ranks_here();

/// The default number of ranks of a run: as many as there are free cores (parallel/cores.h) and as the case has water
/// for. It is 1 where the number is set elsewhere (in a batch job, or by mpirun or srun), and where there is no mpirun.
/// Throws InputError for impossible shapes.
int ranks_by_default(const CaseSpec& spec);

/// Whether this is the rank that prints messages, from the environment only.
bool is_root_in_environment();

/// Starts this program with the same `arguments` on `count` ranks by mpirun and waits for it. Ctrl-C, SIGTERM and
/// SIGUSR1 request the end of the run through its folder `out` (run/requests.h), since not every mpirun forwards
/// signals. A second one kills the ranks, as does the first while nothing has been written. SIGHUP requests a
/// checkpoint. Returns the exit code of the ranks. Throws InputError when there is no mpirun.
ExitCode launch_ranks(int count, const std::vector<std::string>& arguments, const std::filesystem::path& out);

/// The end of a command: with a message if it failed.
struct Outcome {
  ExitCode code = ExitCode::done;
  std::string message;
};

/// Shows the error if there is one, and returns the exit code. `meeting` has the ranks of `ranks` and is used only
/// here, so that a rank that waits elsewhere is not counted as arrived. With several ranks all arrive here, or all are
/// ended. When every rank has arrived, one message is shown and all have the same code. A failed rank that has waited
/// two seconds for others, which wait for it elsewhere, shows its message and aborts them.
ExitCode end_together(const Communicator& ranks, MPI_Comm meeting, const Outcome& outcome);

}  // namespace tailwater
