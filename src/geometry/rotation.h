// Rotations as matrices, and directions across others.
#pragma once

#include "base/vec.h"

namespace tailwater {

/// By an angle [rad], counter-clockwise.
Mat<2> rotation_in_plane(double angle);

/// By an angle [rad] about an axis of length 1.
Mat<3> rotation_about(const Vec<3>& axis, double angle);

/// The angle of a rotation [rad], times its axis.
Vec<3> rotation_vector_of(const Mat<3>& rotation);

/// A unit vector across a vector other than 0.
Vec<3> across(const Vec<3>& n);

}  // namespace tailwater
