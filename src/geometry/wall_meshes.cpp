// Wall particles behind meshes: the nodes of the water's own lattice, continued behind the surface as deep as there are
// layers. Water and wall together are then the whole lattice, so that kernel sums beside the wall are those of the
// interior, whatever its shape.
#include "base/error.h"
#include "geometry/mesh_surface.h"
#include "geometry/nodes_near.h"
#include "geometry/wall_layers.h"

namespace tailwater {
namespace {

/// Beyond the rim of an open mesh, wall particles stand only where they are more behind its last triangle than beside
/// it.
constexpr double least_behind = 0.7;

}  // namespace

void sample_meshes(const Boundary<3>& body, const WallLayers& layers, WallParticleCollector<3>& collector) {
  if (layers.starts_on_wall && !body.meshes.empty()) {
    throw InputError(
        wall_label(body, body.meshes[0].wall) +
        " is a mesh, and wall particles stand behind a mesh, not on it: choose scheme.walls = \"dummies\"");
  }
  for (const WallMesh& mesh : body.meshes) {
    const MeshSurface& surface = *mesh.surface;
    const auto propose = [&](const Vec<3>& x, const SurfacePlace& place) {
      if (place.signed_distance >= 0.0) return;
      if (place.is_on_rim) {
        const double height = surface.mesh().area_normal(place.triangle).normalized().dot(x - place.point);
        if (height > least_behind * place.signed_distance) return;
      }
      collector.add_unless_behind_another(
          {x, place.point, normals_at(surface.mesh(), place), mesh.wall}, [](int) { return false; }, &mesh);
    };
    NodesNear(surface, body.lattice, layers.count * layers.spacing, propose).find();
  }
}

}  // namespace tailwater
