// What plates hide.
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/boundary.h"
#include "geometry/mesh_surface.h"
#include "geometry/plate_shape.h"

namespace tailwater {
namespace {

/// The front of one piece, without other walls.
Screen<2> bare_screen(const Boundary<2>& boundary, const WallPlate& plate, int piece) {
  const WallFace<2>& face = boundary.faces[plate.first_face + piece];
  const Vec<2> along = face.corners[1] - face.corners[0];
  return {face.corners[0],
          face.normal,
          {along.normalized()},
          {{{0.0, along.norm()}}},
          plate.wall,
          plate.first_face + piece,
          plate.first_face + plate.pieces + piece};
}

/// Whether a plate that ends at `x` and points `out` there ends on a wall that is no plate, nearer to it than `gap`, or
/// behind it. A wall that it points away from, as that of a pipe which opens beside the plate, does not close it.
template <int Dim>
bool is_closed_by_wall(const Boundary<Dim>& boundary, const Vec<Dim>& x, const Vec<Dim>& out, double gap) {
  const WallBesidePlate beside = wall_beside_plate(boundary, x);
  return beside.distance <= gap && boundary.faces[beside.face].normal.dot(out) <= corner_tolerance;
}

/// Whether an edge, looked at in steps of dx, is closed by walls all along.
bool is_closed_by_walls(const Boundary<3>& boundary, const Vec<3>& from, const Vec<3>& to, const Vec<3>& out,
                        double gap) {
  const int last = std::max(1, static_cast<int>(std::ceil((to - from).norm() / (2.0 * gap))));
  for (int k = 0; k <= last; ++k) {
    if (!is_closed_by_wall(boundary, Vec<3>(from + k * (to - from) / last), out, gap)) return false;
  }
  return true;
}

/// How far a plate from a mesh is from where it is drawn.
Vec<3> displacement_of(const Boundary<3>& boundary, const WallPlate& plate) {
  return boundary.faces[plate.first_face].corners[0] - plate.sheet->mesh().corner(0, 0);
}

Screen<3> triangle_screen(const TriangleMesh& mesh, int t, const Vec<3>& moved, const WallPlate& plate, int piece) {
  const Vec<3> corner = mesh.corner(t, 0);
  const Vec<3> along = (mesh.corner(t, 1) - corner).normalized();
  const Vec<3> normal = mesh.area_normal(t).normalized();
  const Vec<3> across = normal.cross(along);
  std::array<Vec<2>, 3> flat;  // the corners, counter-clockwise
  for (int c = 0; c < 3; ++c) {
    const Vec<3> x = mesh.corner(t, c) - corner;
    flat[c] = {along.dot(x), across.dot(x)};
  }
  Screen<3> screen{corner + moved,
                   normal,
                   {along, across},
                   {{{std::min(0.0, flat[2][0]), std::max(flat[1][0], flat[2][0])}, {0.0, flat[2][1]}}},
                   plate.wall,
                   plate.first_face + piece,
                   plate.first_face + plate.pieces + piece};
  for (const int edge : {1, 2}) {
    const Vec<2> to_end = (flat[(edge + 1) % 3] - flat[edge]).normalized();
    screen.cuts[edge - 1] = {{to_end[1], -to_end[0]}, to_end[1] * flat[edge][0] - to_end[0] * flat[edge][1]};
  }
  return screen;
}

/// The screens of one plate, drawn on behind the walls at which it ends.
std::vector<Screen<2>> screens_of(const Boundary<2>& boundary, const WallPlate& plate, double gap, double reach) {
  std::vector<Screen<2>> screens;
  for (int piece = 0; piece < plate.pieces; ++piece) screens.push_back(bare_screen(boundary, plate, piece));
  const WallFace<2>& last = boundary.faces[plate.first_face + plate.pieces - 1];
  const Vec<2> before = -screens.front().along[0];
  const Vec<2> after = screens.back().along[0];
  if (is_closed_by_wall(boundary, screens.front().corner, before, gap)) screens.front().range[0][0] -= reach;
  if (is_closed_by_wall(boundary, last.corners[1], after, gap)) screens.back().range[0][1] += reach;
  return screens;
}

std::vector<Screen<3>> screens_of_sheet(const Boundary<3>& boundary, const WallPlate& plate, double gap, double reach) {
  const Vec<3> moved = displacement_of(boundary, plate);
  const WidenedSheet wide = widened(*plate.sheet, reach, [&](const Vec<3>& from, const Vec<3>& to, const Vec<3>& out) {
    return is_closed_by_walls(boundary, from + moved, to + moved, out, gap);
  });
  std::vector<Screen<3>> screens;
  for (int t = 0; t < static_cast<int>(wide.mesh.triangles.size()); ++t) {
    screens.push_back(triangle_screen(wide.mesh, t, moved, plate, wide.from[t]));
  }
  return screens;
}

std::vector<Screen<3>> screens_of(const Boundary<3>& boundary, const WallPlate& plate, double gap, double reach) {
  if (plate.sheet) return screens_of_sheet(boundary, plate, gap, reach);
  const Screen<3> bare = rectangle_of(boundary, plate);
  Screen<3> screen = bare;
  for (const int axis : {0, 1}) {
    const double length = bare.range[1 - axis][1];
    for (const int end : {0, 1}) {
      const Vec<3> from = bare.corner + bare.range[axis][end] * bare.along[axis];
      const Vec<3> to = from + length * bare.along[1 - axis];
      const double side = end == 0 ? -1.0 : 1.0;
      if (is_closed_by_walls(boundary, from, to, side * bare.along[axis], gap)) screen.range[axis][end] += side * reach;
    }
  }
  return {screen};
}

}  // namespace

template <int Dim>
bool Screen<Dim>::is_between(const Vec<Dim>& from, const Vec<Dim>& to) const {
  const double before = height(from);
  const double after = height(to);
  if ((before >= 0.0) == (after >= 0.0)) return false;
  const Vec<Dim> hit = from + before / (before - after) * (to - from) - corner;
  std::array<double, 2> place{};
  for (int axis = 0; axis < Dim - 1; ++axis) {
    place[axis] = along[axis].dot(hit);
    if (place[axis] < range[axis][0] || place[axis] > range[axis][1]) return false;
  }
  return std::ranges::all_of(
      cuts, [&](const ScreenCut& cut) { return cut.outwards[0] * place[0] + cut.outwards[1] * place[1] <= cut.most; });
}

template <int Dim>
double Screen<Dim>::distance(const Vec<Dim>& x) const {
  double squared = height(x) * height(x);
  for (int axis = 0; axis < Dim - 1; ++axis) {
    const double place = along[axis].dot(x - corner);
    const double beyond = place - std::clamp(place, range[axis][0], range[axis][1]);
    squared += beyond * beyond;
  }
  return std::sqrt(squared);
}

template <int Dim>
Eigen::AlignedBox<double, Dim> Screen<Dim>::box() const {
  Eigen::AlignedBox<double, Dim> box;
  for (int c = 0; c < (Dim == 2 ? 2 : 4); ++c) {
    Vec<Dim> x = corner;
    for (int axis = 0; axis < Dim - 1; ++axis) x += range[axis][c >> axis & 1] * along[axis];
    box.extend(x);
  }
  return box;
}

template <int Dim>
bool is_hidden(std::span<const Screen<Dim>> screens, std::span<const int> near, const Vec<Dim>& from,
               const Vec<Dim>& to, int plate) {
  bool is_behind_own = plate < 0;
  for (const int s : near) {
    const Screen<Dim>& screen = screens[s];
    if (!screen.is_between(from, to)) continue;
    if (screen.wall != plate) return true;
    is_behind_own = true;
  }
  return !is_behind_own;
}

template <int Dim>
void Boundary<Dim>::hang_screens(double closed_gap, double reach) {
  closed_gap_ = closed_gap;
  screen_reach_ = reach;
  screens.clear();
  for (const WallPlate& plate : plates) {
    const std::vector<Screen<Dim>> of_plate = screens_of(*this, plate, closed_gap, reach);
    screens.insert(screens.end(), of_plate.begin(), of_plate.end());
  }
  // What lies exactly behind the rim, as places of a lattice do, is hidden whatever the rounding.
  for (Screen<Dim>& screen : screens) {
    for (std::array<double, 2>& range : screen.range) {
      range[0] -= corner_tolerance * closed_gap;
      range[1] += corner_tolerance * closed_gap;
    }
    for (ScreenCut& cut : screen.cuts) cut.most += corner_tolerance * closed_gap;
  }
  hung_ = FaceGrid<Dim>(reach);
  all_screens_.clear();
  for (int s = 0; s < static_cast<int>(screens.size()); ++s) {
    all_screens_.push_back(s);
    const Eigen::AlignedBox<double, Dim> box = screens[s].box();
    hung_.add(s, box.min(), box.max(), [&](const Vec<Dim>& x) { return screens[s].distance(x); });
  }
}

template struct Screen<2>;
template struct Screen<3>;
template bool is_hidden(std::span<const Screen<2>>, std::span<const int>, const Vec<2>&, const Vec<2>&, int);
template bool is_hidden(std::span<const Screen<3>>, std::span<const int>, const Vec<3>&, const Vec<3>&, int);
template void Boundary<2>::hang_screens(double, double);
template void Boundary<3>::hang_screens(double, double);

}  // namespace tailwater
