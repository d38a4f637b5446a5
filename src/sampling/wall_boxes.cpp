// Wall particles of boxes in 3D: nodes of the box's own lattice, continued outside the box, or inside it for a body
// that stands in the water. Nodes are the centres of lattice cells behind the wall, or their corners if the first layer
// stands on the wall.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/assert.h"
#include "sampling/wall_layers.h"

namespace tailwater {
namespace {

/// A 3D box wall reassembled from its triangles.
struct WallBox {
  Vec<3> low = Vec<3>::Constant(std::numeric_limits<double>::max());
  Vec<3> high = Vec<3>::Constant(std::numeric_limits<double>::lowest());
  bool closed[3][2] = {};  ///< by axis and side (0 low, 1 high)
  bool fluid_is_inside = true;
};

/// The walls that are boxes and have faces.
std::set<int> walls_of(const Boundary<3>& boundary) {
  std::set<int> walls;
  boundary.visit_plain_faces([&](int f) { walls.insert(boundary.faces[f].wall); });
  return walls;
}

WallBox box_of(const Boundary<3>& boundary, int wall) {
  WallBox box;
  boundary.visit_plain_faces([&](int f) {
    if (boundary.faces[f].wall == wall) {
      for (const Vec<3>& corner : boundary.faces[f].corners) {
        box.low = box.low.cwiseMin(corner);
        box.high = box.high.cwiseMax(corner);
      }
    }
  });
  boundary.visit_plain_faces([&](int f) {
    const WallFace<3>& face = boundary.faces[f];
    if (face.wall == wall) {
      int axis = 0;
      [[maybe_unused]] const double length = face.normal.cwiseAbs().maxCoeff(&axis);
      TAILWATER_ASSERT(length > 1.0 - 1e-9, "3D walls are boxes");
      const bool points_up = face.normal[axis] > 0.0;
      // A single face has no opposite face. It counts as the floor of the space that it faces.
      const bool is_flat = box.high[axis] <= box.low[axis];
      const bool is_low = is_flat ? points_up : face.corners[0][axis] < 0.5 * (box.low[axis] + box.high[axis]);
      box.closed[axis][is_low ? 0 : 1] = true;
      box.fluid_is_inside = points_up == is_low;
    }
  });
  return box;
}

Eigen::Vector3i steps_of(const Vec<3>& lengths) {
  Eigen::Vector3i steps;
  for (int axis = 0; axis < 3; ++axis) steps[axis] = std::max(1, static_cast<int>(std::round(lengths[axis])));
  return steps;
}

Vec<3> inward_normal(int axis, int side) { return (side == 0 ? 1.0 : -1.0) * Vec<3>::Unit(axis); }

/// Calls visit(index) for all index triples in [low, high) per axis.
template <class Visit>
void for_each_node(const Eigen::Vector3i& low, const Eigen::Vector3i& high, Visit&& visit) {
  Eigen::Vector3i index;
  for (index[2] = low[2]; index[2] < high[2]; ++index[2])
    for (index[1] = low[1]; index[1] < high[1]; ++index[1])
      for (index[0] = low[0]; index[0] < high[0]; ++index[0]) visit(index);
}

/// The lattice of a box, continued with dx beyond it. Node (i, j, k) is (index + offset) steps from the low corner.
struct BoxLattice {
  const WallBox& box;
  double spacing;
  double offset;  ///< 0: nodes on the box's faces; 1/2: half a step behind them
  Eigen::Vector3i count = steps_of((box.high - box.low) / spacing);

  double steps_from_low(const Eigen::Vector3i& index, int axis) const { return index[axis] + offset; }

  Vec<3> position(const Eigen::Vector3i& index) const {
    Vec<3> x;
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = steps_from_low(index, axis);
      const double low = box.low[axis];
      const double high = box.high[axis];
      if (steps < 0.0) {
        x[axis] = low + steps * spacing;
      } else if (steps > count[axis]) {
        x[axis] = high + (steps - count[axis]) * spacing;
      } else {
        x[axis] = low + steps * (high - low) / count[axis];
      }
    }
    return x;
  }

  /// Volume that a node represents, over dx^3. Steps within the box differ from dx where the box's length is not a
  /// whole number of dx.
  double share(const Eigen::Vector3i& index) const {
    double share = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = steps_from_low(index, axis);
      const bool is_within = steps > 0.0 && steps < count[axis];
      if (is_within) share *= share_of_step((box.high[axis] - box.low[axis]) / count[axis], spacing);
    }
    return share;
  }
};

