// Rigid motions, and the velocity fields of them.
#pragma once

#include "base/vec.h"

namespace tailwater {

/// x -> linear x + constant: a rigid motion where `linear` is a rotation, or the velocity field of one.
template <int Dim>
struct AffineMap {
  Mat<Dim> linear = Mat<Dim>::Identity();
  Vec<Dim> constant = Vec<Dim>::Zero();

  Vec<Dim> operator()(const Vec<Dim>& x) const { return linear * x + constant; }
  /// Where a rigid motion takes x from.
  Vec<Dim> inverse(const Vec<Dim>& x) const { return linear.transpose() * (x - constant); }
};

/// The motion of a body from its place under `before` to its place under `after`.
template <int Dim>
AffineMap<Dim> displacement_between(const AffineMap<Dim>& before, const AffineMap<Dim>& after);

}  // namespace tailwater
