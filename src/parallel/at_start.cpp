#include "parallel/at_start.h"

namespace tailwater {

int ranks_on_this_machine(const Communicator& ranks) {
  if (ranks.is_alone()) return 1;
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(ranks.handle(), MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  int count = 1;
  MPI_Comm_size(machine, &count);
  MPI_Comm_free(&machine);
  return count;
}

}  // namespace tailwater
