// Whether a force probe takes all, some or none of the patches near a place. Where it takes all or none, the force
// through a particle need not be divided between patches.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>

#include "geometry/point_grid.h"
#include "walls/wetted_patches.h"

namespace tailwater {

/// The patches within reach of a place, by the part of them that is taken.
struct NearbyPart {
  enum class Kind { none, all, some };
  Kind kind = Kind::some;
  std::int32_t patch = -1;  ///< of `all`, one of them; they move alike
};

/// The parts at the cells of a grid, each computed when a place in it is read first. A cell where only some places have
/// other patches in reach counts as `some`.
template <int Dim>
class NearbyParts {
 public:
  void clear() { cells_.clear(); }

  /// `least` [m] is the least reach of a place, at most that of the patches. `taken` has the fraction of each patch,
  /// `mover` a number of each patch, equal for patches that move alike. Both must be the same until `clear`.
  template <class Mover>
  NearbyPart at(const Vec<Dim>& x, const WettedPatches<Dim>& wetted, double least, std::span<const double> taken,
                Mover&& mover) {
    constexpr double edges_per_reach = 2.0;
    const double edge = wetted.reach() / edges_per_reach;
    const Cell<Dim> cell = cell_of<Dim>(x, edge);
    const auto [known, is_new] = cells_.try_emplace(cell_key<Dim>(cell));
    if (is_new) known->second = in_cell(cell, edge, wetted, least, taken, mover);
    return known->second;
  }

 private:
  template <class Mover>
  static NearbyPart in_cell(const Cell<Dim>& cell, double edge, const WettedPatches<Dim>& wetted, double least,
                            std::span<const double> taken, const Mover& mover) {
    Box<Dim> box;
    for (const double side : {0.0, 1.0}) {
      Vec<Dim> corner;
      for (int d = 0; d < Dim; ++d) corner[d] = (static_cast<double>(cell[d]) + side) * edge;
      box.extend(corner);
    }
    const double half_diagonal = 0.5 * (box.max() - box.min()).norm();
    const Vec<Dim> centre = 0.5 * (box.min() + box.max());
    NearbyPart part{NearbyPart::Kind::none};
    bool has_other = false;
    bool is_near_all_places = false;
    wetted.visit_near(box, [&](std::int32_t k, const Vec<Dim>& x) {
      if (box.exteriorDistance(x) >= wetted.reach()) return;
      is_near_all_places = is_near_all_places || (x - centre).norm() + half_diagonal < least;
      const bool moves_alike = part.patch < 0 || mover(k) == mover(part.patch);
      has_other = has_other || taken[k] < 1.0 || !moves_alike;
      if (taken[k] > 0.0) part = {NearbyPart::Kind::all, k};
    });
    if (part.kind == NearbyPart::Kind::all && (has_other || !is_near_all_places)) part.kind = NearbyPart::Kind::some;
    return part;
  }

  std::unordered_map<std::uint64_t, NearbyPart> cells_;
};

}  // namespace tailwater
