#include "parallel/process_limits.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

#include "base/error.h"

namespace tailwater {

void require_room_for_mpi(int ranks) {
  // Measured with Open MPI 4.1: one rank starts with 32 open files and not with 24. The shared memory of ranks is a
  // file of 4 MB. The open files of a run itself are additional.
  constexpr rlim_t min_files = 64, files_of_a_rank = 32, enough_files = 4096;
  constexpr rlim_t min_size = rlim_t{16} << 20;
  const rlim_t needed = min_files + files_of_a_rank * static_cast<rlim_t>(ranks);
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  if (files.rlim_cur < files.rlim_max && files.rlim_cur < std::max(needed, enough_files)) {
    files.rlim_cur = std::min(files.rlim_max, std::max(needed, enough_files));
    setrlimit(RLIMIT_NOFILE, &files);
    getrlimit(RLIMIT_NOFILE, &files);
  }
  if (files.rlim_cur < needed) {
    throw InputError("this process may have {} files open, and MPI needs {} for {} rank(s); remedy: ulimit -n {}",
                     files.rlim_cur, needed, ranks, needed);
  }
  rlimit size{};
  getrlimit(RLIMIT_FSIZE, &size);
  if (size.rlim_cur < min_size) {
    throw InputError(
        "this process may write files of {} kB at most, and MPI makes one of several MB; remedy: ulimit -f unlimited",
        size.rlim_cur / 1024);
  }
}

}  // namespace tailwater
