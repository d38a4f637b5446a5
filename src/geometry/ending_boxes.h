// Boxes in 3D that end in the water or in the air at an open face, such as the floor of a free overfall.
#pragma once

#include "case/spec.h"
#include "geometry/boundary.h"

namespace tailwater {

/// Makes meshes of the boxes that have a free rim at another face than their top: their wall particles then end there
/// as those of other walls do (rim_ends.h). The rim of an open top alone does not count, because water that stays below
/// it does not reach it. The other boxes keep their own lattice.
void make_meshes_of_ending_boxes(const CaseSpec& spec, Boundary<3>& boundary);

}  // namespace tailwater
