// The velocity at the end of a viscous step: inertia_i u_i - f_i(u) = rhs_i for all fluid particles, with the forces f
// of viscous_operator.h. The matrix is symmetric and positive. Conjugate gradients solve it with a multigrid for each
// component (viscous_preconditioner.h). Particles that a part has claimed, as in the buffer of an open end, keep the
// velocity of the guess.
#pragma once

#include <span>
#include <vector>

#include "linear/shell_solver.h"
#include "rheology/viscous_operator.h"

namespace tailwater {

/// `inertia` [kg/s] and `rhs` [N] are of owned particles; `velocity` [m/s] has the guess, and gets ghosts. The residual
/// of the goal is in sqrt(W). Collective.
template <int Dim>
ShellReport solve_viscous_step(const Flow<Dim>& flow, ViscousOperator<Dim>& forces, std::span<const double> inertia,
                               std::span<const Vec<Dim>> rhs, const ShellGoal& goal, std::vector<Vec<Dim>>& velocity);

}  // namespace tailwater
