// Wall particles behind meshes: the cells of the water's own lattice, continued behind the surface as deep as there are
// layers. A cell that the surface cuts has a particle with the volume of the part behind it, at the centre of that
// part. Kernel sums over the wall are thus integrals over the space behind it, whatever its shape.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/error.h"
#include "geometry/mesh_surface.h"
#include "geometry/plate_shape.h"
#include "geometry/some_walls.h"
#include "geometry/wall_label.h"
#include "sampling/cut_cells.h"
#include "sampling/nodes_near.h"
#include "sampling/wall_layers.h"

namespace tailwater {
namespace {

/// Beyond the rim of an open mesh, wall particles stand only where they are more behind its last triangle than beside
/// it.
constexpr double min_behind = 0.7;

constexpr double min_cell_share = 0.01;  // of a cell; less than that behind the wall gets no particle

/// Whether a plate ends at the rim of the mesh there: places beyond are on the other side of the plate.
bool ends_at_plate(const WallMesh& mesh, const SurfacePlace& place) {
  return !mesh.ended_edges.empty() && std::ranges::any_of(place.triangles, [&](int t) {
    const int free = mesh.free_edges.empty() ? 0 : mesh.free_edges[t];
    return (mesh.ended_edges[t] & ~free) != 0;
  });
}

/// The space behind a mesh.
class SpaceBehind {
 public:
  SpaceBehind(const Boundary<3>& body, const WallMesh& mesh, double spacing)
      : body_(body), mesh_(mesh), is_other_(body.walls.size(), 1), gap_(0.5 * spacing) {
    is_other_[static_cast<std::size_t>(mesh.wall)] = 0;
  }

  const WallMesh& mesh() const { return mesh_; }

  /// Whether `x`, whose nearest place of the mesh is `place`, is beside the rim and not behind the mesh.
  bool is_beyond_rim(const Vec<3>& x, const SurfacePlace& place) const {
    if (!place.is_on_rim) return false;
    if (ends_at_plate(mesh_, place)) return true;
    const Vec<3> normal = mesh_.surface->mesh().area_normal(place.triangle).normalized();
    return normal.dot(x - place.point) > min_behind * place.signed_distance || is_before_another(x, place);
  }

 private:
  /// Whether another wall begins at the rim, such as that of a pipe behind a hole, and `x` is in front of it.
  bool is_before_another(const Vec<3>& x, const SurfacePlace& place) const {
    const NearestWall<3> other = nearest_among<3>(body_, is_other_, x, (x - place.point).norm() + gap_);
    return other.face >= 0 && other.signed_distance > 0.0;
  }

