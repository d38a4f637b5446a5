// Where a body touches another, or a wall, both push each other with the least force that keeps them from going on into
// each other, without friction and without throwing them back. With the gap d and the normal n, the speed apart of a
// OneSidedForce is
//
//   w = d/dt + (V^{n+1} of the one - V^{n+1} of the other) . n,
//
// so that a gap may close within the step but not more than close (docs/theory/floating_bodies.md).
#pragma once

#include "bodies/one_sided_force.h"
#include "motion/body_contact.h"

namespace tailwater {

/// From where a surface is drawn to where it is at `time` [s] of the present step.
template <int Dim>
AffineMap<Dim> placement_of(const Flow<Dim>& flow, const ContactSurface<Dim>& surface, double time);

/// Of all points of bodies that are near a wall or another body; `bodies` are as they are at the start of the step of
/// dt.
template <int Dim>
std::vector<OneSidedForce> find_contacts(const Flow<Dim>& flow, const ContactSurfaces<Dim>& surfaces,
                                         const std::vector<BodyState<Dim>>& bodies, double dt,
                                         std::span<const Freedom> freedoms);

}  // namespace tailwater
