// Farmani, Barani & Ghaeini-Hessaroeyeh (2020) as published, after Shao & Lo (2003): gradient (B7), Laplacian and
// viscous term (B8, B9) with each particle's own density, the density error of the predicted positions as source (B17),
// p = 0 where the density is low (B21), a row on the walls that solves the pressure equation with dummies behind it,
// molecular viscosity only. Evidence: docs/theory/two-step.md.
#pragma once

#include "flow/formulation.h"

namespace tailwater {

struct CaseSpec;

template <int Dim>
FlowFormulation<Dim> published_farmani(const CaseSpec& spec);

}  // namespace tailwater
