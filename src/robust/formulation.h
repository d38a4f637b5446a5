// The default formulation, with the order of scheme F or of scheme B.
#pragma once

#include "flow/formulation.h"

namespace tailwater {

struct CaseSpec;

/// The order of a step is the explicit projection, its implicit form with a second projection, or the two-step scheme
/// (docs/theory/schemes.md, two-step.md).
template <int Dim>
FlowFormulation<Dim> robust_farzin(const CaseSpec& spec);
template <int Dim>
FlowFormulation<Dim> robust_farmani(const CaseSpec& spec);

}  // namespace tailwater
