#include "geometry/plate_shape.h"

#include <array>
#include <map>

namespace tailwater {
namespace {

/// 1 + cos of the angle by which a rim turns. Where it turns by more than 120 degrees, its corner is not drawn on.
constexpr double min_opening = 0.5;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Radians; a rim that turns by less goes straight on.
constexpr double straight = 1e-6;

}  // namespace

template <int Dim>
WallBesidePlate wall_beside_plate(const Boundary<Dim>& boundary, const Vec<Dim>& x, int except) {
  WallBesidePlate beside;
  double nearest = infinity;
  boundary.visit_plain_faces([&](int f) {
    const WallFace<Dim>& face = boundary.faces[f];
    if (boundary.walls[face.wall].is_plate || face.wall == except) return;
    const double distance = (closest_point(face, x) - x).norm();
    if (distance > nearest) return;
    nearest = distance;
    beside = {f, face.height(x) < 0.0 ? -distance : distance};
  });
  if constexpr (Dim == 3) {
    for (const WallMesh& mesh : boundary.meshes) {
      if (mesh.wall == except) continue;
      const SurfacePlace place = mesh.surface->nearest(x - boundary.displacement_of(mesh), infinity);
      if (place.triangle < 0 || place.signed_distance >= beside.distance) continue;
      beside = {mesh.first_face + place.triangle, place.signed_distance};
    }
  }
  return beside;
}

TAILWATER_IN_2D_AND_3D(wall_beside_plate);

Screen<3> rectangle_of(const Boundary<3>& boundary, const WallPlate& plate) {
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

WidenedSheet widened(const MeshSurface& sheet, double reach,
                     const std::function<bool(int, int, const Vec<3>&)>& is_wanted) {
  struct Strip {
    int triangle;
    Vec<3> out;      ///< unit vector
    int begin, end;  ///< points of its outer edge
    int edge;        ///< index into WidenedSheet::edges
  };
  WidenedSheet wide{sheet.mesh(), {}, {}, {}};
  TriangleMesh& mesh = wide.mesh;
  const int drawn = static_cast<int>(mesh.triangles.size());
  for (int t = 0; t < drawn; ++t) wide.from.push_back(t);
  wide.beyond.assign(drawn, {-1, -1});
  const auto add = [&](int a, int b, int c, int from, const std::array<int, 2>& beyond) {
    mesh.triangles.push_back({a, b, c});
    wide.from.push_back(from);
    wide.beyond.push_back(beyond);
  };
  const auto add_point = [&](const Vec<3>& x) {
    mesh.points.push_back(x);
    return static_cast<int>(mesh.points.size()) - 1;
  };
  std::map<int, Strip> strips;           // by the point at which the edge begins
  std::vector<std::array<int, 2>> ends;  // of the edges, in the order of WidenedSheet::edges
  for (int t = 0; t < drawn; ++t) {
    for (int e = 0; e < 3; ++e) {
      const int a = mesh.triangles[t][e];
      const int b = mesh.triangles[t][(e + 1) % 3];
      const Vec<3> from = mesh.points[a];
      const Vec<3> to = mesh.points[b];
      const Vec<3> out = (to - from).cross(mesh.area_normal(t)).normalized();
      if (sheet.neighbours()[t][e] >= 0 || !is_wanted(t, e, out)) continue;
      const int edge = static_cast<int>(wide.edges.size());
      wide.edges.push_back({from, to, from + reach * out, to + reach * out});
      const Strip strip{t, out, add_point(from + reach * out), add_point(to + reach * out), edge};
      add(b, a, strip.begin, t, {edge, -1});
      add(b, strip.begin, strip.end, t, {edge, -1});
      strips[a] = strip;
      ends.push_back({a, b});
    }
  }
  for (const auto& [a, b] : ends) {
    const auto next = strips.find(b);
    if (next == strips.end()) continue;
    const Strip& one = strips.at(a);
    const Strip& other = next->second;
    wide.edges[one.edge].after = other.edge;
    wide.edges[other.edge].before = one.edge;
    const double turn = one.out.cross(other.out).dot(mesh.area_normal(one.triangle).normalized());
    const double opening = 1.0 + one.out.dot(other.out);
    if (turn <= straight || opening < min_opening) continue;  // the strips touch or overlap, or the corner is a needle
    const int corner = add_point(mesh.points[b] + reach / opening * (one.out + other.out));
    add(b, one.end, corner, one.triangle, {one.edge, other.edge});
    add(b, corner, other.begin, other.triangle, {one.edge, other.edge});
  }
  weld(mesh, 2.0 * straight * reach);
  return wide;
}

}  // namespace tailwater
