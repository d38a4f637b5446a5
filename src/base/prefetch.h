// Asking memory for what a loop over long arrays will read. Processors guess that themselves, but not far enough ahead,
// and not across the end of a page.
#pragma once

#include <cstdint>

namespace tailwater {

/// Asks for what stands two thousand bytes behind `place`, be there something or not: what a loop reads several rows
/// later.
inline void fetch_ahead(const void* place) {
  constexpr std::uintptr_t bytes = 2048;
  __builtin_prefetch(reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(place) + bytes));
}

}  // namespace tailwater
