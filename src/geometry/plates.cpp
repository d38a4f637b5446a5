// Plates: what they hide, and the particles on both of their sides.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/mesh_surface.h"
#include "geometry/wall_layers.h"

namespace tailwater {
namespace {

/// The front of one piece, without other walls: a segment, or the rectangle of two triangles.
Screen<2> bare_screen(const Boundary<2>& boundary, const WallPlate& plate, int piece) {
  const WallFace<2>& face = boundary.faces[plate.first_face + piece];
  const Vec<2> way = face.corners[1] - face.corners[0];
  return {face.corners[0],
          face.normal,
          {way.normalized()},
          {{{0.0, way.norm()}}},
          plate.wall,
          plate.first_face + piece,
          plate.first_face + plate.pieces + piece};
}

Screen<3> bare_screen(const Boundary<3>& boundary, const WallPlate& plate) {
  const WallFace<3>& face = boundary.faces[plate.first_face];
  const Vec<3> far_corner = boundary.faces[plate.first_face + 1].corners[2];
  const Vec<3> first = face.corners[1] - face.corners[0];
  const Vec<3> second = far_corner - face.corners[0];
  return {face.corners[0],
          face.normal,
          {first.normalized(), second.normalized()},
          {{{0.0, first.norm()}, {0.0, second.norm()}}},
          plate.wall,
          plate.first_face,
          plate.first_face + plate.pieces};
}

/// Whether a place is on a wall that is no plate, nearer to it than `gap`, or behind it.
template <int Dim>
bool is_closed_by_wall(const Boundary<Dim>& boundary, const Vec<Dim>& x, double gap) {
  double nearest = std::numeric_limits<double>::max();
  double height = 0.0;
  boundary.visit_plain_faces([&](int f) {
    const WallFace<Dim>& face = boundary.faces[f];
    if (boundary.walls[face.wall].is_plate) return;
    const double distance = (closest_point(face, x) - x).norm();
    if (distance > nearest) return;
    nearest = distance;
    height = face.height(x);
  });
  if (nearest <= gap || height < 0.0) return true;
  return std::ranges::any_of(boundary.meshes, [&](const WallMesh& mesh) {
    return boundary.height_above(mesh, x, std::numeric_limits<double>::infinity()) <= gap;
  });
}

/// The screens of one plate, drawn on behind the walls at which it ends.
std::vector<Screen<2>> screens_of(const Boundary<2>& boundary, const WallPlate& plate, double gap, double reach) {
  std::vector<Screen<2>> screens;
  for (int piece = 0; piece < plate.pieces; ++piece) screens.push_back(bare_screen(boundary, plate, piece));
  const WallFace<2>& last = boundary.faces[plate.first_face + plate.pieces - 1];
  if (is_closed_by_wall(boundary, screens.front().corner, gap)) screens.front().range[0][0] -= reach;
  if (is_closed_by_wall(boundary, last.corners[1], gap)) screens.back().range[0][1] += reach;
  return screens;
}

std::vector<Screen<3>> screens_of(const Boundary<3>& boundary, const WallPlate& plate, double gap, double reach) {
  const Screen<3> bare = bare_screen(boundary, plate);
  Screen<3> screen = bare;
  for (const int axis : {0, 1}) {
    const double length = bare.range[1 - axis][1];
    for (const int end : {0, 1}) {
      const int last = std::max(1, static_cast<int>(std::ceil(length / (2.0 * gap))));  // steps of dx along the edge
      bool is_closed = true;
      for (int k = 0; k <= last && is_closed; ++k) {
        const Vec<3> x =
            bare.corner + bare.range[axis][end] * bare.along[axis] + k * length / last * bare.along[1 - axis];
        is_closed = is_closed_by_wall(boundary, x, gap);
      }
      if (is_closed) screen.range[axis][end] += (end == 0 ? -1.0 : 1.0) * reach;
    }
  }
  return {screen};
}

/// The faces of one side of a plate, drawn on in its plane by `reach` beyond each end: what the plate hides from a
/// particle widens behind it.
Boundary<2> widened_side(const Boundary<2>& boundary, const WallPlate& plate, bool is_front, double reach) {
  Boundary<2> side;
  side.walls = boundary.walls;
  const auto from = boundary.faces.begin() + plate.first_face + (is_front ? 0 : plate.pieces);
  side.faces.assign(from, from + plate.pieces);
  // The corners of a back run the other way.
  WallFace<2>& first = side.faces.front();
  WallFace<2>& last = side.faces.back();
  const int head = is_front ? 0 : 1;
  const Vec<2> before = (first.corners[head] - first.corners[1 - head]).normalized();
  const Vec<2> after = (last.corners[1 - head] - last.corners[head]).normalized();
  first.corners[head] += reach * before;
  last.corners[1 - head] += reach * after;
  return side;
}

WallParticles<2> sample_side(const Boundary<2>& boundary, const WallPlate& plate, bool is_front,
                             const WallLayers& layers) {
  return sample_chains(widened_side(boundary, plate, is_front, layers.count * layers.spacing), layers);
}

WallParticles<3> sample_side(const Boundary<3>& boundary, const WallPlate& plate, bool is_front,
                             const WallLayers& layers) {
  const Screen<3> screen = bare_screen(boundary, plate);
  const Vec<3> normal = is_front ? screen.normal : Vec<3>(-screen.normal);
  const std::array<double, 2> length{screen.range[0][1], screen.range[1][1]};
  std::array<int, 2> count{};
  for (const int axis : {0, 1}) {
    count[axis] = std::max(1, static_cast<int>(std::lround(length[axis] / layers.spacing)));
  }
  WallParticleCollector<3> collector(boundary, layers.spacing);
  const int more = layers.count;
  for (int layer = 0; layer < layers.count; ++layer) {
    const double depth = layers.first_depth() + layer * layers.spacing;
    for (int j = -more; j < count[1] + more; ++j) {
      for (int i = -more; i < count[0] + more; ++i) {
        const Vec<3> foot = screen.corner + (i + 0.5) * length[0] / count[0] * screen.along[0] +
                            (j + 0.5) * length[1] / count[1] * screen.along[1];
        collector.add({foot - depth * normal, foot, {normal}, plate.wall});
      }
    }
  }
  return std::move(collector).particles();
}

}  // namespace

template <int Dim>
bool Screen<Dim>::is_between(const Vec<Dim>& from, const Vec<Dim>& to) const {
  const double before = height(from);
  const double after = height(to);
  if ((before >= 0.0) == (after >= 0.0)) return false;
  const Vec<Dim> hit = from + before / (before - after) * (to - from) - corner;
  for (int axis = 0; axis < Dim - 1; ++axis) {
    const double place = along[axis].dot(hit);
    if (place < range[axis][0] || place > range[axis][1]) return false;
  }
  return true;
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
bool is_hidden(std::span<const Screen<Dim>> screens, const Vec<Dim>& from, const Vec<Dim>& to, int plate) {
  bool is_behind_own = plate < 0;
  for (const Screen<Dim>& screen : screens) {
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
  }
}

template <int Dim>
std::vector<WallParticles<Dim>> sample_plates(const Boundary<Dim>& boundary, const WallLayers& layers) {
  std::vector<WallParticles<Dim>> parts;
  for (const WallPlate& plate : boundary.plates) {
    for (const bool is_front : {true, false}) parts.push_back(sample_side(boundary, plate, is_front, layers));
  }
  return parts;
}

template struct Screen<2>;
template struct Screen<3>;
template bool is_hidden(std::span<const Screen<2>>, const Vec<2>&, const Vec<2>&, int);
template bool is_hidden(std::span<const Screen<3>>, const Vec<3>&, const Vec<3>&, int);
template void Boundary<2>::hang_screens(double, double);
template void Boundary<3>::hang_screens(double, double);
template std::vector<WallParticles<2>> sample_plates(const Boundary<2>&, const WallLayers&);
template std::vector<WallParticles<3>> sample_plates(const Boundary<3>&, const WallLayers&);

}  // namespace tailwater
