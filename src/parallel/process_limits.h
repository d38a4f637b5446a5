// Checks the system limits that MPI needs, before MPI starts. If a limit is too low, MPI ends the program, or waits for
// ever, without a message about the reason.
#pragma once

namespace tailwater {

/// Raises the limit on open files of this process and of those it starts, as far as possible. Throws InputError where
/// that limit, or the one on the size of files, is too low for `ranks` of a run on this machine.
void require_room_for_mpi(int ranks = 1);

}  // namespace tailwater
