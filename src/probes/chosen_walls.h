// The part of the walls that a probe selects.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "case/spec.h"
#include "geometry/wall_patches.h"

namespace tailwater {

/// The walls that a probe names (all, if it names none), inside its region, if it has one. `boundary` is as drawn.
/// Throws InputError for an unknown wall, which lists the known ones.
template <int Dim>
class ChosenWalls {
 public:
  ChosenWalls(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

  bool is_named(int wall) const { return named_[wall] != 0; }
  bool has_region() const { return static_cast<bool>(is_inside_); }
  bool contains(int wall, const Vec<Dim>& x) const { return is_named(wall) && (!is_inside_ || is_inside_(x)); }

 private:
  std::vector<std::uint8_t> named_;                 ///< by wall
  std::function<bool(const Vec<Dim>&)> is_inside_;  ///< empty if there is no region
};

/// The selected fraction of each patch, 0 to 1. Throws InputError as above, and if nothing is selected.
template <int Dim>
std::vector<double> chosen_shares(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary,
                                  std::span<const WallPatch<Dim>> patches);

}  // namespace tailwater
