// Nodes of the water's lattice near a mesh.
#pragma once

#include <Eigen/Core>

#include <utility>

#include "geometry/boundary.h"
#include "geometry/mesh_surface.h"
#include "sampling/lattice_axis.h"

namespace tailwater {

/// Finds the nodes, the centres of the lattice's cells, within a distance of a surface by halving the box of nodes
/// around it until a box is too far from the surface or holds a single node. Calls visit(node, place) with the place of
/// the surface that is nearest to the node.
template <class Visit>
class NodesNear {
 public:
  /// `distance`: m
  NodesNear(const MeshSurface& surface, const Lattice<3>& lattice, double distance, Visit visit)
      : surface_(surface), lattice_(lattice), distance_(distance), visit_(std::move(visit)) {}

  void find() {
    Eigen::Vector3i low, high;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = lattice_[axis].cell_at(surface_.low()[axis] - distance_);
      high[axis] = lattice_[axis].cell_at(surface_.high()[axis] + distance_) + 1;
    }
    look_in(low, high);
  }

 private:
  Vec<3> node(const Eigen::Vector3i& cell) const {
    return {lattice_[0].centre(cell[0]), lattice_[1].centre(cell[1]), lattice_[2].centre(cell[2])};
  }

  /// `high` is one beyond the last.
  void look_in(const Eigen::Vector3i& low, const Eigen::Vector3i& high) {
    const Eigen::Vector3i count = high - low;
    if (count.prod() == 1) {
      const Vec<3> x = node(low);
      const SurfacePlace place = surface_.nearest(x, distance_);
      if (place.triangle >= 0) visit_(x, place);
      return;
    }
    const Vec<3> first = node(low);
    const Vec<3> last = node(high - Eigen::Vector3i::Ones());
    const double reach = distance_ + 0.5 * (last - first).norm();
    if (surface_.nearest(0.5 * (first + last), reach).triangle < 0) return;
    int axis = 0;
    count.maxCoeff(&axis);
    Eigen::Vector3i middle_high = high;
    Eigen::Vector3i middle_low = low;
    middle_high[axis] = middle_low[axis] = low[axis] + count[axis] / 2;
    look_in(low, middle_high);
    look_in(middle_low, high);
  }

  const MeshSurface& surface_;
  const Lattice<3>& lattice_;
  double distance_;
  Visit visit_;
};

}  // namespace tailwater
