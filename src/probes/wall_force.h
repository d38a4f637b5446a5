// Force, moment and power of the water on walls, or on a part of them: probe "force".
//
//   F = sum_i P_i f_i,    M = sum_i (r_i - c) x P_i f_i,    power = -sum_i V_i . P_i f_i
//
// f_i is the force on the walls through particle i in the last step (wall_forces.h). The pressure's pair forces count
// half through the wall particle and half through the water particle. So the forces on all walls together equal the
// momentum that the water has lost to them: to round-off, or to a percent where a pressure balances the weight, whose
// integral over the walls is added (pressure/balanced_on_walls.h). P_i f_i is the part of f_i that belongs to the
// selected part of the walls. With the patches k near i,
//
//   P_i = sum over chosen k of A_k (sum over all k of A_k)^-1,    A_k = s_k (1 - |r_i - r_k|/R)^4 (n_k n_k^T + e I)
//
// for pressure; for friction I - n_k n_k^T replaces n_k n_k^T. s is the patch's measure. So in a corner each wall gets
// the part of the pressure's force along its own normal, whatever the angle; beside a border in a flat wall the two
// parts divide the force by distance. docs/theory/probes.md derives this, and the accuracy of each part.
#pragma once

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// Throws InputError for a scheme whose pairs have no reactions, and for walls and regions as chosen_shares does.
template <int Dim>
Reading<Dim> force_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
