// Small vectors and matrices as Eigen's, for its decompositions.
#pragma once

#include "base/vec.h"

#include <Eigen/Core>

namespace tailwater {

template <int Rows, int Columns>
Eigen::Map<const Eigen::Matrix<double, Rows, Columns>> to_eigen(const SmallMatrix<Rows, Columns>& matrix) {
  return Eigen::Map<const Eigen::Matrix<double, Rows, Columns>>(matrix.data());
}
template <int Rows, int Columns>
Eigen::Map<Eigen::Matrix<double, Rows, Columns>> to_eigen(SmallMatrix<Rows, Columns>& matrix) {
  return Eigen::Map<Eigen::Matrix<double, Rows, Columns>>(matrix.data());
}
template <int Rows, int Columns>
SmallMatrix<Rows, Columns> from_eigen(const Eigen::Matrix<double, Rows, Columns>& matrix) {
  return SmallMatrix<Rows, Columns>::Map(matrix.data());
}

}  // namespace tailwater
