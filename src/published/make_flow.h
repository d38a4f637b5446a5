// The only place that depends on the formulation of a case.
#pragma once

#include "flow/flow.h"

namespace tailwater {

template <int Dim>
FlowFormulation<Dim> make_formulation(const CaseSpec& spec);

/// The flow of a case. Collective. Throws InputError for an impossible geometry.
template <int Dim>
Flow<Dim> make_flow(const CaseSpec& spec, const Communicator& ranks = {});

}  // namespace tailwater
