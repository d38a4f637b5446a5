#include "geometry/rotation.h"

#include <Eigen/Geometry>

#include <cmath>

#include "base/eigen.h"

namespace tailwater {

Mat<2> rotation_in_plane(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  Mat<2> rotation;
  rotation.put_column(0, {c, s});
  rotation.put_column(1, {-s, c});
  return rotation;
}

Mat<3> rotation_about(const Vec<3>& axis, double angle) {
  return from_eigen<3, 3>(Eigen::AngleAxisd(angle, to_eigen(axis)).toRotationMatrix());
}

Vec<3> rotation_vector_of(const Mat<3>& rotation) {
  const Eigen::AngleAxisd turn{Eigen::Matrix3d(to_eigen(rotation))};
  return turn.angle() * from_eigen<3, 1>(turn.axis());
}

Vec<3> across(const Vec<3>& n) { return from_eigen<3, 1>(to_eigen(n).unitOrthogonal()); }

}  // namespace tailwater
