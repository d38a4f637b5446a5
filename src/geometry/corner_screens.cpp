#include "geometry/corner_screens.h"

namespace tailwater {
namespace {

constexpr double min_bend_at_foot = 0.4;  // sine of the angle between faces that make a corner

/// The direction into the corner of the walls at `x`; none if `out` does not lead past it.
template <int Dim>
std::optional<Vec<Dim>> into_corner(const Boundary<Dim>& boundary, const Vec<Dim>& x, const Vec<Dim>& out, int own,
                                    const Lengths& lengths) {
  Vec<Dim> normals = Vec<Dim>::Zero();
  bool leads_past = false;
  boundary.visit_plain_faces([&](int f) {
    const WallFace<Dim>& face = boundary.faces[f];
    if (boundary.walls[face.wall].is_plate || face.wall == own) return;
    if ((closest_point(face, x) - x).norm() > lengths.tolerance()) return;
    normals += face.normal;
    leads_past = leads_past || face.normal.dot(out) > min_bend_at_foot;
  });
  if (!leads_past || normals.norm() < min_bend_at_foot) return std::nullopt;
  return Vec<Dim>(-normals.normalized());
}

}  // namespace

std::optional<Screen<2>> screen_into_corner(const Boundary<2>& boundary, const Screen<2>& last, const Vec<2>& x,
                                            const Vec<2>& out, const Lengths& lengths) {
  const std::optional<Vec<2>> into = into_corner(boundary, x, out, last.wall, lengths);
  if (!into) return std::nullopt;
  const double sense = last.normal.dot(Vec<2>(-out[1], out[0]));
  Screen<2> screen = last;
  screen.corner = x;
  screen.normal = sense * Vec<2>(-(*into)[1], (*into)[0]);
  screen.along = {*into};
  screen.range = {{{0.0, lengths.reach}}};
  return screen;
}

std::optional<Screen<3>> screen_into_corner(const Boundary<3>& boundary, const Screen<3>& last, const Vec<3>& x,
                                            int axis, const Vec<3>& out, const Lengths& lengths) {
  const Vec<3>& edge = last.along[axis];
  const Vec<3> middle = x + 0.5 * last.range[axis][1] * edge;
  const std::optional<Vec<3>> into = into_corner(boundary, middle, out, last.wall, lengths);
  if (!into) return std::nullopt;
  Screen<3> screen = last;
  screen.corner = x;
  screen.normal = (last.normal.dot(edge.cross(out)) * edge.cross(*into)).normalized();
  screen.along = {edge, *into};
  screen.range = {last.range[axis], {0.0, lengths.reach}};
  return screen;
}

}  // namespace tailwater
