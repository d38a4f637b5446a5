#include "operators/symmetric.h"

#include <Eigen/Eigenvalues>

#include "base/eigen.h"

namespace tailwater {

double min_eigenvalue_of(const Mat<3>& matrix) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(to_eigen(matrix), Eigen::EigenvaluesOnly);
  return solver.eigenvalues()[0];
}

}  // namespace tailwater
