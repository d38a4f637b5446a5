// The inertia that the first step of the explicit projection does not have.
//
// The velocity of water and walls is that at mid-step. The first step therefore begins at t = 0 and ends at dt/2 for
// them: walls that start with an acceleration change their velocity by half as much as in any later step, and the
// pressure of the step has half of their inertia. That pressure moves the water. The force at the time of the step is
// that of the whole acceleration. A pressure depends on the acceleration of walls like the solution of linear
// equations, so the missing part is the difference of two pressures at the start, whatever else acts on the water.
#pragma once

#include <optional>
#include <vector>

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// A difference of pressures, and of forces on walls, at the same positions.
template <int Dim>
struct MissingInertia {
  std::vector<double> pressure;        ///< Pa; of all particles
  std::vector<Vec<Dim>> acceleration;  ///< m/s^2; of each row of walls that move
  WallForces<Dim> forces;              ///< those that pressure exerts
};

/// The inertia of walls that change their velocity between the middle and the end of the first step; none in later
/// steps, and for walls that keep their velocity. Call before the step changes anything; it changes nothing either.
/// Collective.
template <int Dim>
std::optional<MissingInertia<Dim>> find_missing_inertia(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// Adds it to the pressure and to the forces, from which probes read. Call where it was computed, after the pressure
/// has moved the water.
template <int Dim>
void add_missing_inertia(const MissingInertia<Dim>& missing, Flow<Dim>& flow);

}  // namespace tailwater
