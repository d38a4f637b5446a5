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

/// The faces of one side of a plate, extended in its plane by `reach` beyond each end, because the region that a plate
/// hides from a particle widens behind the plate. At a periodic boundary the image of the plate follows.
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
  for (const auto& [end, out] : {std::pair{&first.corners[head], before}, {&last.corners[1 - head], after}}) {
    if (!is_in_periodic_plane<2>(boundary.domain, *end, tolerance)) *end += reach * out;
  }
  return side;
}

WallParticles<2> sample_side(const Boundary<2>& boundary, const WallPlate& plate, bool is_front,
                             const WallLayers& layers, const Lattice<2>& /*lattice*/) {
  return sample_chains(
      widened_side(boundary, plate, is_front, layers.count * layers.spacing, corner_tolerance * layers.spacing),
      layers);
}

/// Whether an edge lies in a periodic boundary, beyond which the image of its plate follows.
bool lies_between_periods(const Boundary<3>& boundary, const Vec<3>& from, const Vec<3>& to, double spacing) {
  const double tolerance = corner_tolerance * spacing;
  return is_in_periodic_plane<3>(boundary.domain, Vec<3>(0.5 * (from + to)), tolerance) &&
         is_in_periodic_plane<3>(boundary.domain, from, tolerance) &&
         is_in_periodic_plane<3>(boundary.domain, to, tolerance);
}

/// Nodes of the water's lattice, as behind other meshes, so that water on the lattice sees the lattice continued behind
/// the sheet.
WallParticles<3> sample_side_of_sheet(const Boundary<3>& boundary, const WallPlate& plate, bool is_front,
                                      const WallLayers& layers, const Lattice<3>& lattice) {
  const double depth = layers.count * layers.spacing;
  const TriangleMesh& drawn = plate.sheet->mesh();
  WidenedSheet wide = widened(*plate.sheet, depth, [&](int t, int e, const Vec<3>& /*out*/) {
    return !lies_between_periods(boundary, drawn.corner(t, e), drawn.corner(t, (e + 1) % 3), layers.spacing);
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
  // Numbers of steps beyond the ends, by axis and end.
  std::array<std::array<int, 2>, 2> more{};
  for (const int axis : {0, 1}) {
    for (const int end : {0, 1}) {
      const Vec<3> from = screen.corner + end * length[axis] * screen.along[axis];
      const Vec<3> to = from + length[1 - axis] * screen.along[1 - axis];
      more[axis][end] = lies_between_periods(boundary, from, to, layers.spacing) ? 0 : layers.count;
    }
  }
  for (int layer = 0; layer < layers.count; ++layer) {
    const double depth = layers.first_depth() + layer * layers.spacing;
    for (int j = -more[1][0]; j < count[1] + more[1][1]; ++j) {
      for (int i = -more[0][0]; i < count[0] + more[0][1]; ++i) {
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
