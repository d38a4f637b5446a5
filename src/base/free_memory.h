// Returns memory that is free inside this process to the system.
#pragma once

#include <malloc.h>

namespace tailwater {

/// Returns unused pages of the heap. Call before large temporary arrays are made, because the memory of freed arrays
/// may be in fragments that are too small for them. Libraries of PETSc (SuperLU) make glibc keep freed memory. A
/// returned page must be provided again at the next write, so frequent calls are expensive.
inline void give_back_free_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace tailwater
