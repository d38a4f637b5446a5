// Background cells for a multigrid (find_cells.h makes them).
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace tailwater {

/// The cell of each unknown of this rank. Cells are numbered so that the 2^dimension which make up one twice as large
/// have consecutive numbers. The number of the larger cell is theirs without the last `dimension` bits.
struct Cells {
  static constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();

  int dimension = 0;
  std::vector<std::uint64_t> number;  ///< or `none`, for unknowns that follow from others
};

}  // namespace tailwater
