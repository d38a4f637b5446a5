// Detects errors in a case's geometry before a run.
#pragma once

#include "base/finding.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "sampling/fluid_particles.h"

namespace tailwater {

/// The findings of all checks (described in checks/checks.h), in the order of check.cpp. Cost: proportional to
/// particles times faces, and to the cells of size dx that the water can reach.
template <int Dim>
Findings check_geometry(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid);

}  // namespace tailwater
