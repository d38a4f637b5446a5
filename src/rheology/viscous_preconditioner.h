// A preconditioner of the viscous step: the multigrid on cells (linear/cell_multigrid.h), for each component of the
// velocity by itself. Its matrix is the two-point part of the forces (viscous_operator.h),
//
//   inertia_i u_i - w_i sum_j w_j F_ij (mu_i + mu_j) (u_j - u_i) + friction of walls,
//
// which lacks the transposed term that couples the components.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "linear/cell_multigrid.h"
#include "linear/linear_system.h"
#include "rheology/viscous_operator.h"

namespace tailwater {

template <int Dim>
class ViscousPreconditioner {
 public:
  /// `inertia` [kg/s] is of owned particles. Collective.
  ViscousPreconditioner(const Flow<Dim>& flow, const ViscousOperator<Dim>& forces, std::span<const double> inertia);

  /// A velocity [m/s] whose forces nearly are those given [N], of owned particles. Collective.
  void apply(std::span<const Vec<Dim>> force, std::span<Vec<Dim>> velocity);

 private:
  std::vector<double> scale_;  ///< m/(N s); 1/diagonal; 0 of walls and of claimed particles
  LinearSystem rows_;
  std::unique_ptr<CellMultigrid> multigrid_;
  std::vector<double> component_;
  std::vector<double> correction_;
};

}  // namespace tailwater
