// Lines of bodies: springs without mass that only pull, with the stretch at the start of the step and the speed of
// stretching at its end, so that no damping is too strong for the step.
#pragma once

#include "bodies/one_sided_force.h"
#include "motion/floating_body.h"

namespace tailwater {

/// Those that are stretched; `bodies` are as they are at the start of the step.
template <int Dim>
std::vector<OneSidedForce> find_moorings(const std::vector<Mooring<Dim>>& moorings,
                                         const std::vector<BodyState<Dim>>& bodies, std::span<const Freedom> freedoms);

}  // namespace tailwater
