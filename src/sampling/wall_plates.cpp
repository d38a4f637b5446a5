// Wall particles of plates: the particles of both sides overlap in space.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/images.h"
#include "geometry/mesh_surface.h"
#include "geometry/plate_shape.h"
#include "sampling/nodes_near.h"
#include "sampling/wall_layers.h"

namespace tailwater {
namespace {

/// Whether two places are images of each other in different periods.
template <int Dim>
bool are_images(const PeriodicDomain<Dim>& domain, const Vec<Dim>& a, const Vec<Dim>& b, double tolerance) {
  Vec<Dim> apart = a - b;
  if (apart.norm() <= tolerance) return false;
  for (int axis = 0; axis < Dim; ++axis) {
    if (!domain[axis]) continue;
    const double period = domain[axis]->second - domain[axis]->first;
    apart[axis] -= period * std::round(apart[axis] / period);
  }
  return apart.norm() <= tolerance;
}

/// The faces of one side of a plate, extended in its plane by `reach` beyond each end, because the region that a plate
/// hides from a particle widens behind the plate. Where the image of its own other end follows in the next period, the
/// plate is not extended.
Boundary<2> widened_side(const Boundary<2>& boundary, const WallPlate& plate, bool is_front, double reach,
                         double tolerance) {
  Boundary<2> side;
  side.walls = boundary.walls;
  const auto from = boundary.faces.begin() + plate.first_face + (is_front ? 0 : plate.pieces);
  side.faces.assign(from, from + plate.pieces);
  // The corners of a back face are in reverse order.
  WallFace<2>& first = side.faces.front();
  WallFace<2>& last = side.faces.back();
  const int head = is_front ? 0 : 1;
  const Vec<2> before = (first.corners[head] - first.corners[1 - head]).normalized();
  const Vec<2> after = (last.corners[1 - head] - last.corners[head]).normalized();
  Vec<2>& begin = first.corners[head];
  Vec<2>& end = last.corners[1 - head];
  if (are_images<2>(boundary.domain, begin, end, tolerance)) return side;
  begin += reach * before;
  end += reach * after;
  return side;
}

WallParticles<2> sample_side(const Boundary<2>& boundary, const WallPlate& plate, bool is_front,
                             const WallLayers& layers, const Lattice<2>& /*lattice*/) {
  return sample_chains(
      widened_side(boundary, plate, is_front, layers.count * layers.spacing, corner_tolerance * layers.spacing),
      layers);
}

/// An edge of the rim of a plate.
struct RimEdge {
  Vec<3> from, to;
  Vec<3> out;  ///< unit vector in the plane of the plate
};

/// Whether the image of one edge of a plate is another one from which the plate goes straight on in the next period.
bool goes_on_between_periods(const Boundary<3>& boundary, const RimEdge& edge, const RimEdge& other, double spacing) {
  constexpr double straight_cosine = -0.866;  // up to 30 degrees, as within a run of faces in 2D
  const double tolerance = corner_tolerance * spacing;
  const auto are_two = [&](const Vec<3>& a, const Vec<3>& b) {
    return are_images<3>(boundary.domain, a, b, tolerance);
  };
  return edge.out.dot(other.out) < straight_cosine && ((are_two(edge.from, other.from) && are_two(edge.to, other.to)) ||
                                                       (are_two(edge.from, other.to) && are_two(edge.to, other.from)));
}

RimEdge rim_edge(const TriangleMesh& mesh, int t, int e) {
  const Vec<3>& from = mesh.corner(t, e);
  const Vec<3>& to = mesh.corner(t, (e + 1) % 3);
  return {from, to, (to - from).cross(mesh.area_normal(t)).normalized()};
}

/// The edges of the rim of a sheet that are in periodic planes.
std::vector<RimEdge> edges_between_periods(const Boundary<3>& boundary, const MeshSurface& sheet, double spacing) {
  std::vector<RimEdge> edges;
  const double tolerance = corner_tolerance * spacing;
  for (int t = 0; t < static_cast<int>(sheet.mesh().triangles.size()); ++t) {
    for (int e = 0; e < 3; ++e) {
      if (sheet.neighbours()[t][e] >= 0) continue;
      const RimEdge edge = rim_edge(sheet.mesh(), t, e);
      if (is_in_periodic_plane<3>(boundary.domain, Vec<3>(0.5 * (edge.from + edge.to)), tolerance)) {
        edges.push_back(edge);
      }
    }
  }
  return edges;
}

/// Nodes of the water's lattice, as behind other meshes, so that water on the lattice sees the lattice continued behind
/// the sheet.
WallParticles<3> sample_side_of_sheet(const Boundary<3>& boundary, const WallPlate& plate, bool is_front,
                                      const WallLayers& layers, const Lattice<3>& lattice) {
  const double depth = layers.count * layers.spacing;
  const std::vector<RimEdge> between = edges_between_periods(boundary, *plate.sheet, layers.spacing);
  WidenedSheet wide = widened(*plate.sheet, depth, [&](int t, int e, const Vec<3>& /*out*/) {
    const RimEdge edge = rim_edge(plate.sheet->mesh(), t, e);
    return std::ranges::none_of(
        between, [&](const RimEdge& other) { return goes_on_between_periods(boundary, edge, other, layers.spacing); });
  });
  const MeshSurface surface(std::move(wide.mesh));
  WallParticleCollector<3> collector(boundary, layers);
  const auto propose = [&](const Vec<3>& x, const SurfacePlace& place) {
    if (place.is_on_rim || (place.signed_distance < 0.0) != is_front) return;
    std::vector<Vec<3>> normals = normals_at(surface.mesh(), place);
    for (Vec<3>& normal : normals) normal *= is_front ? 1.0 : -1.0;
    double share = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      share *= share_of_step(lattice[axis].width(lattice[axis].cell_at(x[axis])), layers.spacing);
    }
    collector.add(
        {.position = x, .foot = place.point, .normals = std::move(normals), .wall = plate.wall, .share = share});
  };
  NodesNear(surface, lattice, depth, propose).find();
  return std::move(collector).particles();
}

WallParticles<3> sample_side(const Boundary<3>& boundary, const WallPlate& plate, bool is_front,
                             const WallLayers& layers, const Lattice<3>& lattice) {
  if (plate.sheet) return sample_side_of_sheet(boundary, plate, is_front, layers, lattice);
  const Screen<3> screen = rectangle_of(boundary, plate);
  const Vec<3> normal = is_front ? screen.normal : Vec<3>(-screen.normal);
  const std::array<double, 2> length{screen.range[0][1], screen.range[1][1]};
  std::array<int, 2> count{};
  std::array<double, 2> step{};
  for (const int axis : {0, 1}) {
    count[axis] = std::max(1, static_cast<int>(std::lround(length[axis] / layers.spacing)));
    step[axis] = length[axis] / count[axis];
  }
  WallParticleCollector<3> collector(boundary, layers);
  // Numbers of steps beyond the ends, by axis.
  std::array<int, 2> more{};
  for (const int axis : {0, 1}) {
    const Vec<3> across = length[1 - axis] * screen.along[1 - axis];
    const Vec<3> far_corner = screen.corner + length[axis] * screen.along[axis];
    const RimEdge near{screen.corner, screen.corner + across, -screen.along[axis]};
    const RimEdge far{far_corner, far_corner + across, screen.along[axis]};
    more[axis] = goes_on_between_periods(boundary, near, far, layers.spacing) ? 0 : layers.count;
  }
  for (int layer = 0; layer < layers.count; ++layer) {
    const double depth = layers.first_depth() + layer * layers.spacing;
    for (int j = -more[1]; j < count[1] + more[1]; ++j) {
      for (int i = -more[0]; i < count[0] + more[0]; ++i) {
        const Vec<3> foot =
            screen.corner + (i + 0.5) * step[0] * screen.along[0] + (j + 0.5) * step[1] * screen.along[1];
        collector.add({.position = foot - depth * normal,
                       .foot = foot,
                       .normals = {normal},
                       .wall = plate.wall,
                       .share = share_of_step(step[0], layers.spacing) * share_of_step(step[1], layers.spacing)});
      }
    }
  }
  return std::move(collector).particles();
}

}  // namespace

template <int Dim>
std::vector<WallParticles<Dim>> sample_plates(const Boundary<Dim>& boundary, const WallLayers& layers,
                                              const Lattice<Dim>& lattice) {
  std::vector<WallParticles<Dim>> parts;
  for (const WallPlate& plate : boundary.plates) {
    const WallLayers wanted = layers.of_wall(boundary.walls[plate.wall].moves());
    for (const bool is_front : {true, false}) parts.push_back(sample_side(boundary, plate, is_front, wanted, lattice));
  }
  return parts;
}

TAILWATER_IN_2D_AND_3D(sample_plates);

}  // namespace tailwater
