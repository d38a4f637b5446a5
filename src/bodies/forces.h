// Forces of the water on floating bodies: the reaction to its pair forces, summed over each body's wall particles, so
// that water and bodies conserve momentum together.
#pragma once

#include <optional>
#include <vector>

#include "bodies/narrow_gaps.h"
#include "flow/balanced_pressure.h"

namespace tailwater {

/// Forces and moments on each body for the present positions of walls and water, at `time` [s].
template <int Dim>
class ForcesOnBodies {
 public:
  ForcesOnBodies(const Flow<Dim>& flow, const FloatingBodies<Dim>& bodies, double time)
      : flow_(flow), bodies_(bodies), time_(time) {}

  /// Pressure forces in a field [Pa] that is up to date on ghosts and on the bodies' particles. Collective.
  std::vector<Twist<Dim>> of_pressure(const std::vector<double>& pressure) const;
  /// The part that pairs miss beside other walls, in a pressure field that is up to date. Collective.
  std::vector<Twist<Dim>> of_gaps(const std::vector<double>& pressure, const NarrowGaps<Dim>& gaps) const;
  /// Forces of the air in pockets with these pressures [Pa], whose effect has been removed from the other two.
  std::vector<Twist<Dim>> of_air(std::span<const double> pressures) const;
  /// Excess of the forces of pairs in the balanced pressure (flow/balanced_pressure.h) over its integral on the whole
  /// surface of each body. Nothing for a body that is not in water on all sides below the level. 0 in water that fills
  /// its walls. Collective.
  std::vector<std::optional<Twist<Dim>>> errors_of_pairs() const;
  /// Friction in the present step. Collective.
  std::vector<Twist<Dim>> of_friction() const;
  /// Reaction of the last guard that kept water in front of bodies. Collective.
  std::vector<Twist<Dim>> of_guard() const;

 private:
  /// `thrust`: the sum of the magnitudes of the forces on each body's surface [N].
  std::vector<Twist<Dim>> error_of_pairs(const BalancedPressure<Dim>& balanced, std::vector<double>& thrust) const;

  const Flow<Dim>& flow_;
  const FloatingBodies<Dim>& bodies_;
  double time_;
};

}  // namespace tailwater
