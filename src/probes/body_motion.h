// The motion of a floating body: probe "motion".
#pragma once

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// Throws InputError for a body that does not exist.
template <int Dim>
Reading<Dim> motion_reading(const ProbeTable& probe, const CaseSpec& spec);

}  // namespace tailwater