  const Boundary<3>& body_;
  const WallMesh& mesh_;
  std::vector<std::uint8_t> is_other_;
  double gap_;
};

/// The part of a cell that is behind a surface.
struct Behind {
  double share = 0.0;              ///< of the cell
  Vec<3> offset = Vec<3>::Zero();  ///< m; of its centre from the cell's
};

Behind part_behind(const SpaceBehind& space, const Vec<3>& centre, const Vec<3>& edge) {
  const MeshSurface& surface = *space.mesh().surface;
  Behind behind;
  for_each_part<3>(centre, edge, [&](const Vec<3>& x, const Vec<3>& part) {
    const SurfacePlace place = surface.nearest(x, 2.0 * edge.norm());
    if (place.triangle < 0 || space.is_beyond_rim(x, place)) return;
    const bool is_on_surface = std::abs(place.signed_distance) < corner_tolerance * part.norm();
    const Vec<3> n = is_on_surface ? surface.mesh().area_normal(place.triangle).normalized()
                                   : Vec<3>((x - place.point) / place.signed_distance);
    const PartOfBox found = part_in_front<3>(part, -n, -place.signed_distance);
    behind.share += found.share;
    behind.offset += found.share * (x - (found.distance + place.signed_distance) * n - centre);
  });
  if (behind.share > 0.0) behind.offset /= behind.share;
  behind.share /= parts_of_cell<3>;
  return behind;
}

/// Whole cells behind the surface extended beyond its free rim. They act on water only through the mesh.
void sample_beyond_rim(const WallMesh& mesh, const WallLayers& layers, const Lattice<3>& lattice,
                       WallParticleCollector<3>& collector) {
  if (mesh.free_edges.empty()) return;
  const double depth = layers.count * layers.spacing;
  WidenedSheet wide =
      widened(*mesh.surface, depth, [&](int t, int e, const Vec<3>& /*out*/) { return mesh.has_free_edge(t, e); });
  const MeshSurface surface(std::move(wide.mesh));
  const int drawn = static_cast<int>(mesh.free_edges.size());
  const auto propose = [&](const Vec<3>& x, const SurfacePlace& place) {
    if (place.is_on_rim || place.triangle < drawn || place.signed_distance >= 0.0) return;
    double share = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      share *= share_of_step(lattice[axis].width(lattice[axis].cell_at(x[axis])), layers.spacing);
    }
    collector.add({.position = x,
                   .foot = place.point,
                   .normals = normals_at(surface.mesh(), place),
                   .wall = mesh.wall,
                   .share = share,
                   .is_beyond_end = true});
  };
  NodesNear(surface, lattice, depth, propose).find();
}

}  // namespace

void sample_meshes(const Boundary<3>& body, const WallLayers& layers, const Lattice<3>& lattice,
                   WallParticleCollector<3>& collector) {
  if (layers.starts_on_wall && !body.meshes.empty()) {
    throw CaseError(
        "mesh-needs-robust",
        {"{} is a mesh, and wall particles stand behind a mesh, not on it", wall_label(body, body.meshes[0].wall)},
        {"choose scheme.formulation = \"robust\""});
  }
  struct Proposal {
    WallPlace<3> place;
    std::int64_t number;
    const WallMesh* mesh;
  };
  std::vector<Proposal> proposals;
  for (const WallMesh& mesh : body.meshes) {
    const MeshSurface& surface = *mesh.surface;
    const SpaceBehind space(body, mesh, layers.spacing);
    const auto propose = [&](const Vec<3>& x, const SurfacePlace& place) {
      const std::int64_t number = collector.take_number();
      if (!collector.wants(x)) return;
      Vec<3> edge;
      for (int axis = 0; axis < 3; ++axis) edge[axis] = lattice[axis].width(lattice[axis].cell_at(x[axis]));
      const double half_diagonal = 0.5 * edge.norm();
      if (place.signed_distance >= half_diagonal || space.is_beyond_rim(x, place)) return;
      Behind behind{.share = 1.0};
      if (place.signed_distance > -half_diagonal) behind = part_behind(space, x, edge);
      if (behind.share < min_cell_share) return;
      const SurfacePlace near = surface.nearest(x + behind.offset, layers.count * layers.spacing + edge.norm());
      proposals.push_back({{.position = x,
                            .foot = near.point,
                            .normals = normals_at(surface.mesh(), near),
                            .wall = mesh.wall,
                            .offset = behind.offset,
                            .share = behind.share * edge.prod() / power<3>(layers.spacing)},
                           number,
                           &mesh});
    };
    NodesNear(surface, lattice, layers.count * layers.spacing, propose).find();
  }
  // Where two meshes cut a cell, it is behind the one that leaves less of it.
  std::ranges::stable_sort(proposals,
                           [](const Proposal& a, const Proposal& b) { return a.place.share > b.place.share; });
  for (const Proposal& proposal : proposals) {
    collector.add_unless_behind_another(
        proposal.place, proposal.number, [](int) { return false; }, proposal.mesh);
  }
  for (const WallMesh& mesh : body.meshes) sample_beyond_rim(mesh, layers, lattice, collector);
}

}  // namespace tailwater