/// Depth of a node in steps behind the box's closed faces (0: on one), and the normals that act there. There are no
/// normals if no wall particle can stand there.
struct NodePlace {
  double depth = 0.0;
  std::vector<Vec<3>> normals;
};

NodePlace place_of(const BoxLattice& lattice, const Eigen::Vector3i& index) {
  const WallBox& box = lattice.box;
  const double direction = box.fluid_is_inside ? -1.0 : 1.0;  // direction in which depth grows from the low face
  NodePlace place;
  if (!box.fluid_is_inside) place.depth = std::numeric_limits<double>::max();
  for (int axis = 0; axis < 3; ++axis) {
    const double from_low = lattice.steps_from_low(index, axis);
    for (int side = 0; side < 2; ++side) {
      const double depth = direction * (side == 0 ? from_low : lattice.count[axis] - from_low);
      if (!box.closed[axis][side]) {
        if (box.fluid_is_inside && depth > 0.0) return {};  // above an open face
        continue;
      }
      const bool is_deeper = box.fluid_is_inside ? depth > place.depth : depth < place.depth;
      if (is_deeper && !box.fluid_is_inside) place.normals.clear();
      if (is_deeper) place.depth = depth;
      if (box.fluid_is_inside ? depth >= 0.0 : depth == place.depth) {
        place.normals.emplace_back((box.fluid_is_inside ? 1.0 : -1.0) * inward_normal(axis, side));
      }
    }
  }
  return place;
}

/// The point of the box nearest to `x`, on the face with the first of the `normals` for a body in the water.
Vec<3> foot_on(const WallBox& box, const Vec<3>& x, const std::vector<Vec<3>>& normals) {
  Vec<3> foot = x.cwiseMax(box.low).cwiseMin(box.high);
  if (box.fluid_is_inside) return foot;
  int axis = 0;
  normals[0].cwiseAbs().maxCoeff(&axis);
  foot[axis] = normals[0][axis] > 0.0 ? box.high[axis] : box.low[axis];
  return foot;
}

/// Proposes the nodes of one wall that are from `from` to `to` steps behind it.
void add_nodes(const Boundary<3>& body, int wall, const WallLayers& layers, double from, double to,
               WallParticleCollector<3>& collector) {
  const WallBox box = box_of(body, wall);
  const BoxLattice lattice{box, layers.spacing, layers.starts_on_wall ? 0.0 : 0.5};
  const auto is_own = [&](int f) { return body.faces[f].wall == wall; };
  const int margin = box.fluid_is_inside ? static_cast<int>(std::ceil(to)) : 0;
  const int last = layers.starts_on_wall ? 1 : 0;  // a face of n steps has n + 1 corners
  const Eigen::Vector3i low = Eigen::Vector3i::Constant(-margin);
  const Eigen::Vector3i high = lattice.count + Eigen::Vector3i::Constant(margin + last);
  for_each_node(low, high, [&](const Eigen::Vector3i& index) {
    NodePlace node = place_of(lattice, index);
    if (node.depth < from || node.depth > to || node.normals.empty()) return;
    const Vec<3> x = lattice.position(index);
    const WallPlace<3> place{.position = x,
                             .foot = foot_on(box, x, node.normals),
                             .normals = std::move(node.normals),
                             .wall = wall,
                             .share = lattice.share(index)};
    if (node.depth == 0.0) {
      collector.add(place);
    } else {
      collector.add_unless_behind_another(place, is_own);
    }
  });
}

}  // namespace

void sample_boxes(const Boundary<3>& body, const WallLayers& layers, WallParticleCollector<3>& collector) {
  const std::set<int> walls = walls_of(body);
  if (!layers.starts_on_wall) {
    for (const int wall : walls) add_nodes(body, wall, layers, 0.5, layers.count - 0.5, collector);
    return;
  }
  // Layer by layer: a particle on one wall takes precedence over one behind another wall at the same place.
  for (int layer = 0; layer < layers.count; ++layer) {
    for (const int wall : walls) add_nodes(body, wall, layers, layer, layer, collector);
    if (layer == 0) collector.end_of_places_on_wall();
  }
}

}  // namespace tailwater
