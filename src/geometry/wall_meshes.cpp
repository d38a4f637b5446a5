// Wall particles behind meshes: the nodes of the water's own lattice, continued behind the surface as deep as there are
// layers. Water and wall together are then the whole lattice, so that kernel sums beside the wall are those of the
// interior, whatever its shape.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "geometry/mesh_surface.h"
#include "geometry/wall_layers.h"

namespace tailwater {
namespace {

/// Beyond the rim of an open mesh, wall particles stand only where they are more behind its last triangle than beside
/// it.
constexpr double least_behind = 0.7;

/// Normals of neighbouring triangles that differ less count once: those of a finely drawn curve. Cosine of 5 degrees.
constexpr double same_normal = 0.996;

std::vector<Vec<3>> normals_at(const TriangleMesh& mesh, const SurfacePlace& place) {
  std::vector<Vec<3>> normals;
  for (const int t : place.triangles) {
    const Vec<3> normal = mesh.area_normal(t).normalized();
    if (std::ranges::none_of(normals, [&](const Vec<3>& n) { return n.dot(normal) > same_normal; })) {
      normals.push_back(normal);
    }
  }
  return normals;
}

/// Finds the nodes behind one mesh by halving the box of nodes around it until a box is too far from the surface or
/// holds a single node.
class NodesBehind {
 public:
  NodesBehind(const WallMesh& mesh, const Lattice<3>& lattice, double depth, WallParticleCollector<3>& collector)
      : mesh_(mesh), surface_(*mesh.surface), lattice_(lattice), depth_(depth), collector_(collector) {
    Eigen::Vector3i low, high;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = lattice_[axis].cell_at(surface_.low()[axis] - depth);
      high[axis] = lattice_[axis].cell_at(surface_.high()[axis] + depth) + 1;
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
      look_at(node(low));
      return;
    }
    const Vec<3> first = node(low);
    const Vec<3> last = node(high - Eigen::Vector3i::Ones());
    const double reach = depth_ + 0.5 * (last - first).norm();
    if (surface_.nearest(0.5 * (first + last), reach).triangle < 0) return;
    int axis = 0;
    count.maxCoeff(&axis);
    Eigen::Vector3i middle_high = high;
    Eigen::Vector3i middle_low = low;
    middle_high[axis] = middle_low[axis] = low[axis] + count[axis] / 2;
    look_in(low, middle_high);
    look_in(middle_low, high);
  }

  void look_at(const Vec<3>& x) {
    const SurfacePlace place = surface_.nearest(x, depth_);
    if (place.triangle < 0 || place.signed_distance >= 0.0) return;
    if (place.is_on_rim) {
      const double height = surface_.mesh().area_normal(place.triangle).normalized().dot(x - place.point);
      if (height > least_behind * place.signed_distance) return;
    }
    collector_.add_unless_behind_another(
        {x, place.point, normals_at(surface_.mesh(), place), mesh_.wall}, [](int) { return false; }, &mesh_);
  }

  const WallMesh& mesh_;
  const MeshSurface& surface_;
  const Lattice<3>& lattice_;
  double depth_;  ///< m
  WallParticleCollector<3>& collector_;
};

}  // namespace

void sample_meshes(const Boundary<3>& body, const WallLayers& layers, WallParticleCollector<3>& collector) {
  if (layers.starts_on_wall && !body.meshes.empty()) {
    throw InputError(
        wall_label(body, body.meshes[0].wall) +
        " is a mesh, and wall particles stand behind a mesh, not on it: choose scheme.walls = \"dummies\"");
  }
  for (const WallMesh& mesh : body.meshes) {
    NodesBehind(mesh, body.lattice, layers.count * layers.spacing, collector);
  }
}

}  // namespace tailwater
