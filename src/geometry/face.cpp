#include "geometry/face.h"

#include <algorithm>

#include "base/box.h"

namespace tailwater {

template <int Dim>
double WallFace<Dim>::measure() const {
  if constexpr (Dim == 2) {
    return (corners[1] - corners[0]).norm();
  } else {
    return 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
  }
}

template <int Dim>
WallFace<Dim> WallFace<Dim>::moved(const Vec<Dim>& by) const {
  WallFace face = *this;
  for (Vec<Dim>& corner : face.corners) corner += by;
  return face;
}

template <int Dim>
Box<Dim> WallFace<Dim>::box() const {
  Box<Dim> box;
  for (const Vec<Dim>& corner : corners) box.extend(corner);
  return box;
}

template <int Dim>
Box<Dim> box_around(const std::vector<WallFace<Dim>>& faces) {
  Box<Dim> box;
  for (const WallFace<Dim>& face : faces) box.extend(face.box());
  return box;
}

Vec<2> closest_point(const WallFace<2>& face, const Vec<2>& x) {
  const Vec<2> edge = face.corners[1] - face.corners[0];
  const double squared = edge.squaredNorm();
  if (squared == 0.0) return face.corners[0];
  return face.corners[0] + std::clamp(edge.dot(x - face.corners[0]) / squared, 0.0, 1.0) * edge;
}

// The region of a triangle (corner, edge, inside) that holds the nearest point follows from the signs of the
// barycentric coordinates of the projection: C. Ericson, Real-Time Collision Detection (2005), 5.1.5.
Foot closest_feature(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c, const Vec<3>& x) {
  const Vec<3> ab = b - a;
  const Vec<3> ac = c - a;
  const double ab_a = ab.dot(x - a), ac_a = ac.dot(x - a);
  if (ab_a <= 0.0 && ac_a <= 0.0) return {a, 0};
  const double ab_b = ab.dot(x - b), ac_b = ac.dot(x - b);
  if (ab_b >= 0.0 && ac_b <= ab_b) return {b, 1};
  const double ab_c = ab.dot(x - c), ac_c = ac.dot(x - c);
  if (ac_c >= 0.0 && ab_c <= ac_c) return {c, 2};

  const double weight_c = ab_a * ac_b - ab_b * ac_a;
  if (weight_c <= 0.0 && ab_a >= 0.0 && ab_b <= 0.0) return {a + ab_a / (ab_a - ab_b) * ab, 3};
  const double weight_b = ab_c * ac_a - ab_a * ac_c;
  if (weight_b <= 0.0 && ac_a >= 0.0 && ac_c <= 0.0) return {a + ac_a / (ac_a - ac_c) * ac, 5};
  const double weight_a = ab_b * ac_c - ab_c * ac_b;
  const double towards_c = ac_b - ab_b, towards_b = ab_c - ac_c;
  if (weight_a <= 0.0 && towards_c >= 0.0 && towards_b >= 0.0) {
    return {b + towards_c / (towards_c + towards_b) * (c - b), 4};
  }
  return {a + (weight_b * ab + weight_c * ac) / (weight_a + weight_b + weight_c), -1};
}

Vec<3> closest_point(const WallFace<3>& face, const Vec<3>& x) {
  return closest_feature(face.corners[0], face.corners[1], face.corners[2], x).point;
}

template <int Dim>
Vec<Dim> meet(const WallFace<Dim>& face, const Vec<Dim>& from, const Vec<Dim>& to) {
  const double before = face.height(from);
  return from + before / (before - face.height(to)) * (to - from);
}

template <int Dim>
bool crosses(const WallFace<Dim>& face, const Vec<Dim>& from, const Vec<Dim>& to, double tolerance) {
  const double before = face.height(from);
  const double after = face.height(to);
  if (std::min(before, after) > -tolerance || std::max(before, after) < tolerance) return false;
  const Vec<Dim> hit = meet(face, from, to);
  return (closest_point(face, hit) - hit).norm() <= tolerance;
}

template struct WallFace<2>;
template struct WallFace<3>;
TAILWATER_IN_2D_AND_3D(box_around);
TAILWATER_IN_2D_AND_3D(meet);
TAILWATER_IN_2D_AND_3D(crosses);

}  // namespace tailwater
