// Plates: what they hide, and the particles on both of their sides.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "geometry/mesh_surface.h"
#include "geometry/nodes_near.h"
#include "geometry/wall_layers.h"

namespace tailwater {
namespace {

/// 1 + cos of the angle by which a rim turns. Where it turns by more than 120 degrees, its corner is not drawn on.
constexpr double least_opening = 0.5;

/// Radians; a rim that turns by less goes straight on.
constexpr double straight = 1e-6;

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

/// Whether an edge, looked at in steps of dx, is closed by walls all along.
bool is_closed_by_walls(const Boundary<3>& boundary, const Vec<3>& from, const Vec<3>& to, double gap) {
  const int last = std::max(1, static_cast<int>(std::ceil((to - from).norm() / (2.0 * gap))));
  for (int k = 0; k <= last; ++k) {
    if (!is_closed_by_wall(boundary, Vec<3>(from + k * (to - from) / last), gap)) return false;
  }
  return true;
}

/// A sheet that has been drawn on beyond its rim.
struct WidenedSheet {
  TriangleMesh mesh;      ///< the triangles of the sheet come first
  std::vector<int> from;  ///< of each triangle: that of the sheet whose plane it goes on in
};

/// Draws a sheet on by `reach` (m), each triangle in its own plane, beyond the edges of its rim for which
/// is_wanted(from, to) is true, and around corners where two of these meet.
template <class IsWanted>
WidenedSheet widened(const MeshSurface& sheet, double reach, IsWanted&& is_wanted) {
  struct Strip {
    int triangle;
    Vec<3> out;      ///< unit vector
    int begin, end;  ///< points of its outer edge
  };
  WidenedSheet wide{sheet.mesh(), {}};
  TriangleMesh& mesh = wide.mesh;
  const int drawn = static_cast<int>(mesh.triangles.size());
  for (int t = 0; t < drawn; ++t) wide.from.push_back(t);
  const auto add = [&](int a, int b, int c, int from) {
    mesh.triangles.push_back({a, b, c});
    wide.from.push_back(from);
  };
  const auto add_point = [&](const Vec<3>& x) {
    mesh.points.push_back(x);
    return static_cast<int>(mesh.points.size()) - 1;
  };
  std::map<int, Strip> strips;  // by the point at which the edge begins
  std::vector<std::array<int, 2>> edges;
  for (int t = 0; t < drawn; ++t) {
    for (int e = 0; e < 3; ++e) {
      const int a = mesh.triangles[t][e];
      const int b = mesh.triangles[t][(e + 1) % 3];
      const Vec<3> from = mesh.points[a];
      const Vec<3> to = mesh.points[b];
      if (sheet.neighbours()[t][e] >= 0 || !is_wanted(from, to)) continue;
      const Vec<3> out = (to - from).cross(mesh.area_normal(t)).normalized();
      const Strip strip{t, out, add_point(from + reach * out), add_point(to + reach * out)};
      add(b, a, strip.begin, t);
      add(b, strip.begin, strip.end, t);
      strips[a] = strip;
      edges.push_back({a, b});
    }
  }
  for (const auto& [a, b] : edges) {
    const auto next = strips.find(b);
    if (next == strips.end()) continue;
    const Strip& one = strips.at(a);
    const Strip& other = next->second;
    const double turn = one.out.cross(other.out).dot(mesh.area_normal(one.triangle).normalized());
    const double opening = 1.0 + one.out.dot(other.out);
    if (turn <= straight || opening < least_opening)
      continue;  // the strips touch or overlap, or the corner is a needle
    const int corner = add_point(mesh.points[b] + reach / opening * (one.out + other.out));
    add(b, one.end, corner, one.triangle);
    add(b, corner, other.begin, other.triangle);
  }
  weld(mesh, 2.0 * straight * reach);
  return wide;
}

/// How far a plate from a mesh is from where it is drawn.
Vec<3> way_of(const Boundary<3>& boundary, const WallPlate& plate) {
  return boundary.faces[plate.first_face].corners[0] - plate.sheet->mesh().corner(0, 0);
}

Screen<3> triangle_screen(const TriangleMesh& mesh, int t, const Vec<3>& way, const WallPlate& plate, int piece) {
  const Vec<3> corner = mesh.corner(t, 0);
  const Vec<3> along = (mesh.corner(t, 1) - corner).normalized();
  const Vec<3> normal = mesh.area_normal(t).normalized();
  const Vec<3> across = normal.cross(along);
  std::array<Vec<2>, 3> flat;  // the corners, counter-clockwise
  for (int c = 0; c < 3; ++c) {
    const Vec<3> x = mesh.corner(t, c) - corner;
    flat[c] = {along.dot(x), across.dot(x)};
  }
  Screen<3> screen{corner + way,
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
  if (is_closed_by_wall(boundary, screens.front().corner, gap)) screens.front().range[0][0] -= reach;
  if (is_closed_by_wall(boundary, last.corners[1], gap)) screens.back().range[0][1] += reach;
  return screens;
}

std::vector<Screen<3>> screens_of_sheet(const Boundary<3>& boundary, const WallPlate& plate, double gap, double reach) {
  const Vec<3> way = way_of(boundary, plate);
  const WidenedSheet wide = widened(*plate.sheet, reach, [&](const Vec<3>& from, const Vec<3>& to) {
    return is_closed_by_walls(boundary, from + way, to + way, gap);
  });
  std::vector<Screen<3>> screens;
  for (int t = 0; t < static_cast<int>(wide.mesh.triangles.size()); ++t) {
    screens.push_back(triangle_screen(wide.mesh, t, way, plate, wide.from[t]));
  }
  return screens;
}

std::vector<Screen<3>> screens_of(const Boundary<3>& boundary, const WallPlate& plate, double gap, double reach) {
  if (plate.sheet) return screens_of_sheet(boundary, plate, gap, reach);
  const Screen<3> bare = bare_screen(boundary, plate);
  Screen<3> screen = bare;
  for (const int axis : {0, 1}) {
    const double length = bare.range[1 - axis][1];
    for (const int end : {0, 1}) {
      const Vec<3> from = bare.corner + bare.range[axis][end] * bare.along[axis];
      const Vec<3> to = from + length * bare.along[1 - axis];
      if (is_closed_by_walls(boundary, from, to, gap)) screen.range[axis][end] += (end == 0 ? -1.0 : 1.0) * reach;
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

/// Nodes of the water's lattice, as behind other meshes: what water feels through the sheet is then the lattice itself.
WallParticles<3> sample_side_of_sheet(const Boundary<3>& boundary, const WallPlate& plate, bool is_front,
                                      const WallLayers& layers) {
  const double depth = layers.count * layers.spacing;
  WidenedSheet wide = widened(*plate.sheet, depth, [](const Vec<3>&, const Vec<3>&) { return true; });
  const MeshSurface surface(std::move(wide.mesh));
  WallParticleCollector<3> collector(boundary, layers);
  const auto propose = [&](const Vec<3>& x, const SurfacePlace& place) {
    if (place.is_on_rim || (place.signed_distance < 0.0) != is_front) return;
    std::vector<Vec<3>> normals = normals_at(surface.mesh(), place);
    for (Vec<3>& normal : normals) normal *= is_front ? 1.0 : -1.0;
    collector.add({x, place.point, std::move(normals), plate.wall});
  };
  NodesNear(surface, boundary.lattice, depth, propose).find();
  return std::move(collector).particles();
}

WallParticles<3> sample_side(const Boundary<3>& boundary, const WallPlate& plate, bool is_front,
                             const WallLayers& layers) {
  if (plate.sheet) return sample_side_of_sheet(boundary, plate, is_front, layers);
  const Screen<3> screen = bare_screen(boundary, plate);
  const Vec<3> normal = is_front ? screen.normal : Vec<3>(-screen.normal);
  const std::array<double, 2> length{screen.range[0][1], screen.range[1][1]};
  std::array<int, 2> count{};
  for (const int axis : {0, 1}) {
    count[axis] = std::max(1, static_cast<int>(std::lround(length[axis] / layers.spacing)));
  }
  WallParticleCollector<3> collector(boundary, layers);
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

template <int Dim>
std::vector<WallParticles<Dim>> sample_plates(const Boundary<Dim>& boundary, const WallLayers& layers) {
  std::vector<WallParticles<Dim>> parts;
  for (const WallPlate& plate : boundary.plates) {
    const WallLayers wanted = layers.of_wall(boundary.walls[plate.wall].moves());
    for (const bool is_front : {true, false}) parts.push_back(sample_side(boundary, plate, is_front, wanted));
  }
  return parts;
}

template struct Screen<2>;
template struct Screen<3>;
template bool is_hidden(std::span<const Screen<2>>, std::span<const int>, const Vec<2>&, const Vec<2>&, int);
template bool is_hidden(std::span<const Screen<3>>, std::span<const int>, const Vec<3>&, const Vec<3>&, int);
template void Boundary<2>::hang_screens(double, double);
template void Boundary<3>::hang_screens(double, double);
template std::vector<WallParticles<2>> sample_plates(const Boundary<2>&, const WallLayers&);
template std::vector<WallParticles<3>> sample_plates(const Boundary<3>&, const WallLayers&);

}  // namespace tailwater
