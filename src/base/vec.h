// Small vectors and matrices in Dim = 2 or 3 dimensions.
#pragma once

#include <Eigen/Dense>

#include <cmath>

namespace tailwater {

template <int Dim>
using Vec = Eigen::Matrix<double, Dim, 1>;

template <int Dim>
using Mat = Eigen::Matrix<double, Dim, Dim>;

/// Number of independent entries of a symmetric Dim x Dim tensor: 3 in 2D, 6 in 3D.
template <int Dim>
inline constexpr int symmetric_size = Dim*(Dim + 1) / 2;

/// A length to the power Dim: the area (2D) or volume (3D) of a cube with that edge.
template <int Dim>
constexpr double power(double length) {
  static_assert(Dim == 2 || Dim == 3);
  return Dim == 2 ? length * length : length * length * length;
}

/// The edge of a square of this area (2D) or a cube of this volume (3D).
template <int Dim>
double edge_of(double volume) {
  return Dim == 2 ? std::sqrt(volume) : std::cbrt(volume);
}

}  // namespace tailwater

/// Compiles a function template over Dim, in the source file that defines it.
#define TAILWATER_IN_2D_AND_3D(function)      \
  template decltype(function<2>) function<2>; \
  template decltype(function<3>) function<3>
