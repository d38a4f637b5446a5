// Contacts between bodies, or between a body and a wall. Both sides react with the least force that prevents
// penetration, without friction and without rebound. With the gap d and the normal n, the opening speed of a
// OneSidedForce is
//
//   w = d/dt + (V^{n+1} of one side - V^{n+1} of the other) . n,
//
// so that a gap may close within the step but not become negative (docs/theory/floating_bodies.md).
#pragma once

#include "bodies/one_sided_force.h"
#include "motion/body_contact.h"

namespace tailwater {

/// The motion from a surface as drawn to its position at `time` [s] of the present step.
template <int Dim>
AffineMap<Dim> placement_of(const Flow<Dim>& flow, const ContactSurface<Dim>& surface, double time);

/// The contacts of all points of bodies that are near a wall or another body. `bodies` is their state at the start of
/// the step of dt.
template <int Dim>
std::vector<OneSidedForce> find_contacts(const Flow<Dim>& flow, const ContactSurfaces<Dim>& surfaces,
                                         const std::vector<BodyState<Dim>>& bodies, double dt,
                                         std::span<const Freedom> freedoms);

}  // namespace tailwater
