// Ids of particles that enter through open ends, in a case with several liquids: a range for each end and liquid, so
// that an id is enough to know the liquid (particles/liquids.h).
#pragma once

#include <cstddef>
#include <cstdint>

namespace tailwater {

/// Number of ids of one liquid at one end. No run has so many particles enter there.
inline constexpr std::int64_t ids_in_range = std::int64_t{1} << 40;

/// Number of the range of liquid `liquid` of `liquids` that enters at an end.
inline std::int64_t range_of_inflow(std::size_t end, std::size_t liquid, std::size_t liquids) {
  return static_cast<std::int64_t>(end * liquids + liquid);
}

}  // namespace tailwater
