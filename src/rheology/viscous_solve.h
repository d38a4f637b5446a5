// The velocity at the end of a viscous step: inertia_i u_i - f_i(u) = rhs_i for all fluid particles, with the forces f
// of viscous_operator.h. The matrix is symmetric and positive, and conjugate gradients solve it.
#pragma once

#include <span>
#include <vector>

#include "rheology/viscous_operator.h"

namespace tailwater {

struct ViscousReport {
  int iterations = 0;
  bool has_converged = false;
};

/// `inertia` [kg/s] and `rhs` [N] are of owned particles; `velocity` [m/s] has the guess, and gets ghosts. Ends where
/// the residual, divided by the diagonal, is `tolerance` times the right-hand side, or after `iterations`. Collective.
template <int Dim>
ViscousReport solve_viscous_step(const Flow<Dim>& flow, const ViscousOperator<Dim>& forces,
                                 std::span<const double> inertia, std::span<const Vec<Dim>> rhs, double tolerance,
                                 int iterations, std::vector<Vec<Dim>>& velocity);

}  // namespace tailwater
