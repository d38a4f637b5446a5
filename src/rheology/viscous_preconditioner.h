// A preconditioner of the viscous step: the multigrid on cells (linear/cell_multigrid.h), for each component of the
// velocity by itself. Its matrix is the two-point part of the forces (viscous_operator.h),
//
//   inertia_i u_i - w_i sum_j w_j F_ij (mu_i + mu_j) (u_j - u_i) + friction of walls,
//
// which lacks the transposed term that couples the components. The friction of walls along which the liquid slides
// differs between the components, each of which then has a matrix of its own.
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
  /// The matrix of a component, or of all of them.
  struct Matrix {
    explicit Matrix(const Communicator& ranks) : rows(ranks) {}

    std::vector<double> scale;  ///< m/(N s); 1/diagonal; 0 of walls and of claimed particles
    LinearSystem rows;
    std::unique_ptr<CellMultigrid> multigrid;
  };
  void fill(const Flow<Dim>& flow, const ViscousOperator<Dim>& forces, std::span<const double> inertia, int a,
            Matrix& matrix) const;

  std::vector<std::unique_ptr<Matrix>> matrices_;
  std::vector<double> component_;
  std::vector<double> correction_;
};

}  // namespace tailwater
