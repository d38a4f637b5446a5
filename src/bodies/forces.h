// What the water does to bodies that float: the reaction of its pair forces, summed over each body's wall particles, so
// that water and bodies keep their momentum together.
#pragma once

#include <vector>

#include "flow/flow.h"

namespace tailwater {

/// Forces and moments on each body by a pressure field [Pa] that is up to date on ghosts, at `time` [s], where the
/// walls are. Collective.
template <int Dim>
std::vector<Twist<Dim>> pressure_on_bodies(const Flow<Dim>& flow, const std::vector<double>& pressure, double time);

/// The same of the friction that the present step has found.
template <int Dim>
std::vector<Twist<Dim>> friction_on_bodies(const Flow<Dim>& flow, double time);

/// What the last guard took from the water in front of bodies, at `time`, where the walls are. Collective.
template <int Dim>
std::vector<Twist<Dim>> guard_on_bodies(const Flow<Dim>& flow, double time);

}  // namespace tailwater
