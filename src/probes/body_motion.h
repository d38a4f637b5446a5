// How a floating body has moved: probe "motion".
#pragma once

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// Columns displacement_x_m .. of the centre of mass from where it is drawn, angle_rad (2D) or the angle times its axis
/// angle_x_rad .. (3D), velocity_x_m_per_s .., and angular_velocity_rad_per_s (2D) or its components (3D). Throws
/// InputError for a body that does not exist.
template <int Dim>
Reading<Dim> motion_reading(const ProbeTable& probe, const CaseSpec& spec);

}  // namespace tailwater
