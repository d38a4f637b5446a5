// The liquid of each particle of a case that has several. The particles of the blocks of a case have ids that follow
// each other, and no id is reused, so an id is enough.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tailwater {

struct ParticleLiquids {
  std::vector<std::int64_t> end;      ///< of the ids of each block; empty: the case has one liquid
  std::vector<int> of_block;          ///< the liquid of each block
  std::vector<double> density;        ///< kg/m^3; of each liquid
  std::vector<std::uint8_t> is_thin;  ///< whether each liquid has the viscous forces of water, against noise too

  bool are_several() const { return !end.empty(); }
  /// The liquid of a fluid particle; 0 if the case has one.
  int of(std::int64_t id) const {
    if (!are_several()) return 0;
    const auto block = std::upper_bound(end.begin(), end.end(), id) - end.begin();
    return of_block[std::min(static_cast<std::size_t>(block), of_block.size() - 1)];
  }
};

}  // namespace tailwater
