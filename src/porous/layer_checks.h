// Checks of porous layers against the walls, openings and bodies of the case.
#pragma once

#include "case/spec.h"
#include "geometry/boundary.h"
#include "porous/porous_field.h"

namespace tailwater {

/// Throws CaseError for a layer that no water can reach, whose grains are larger than it, that reaches beyond an
/// opening through which it does not continue, or that would have to hold a body.
template <int Dim>
void require_sound_layers(const CaseSpec& spec, const Boundary<Dim>& boundary, const PorousField<Dim>& field);

}  // namespace tailwater
