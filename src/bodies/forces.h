// What the water does to bodies that float: the reaction of its pair forces, summed over each body's wall particles, so
// that water and bodies keep their momentum together.
#pragma once

#include <vector>

#include "bodies/narrow_gaps.h"

namespace tailwater {

/// Forces and moments on each body while walls and water stay where they are, at `time` [s].
template <int Dim>
class ForcesOnBodies {
 public:
  ForcesOnBodies(const Flow<Dim>& flow, const FloatingBodies<Dim>& bodies, double time)
      : flow_(flow), bodies_(bodies), time_(time) {}

  /// By a pressure field [Pa] that is up to date on ghosts and on the bodies' particles. Collective.
  std::vector<Twist<Dim>> of_pressure(const std::vector<double>& pressure) const;
  /// By the water that their pairs miss beside other walls, in a pressure field that is up to date. Collective.
  std::vector<Twist<Dim>> of_gaps(const std::vector<double>& pressure, const NarrowGaps<Dim>& gaps) const;
  /// By the air of pockets with these pressures [Pa], whose part has been taken out of the other two.
  std::vector<Twist<Dim>> of_air(std::span<const double> pressures) const;
  /// By the friction that the present step has found. Collective.
  std::vector<Twist<Dim>> of_friction() const;
  /// By what the last guard took from the water in front of bodies. Collective.
  std::vector<Twist<Dim>> of_guard() const;

 private:
  const Flow<Dim>& flow_;
  const FloatingBodies<Dim>& bodies_;
  double time_;
};

}  // namespace tailwater
