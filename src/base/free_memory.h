// Memory that is free inside this process, given back to the system.
#pragma once

#include <malloc.h>

namespace tailwater {

/// Gives back the pages of the heap that no array has: call before large arrays are made for a short time, since those
/// that were freed before may lie in pieces into which the new ones do not fit. Libraries of PETSc's (SuperLU) tell
/// glibc to keep what is freed. A page comes back when it is written to again, so that often is dear.
inline void give_back_free_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace tailwater
