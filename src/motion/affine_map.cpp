#include "motion/affine_map.h"

namespace tailwater {

template <int Dim>
AffineMap<Dim> displacement_between(const AffineMap<Dim>& before, const AffineMap<Dim>& after) {
  const Mat<Dim> turn = after.linear * before.linear.transpose();
  return {turn, after.constant - turn * before.constant};
}

TAILWATER_IN_2D_AND_3D(displacement_between);

}  // namespace tailwater
