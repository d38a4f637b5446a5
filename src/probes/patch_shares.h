// The patches of walls near a particle, with the weights by which they share its force (docs/theory/probes.md).
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "geometry/facing.h"
#include "probes/force_shares.h"
#include "walls/wetted_patches.h"

namespace tailwater {

/// Relative weight of patches that take no part in a force. It matters only where there are no other patches.
inline constexpr double weight_of_others = 1e-6;

template <int Dim>
class PatchShares {
 public:
  /// A patch near a particle, with its weights.
  struct PatchShare {
    std::int32_t patch;
    Vec<Dim> normal;
    double of_pressure;
    double of_friction;
  };

  /// The sums over all patches near a particle at x, and over the `taken` fractions of them, with weights by size and
  /// distance, within `reach` [m]. The particle's own patches are those whose side it is on: behind the plane for a
  /// wall particle, in front of it for water. The pressure's force counts for all patches except those that face the
  /// nearest own patch. So no force is transferred across a gap or through a thin body. Friction counts for the own
  /// patches. Lists the taken patches if `lists` is true.
  std::pair<Sharing<Dim>, Sharing<Dim>> find(const WettedPatches<Dim>& wetted, const Vec<Dim>& x, double reach,
                                             bool is_water, std::span<const double> taken, bool lists) {
    list_.clear();
    others_.clear();
    Sums own;
    double largest = 0.0;
    Vec<Dim> own_normal = Vec<Dim>::Zero();
    wetted.visit_near(x, [&](const auto& part, const Vec<Dim>& offset) {
      const double squared = offset.squaredNorm();
      if (squared >= reach * reach) return;
      const double nearness = 1.0 - std::sqrt(squared) / reach;
      const double weight = part.measure * (nearness * nearness) * (nearness * nearness);
      const bool is_own = (part.normal.dot(offset) < 0.0) != is_water;
      if (!is_own) {
        others_.push_back({part.patch, part.normal, weight, weight_of_others * weight});
        return;
      }
      own.add(weight, taken[part.patch], part.normal);
      if (lists && taken[part.patch] > 0.0) list_.push_back({part.patch, part.normal, weight, weight});
      if (weight <= largest) return;
      largest = weight;
      own_normal = part.normal;
    });
    Sums beside, opposite;
    for (PatchShare& share : others_) {
      const bool is_opposite = face_each_other<Dim>(share.normal, own_normal);
      (is_opposite ? opposite : beside).add(share.of_pressure, taken[share.patch], share.normal);
      if (is_opposite) share.of_pressure *= weight_of_others;
      if (lists && taken[share.patch] > 0.0) list_.push_back(share);
    }
    const auto sharing_of = [&](Shares<Dim> Sums::*which) {
      Sharing<Dim> sharing{own.*which, own.*which};
      sharing.of_pressure += beside.*which;
      sharing.of_pressure += (opposite.*which).scaled(weight_of_others);
      sharing.of_friction += (beside.*which).scaled(weight_of_others);
      sharing.of_friction += (opposite.*which).scaled(weight_of_others);
      return sharing;
    };
    return {sharing_of(&Sums::all), sharing_of(&Sums::taken)};
  }

  /// The taken patches near the last particle.
  std::span<const PatchShare> list() const { return list_; }

 private:
  /// Sums over some of the patches near a particle.
  struct Sums {
    Shares<Dim> all;
    Shares<Dim> taken;

    void add(double weight, double fraction, const Vec<Dim>& n) {
      all.add(weight, n);
      if (fraction > 0.0) taken.add(fraction * weight, n);
    }
  };

  std::vector<PatchShare> list_;
  std::vector<PatchShare> others_;  ///< those that are not the particle's own
};

}  // namespace tailwater
