// Water that walls, films and dry contacts close off from all other water (sealed_water.cpp).
#pragma once

#include <cstddef>
#include <vector>

#include "flow/flow.h"

namespace tailwater {

class LinearSystem;

/// Water in spaces that walls, films and dry contacts close off.
struct SealedWater {
  /// An owned particle beside a film or a contact.
  struct Rim {
    std::size_t i;
    double pressure;  ///< Pa; at its place, with the head of the water beyond
  };
  /// An owned particle of a space.
  struct Member {
    std::size_t i;
    std::size_t space;
  };
  std::vector<Rim> rims;
  std::vector<Member> members;
  std::size_t spaces = 0;  ///< the same on all ranks

  bool is_any() const { return spaces > 0; }
};

/// Changes the rows of sealed water: on average it does not expand, and beside films water passes to and from the
/// pressure beyond. Collective.
template <int Dim>
void let_through_films(const SealedWater& sealed, Flow<Dim>& flow);
/// Changes rows of a correction to such a pressure, before they have sources.
void let_correction_through_films(const SealedWater& sealed, LinearSystem& rows);

}  // namespace tailwater
