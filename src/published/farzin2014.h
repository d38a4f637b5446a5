// Farzin, Hassanzadeh, Aalami & Fatehi (2014) as published: consistent operators (F9), (F12) by the tensors of (F10)
// and (F13), p = 0 on marked surface particles, one layer of particles with the wall's pressure condition on the walls
// (F36-F39), artificial viscosity (F3), sub-particle stress (F4-F6), shifting (F28-F32). Runs with it fail after some
// time; the module `robust` has the formulation that works. docs/theory/schemes.md has the reasons, and the differences
// from the paper.
#pragma once

#include "flow/formulation.h"

namespace tailwater {

struct CaseSpec;

/// The order of a step is that of the case: explicit (F14-F17) or repeated (F20-F27).
template <int Dim>
FlowFormulation<Dim> published_farzin(const CaseSpec& spec);

}  // namespace tailwater
