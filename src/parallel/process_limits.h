// What MPI needs of the system, asked for before it starts: where it gets too little it ends the program, or waits for
// ever, without a word that says why.
#pragma once

namespace tailwater {

/// Raises the limit on open files of this process and of those it starts, as far as it may. Throws InputError where
/// that limit, or the one on the size of files, is too low for `ranks` of a run on this machine.
void require_room_for_mpi(int ranks = 1);

}  // namespace tailwater
