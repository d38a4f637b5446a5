// Wall particles of plates: the particles of both sides overlap in space.
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/mesh_surface.h"
#include "geometry/plate_shape.h"
#include "sampling/nodes_near.h"
#include "sampling/wall_layers.h"

namespace tailwater {
namespace {

/// The faces of one side of a plate, extended in its plane by `reach` beyond each end, because the region that a plate
/// hides from a particle widens behind the plate.
Boundary<2> widened_side(const Boundary<2>& boundary, const WallPlate& plate, bool is_front, double reach) {
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
  first.corners[head] += reach * before;
  last.corners[1 - head] += reach * after;
  return side;
}

WallParticles<2> sample_side(const Boundary<2>& boundary, const WallPlate& plate, bool is_front,
                             const WallLayers& layers, const Lattice<2>& /*lattice*/) {
  return sample_chains(widened_side(boundary, plate, is_front, layers.count * layers.spacing), layers);
}

/// Nodes of the water's lattice, as behind other meshes, so that water on the lattice sees the lattice continued behind
/// the sheet.
WallParticles<3> sample_side_of_sheet(const Boundary<3>& boundary, const WallPlate& plate, bool is_front,
                                      const WallLayers& layers, const Lattice<3>& lattice) {
  const double depth = layers.count * layers.spacing;
  WidenedSheet wide = widened(*plate.sheet, depth, [](const auto&...) { return true; });
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
  const int more = layers.count;
  for (int layer = 0; layer < layers.count; ++layer) {
    const double depth = layers.first_depth() + layer * layers.spacing;
    for (int j = -more; j < count[1] + more; ++j) {
      for (int i = -more; i < count[0] + more; ++i) {
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
