// Wall particles behind meshes: the cells of the water's own lattice, continued behind the surface as deep as there are
// layers. A cell that the surface cuts has a particle with the volume of the part behind it, at the centre of that
// part. Kernel sums over the wall are thus integrals over the space behind it, whatever its shape.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/error.h"
#include "geometry/mesh_surface.h"
#include "geometry/plate_shape.h"
#include "geometry/point_grid.h"
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

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double min_cell_share = 0.01;  // of a cell; less than that behind the wall gets no particle
constexpr double equal_shares = 1e-6;    // of a cell; shares that differ by round-off are equal

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
      : body_(body),
        mesh_(mesh),
        is_other_(body.walls.size(), 1),
        meets_rim_(body.walls.size(), 0),
        gap_(0.5 * spacing) {
    is_other_[static_cast<std::size_t>(mesh.wall)] = 0;
    if (mesh.surface->is_closed()) return;
    for (const WallMesh& other : body.meshes) {
      if (other.wall == mesh.wall || other.surface->is_closed() || !begins_at_rim(other)) continue;
      meets_rim_[static_cast<std::size_t>(other.wall)] = 1;
      is_met_ = true;
    }
  }

  const WallMesh& mesh() const { return mesh_; }
  const Vec<3>& normal_of(int face) const { return body_.faces[face].normal; }

  /// Whether `x`, whose nearest place of the mesh is `place`, is beside the rim and not behind the mesh, or is nearer
  /// to a mesh that begins there.
  bool is_beyond_rim(const Vec<3>& x, const SurfacePlace& place) const {
    if (!place.is_on_rim) return false;
    if (ends_at_plate(mesh_, place)) return true;
    const Vec<3> normal = mesh_.surface->mesh().area_normal(place.triangle).normalized();
    if (normal.dot(x - place.point) > min_behind * place.signed_distance) return true;
    return is_nearer_to_next(x, place) || is_before_another(x, place);
  }

  /// Another open mesh within `distance` of `x` that begins at the rim of this one and leads backwards, so that the two
  /// meet at a convex edge: only places behind both are behind the walls.
  NearestWall<3> mesh_beyond_edge(const Vec<3>& x, double distance) const {
    if (!is_met_) return {};
    const NearestWall<3> other = nearest_among<3>(body_, meets_rim_, x, distance);
    if (other.face < 0) return {};
    const SurfacePlace behind = mesh_.surface->nearest(other.point - gap_ * normal_of(other.face), infinite);
    return !behind.is_on_rim && behind.signed_distance < 0.0 ? other : NearestWall<3>{};
  }

 private:
  /// Whether another mesh lies along an edge of the rim.
  bool begins_at_rim(const WallMesh& other) const {
    const TriangleMesh& mesh = mesh_.surface->mesh();
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
      for (int e = 0; e < 3; ++e) {
        if (mesh_.surface->neighbours()[t][e] >= 0) continue;
        const Vec<3>& from = mesh.corner(t, e);
        const Vec<3>& to = mesh.corner(t, (e + 1) % 3);
        const auto is_beside = [&](double share) {
          return other.surface->nearest(from + share * (to - from), gap_).triangle >= 0;
        };
        if (is_beside(0.0) && is_beside(0.5) && is_beside(1.0)) return true;
      }
    }
    return false;
  }

  /// Whether an open mesh that begins at the rim is nearer to `x`.
  bool is_nearer_to_next(const Vec<3>& x, const SurfacePlace& place) const {
    const double distance = (x - place.point).norm();
    return is_met_ && nearest_among<3>(body_, meets_rim_, x, (1.0 - corner_tolerance) * distance).face >= 0;
  }

  /// Whether another wall begins at the rim, such as that of a pipe behind a hole, and `x` is in front of it.
  bool is_before_another(const Vec<3>& x, const SurfacePlace& place) const {
    const NearestWall<3> other = nearest_among<3>(body_, is_other_, x, (x - place.point).norm() + gap_);
    // In the plane of its rim a place has no side.
    return other.signed_distance > 0.0 && body_.faces[other.face].height(x) > corner_tolerance * gap_;
  }

  const Boundary<3>& body_;
  const WallMesh& mesh_;
  std::vector<std::uint8_t> is_other_;
  std::vector<std::uint8_t> meets_rim_;  ///< other open meshes that begin at the rim of this one
  bool is_met_ = false;                  ///< whether there are any
  double gap_;
};

/// The part of a cell that is behind a surface.
struct Behind {
  double share = 0.0;              ///< of the cell
  Vec<3> offset = Vec<3>::Zero();  ///< m; of its centre from the cell's
};

/// The part of a box behind a surface.
struct CutPart {
  double share;  ///< of the box
  Vec<3> centre;
};

/// The part of a box with the centre `x` behind the surface that has this foot and this normal there.
CutPart cut_by(const Vec<3>& x, const Vec<3>& edge, const Vec<3>& foot, double signed_distance, const Vec<3>& normal) {
  const bool is_on_surface = std::abs(signed_distance) < corner_tolerance * edge.norm();
  const Vec<3> n = is_on_surface ? normal : Vec<3>((x - foot) / signed_distance);
  const PartOfBox found = part_in_front<3>(edge, -n, -signed_distance);
  return {found.share, x - (found.distance + signed_distance) * n};
}

Behind part_behind(const SpaceBehind& space, const Vec<3>& centre, const Vec<3>& edge) {
  const MeshSurface& surface = *space.mesh().surface;
  Behind behind;
  for_each_part<3>(centre, edge, [&](const Vec<3>& x, const Vec<3>& part) {
    const SurfacePlace place = surface.nearest(x, 2.0 * edge.norm());
    if (place.triangle < 0 || space.is_beyond_rim(x, place)) return;
    const Vec<3> normal = surface.mesh().area_normal(place.triangle).normalized();
    CutPart cut = cut_by(x, part, place.point, place.signed_distance, normal);
    const NearestWall<3> other = space.mesh_beyond_edge(x, 0.5 * part.norm());
    if (other.face >= 0) {
      const CutPart by_other = cut_by(x, part, other.point, other.signed_distance, space.normal_of(other.face));
      if (by_other.share < cut.share) cut = by_other;
    }
    behind.share += cut.share;
    behind.offset += cut.share * (cut.centre - centre);
  });
  if (behind.share > 0.0) behind.offset /= behind.share;
  behind.share /= parts_of_cell<3>;
  return behind;
}

/// A place for a particle behind a mesh.
struct Proposal {
  WallPlace<3> place;
  std::int64_t number;
  const WallMesh* mesh;
};

/// Gives a cell of which two meshes own equal parts to the duct, whose jet touches no other wall, or to the nearer
/// mesh. The first of equal proposals is taken.
void order_equals(const Boundary<3>& body, Proposal& first, Proposal& second) {
  if (std::abs(first.place.share - second.place.share) > equal_shares) return;
  second.place.share = first.place.share;
  const auto rank = [&](const WallPlace<3>& place) {
    return std::pair(body.walls[place.wall].is_duct ? 0 : 1, (place.stands_at() - place.foot).norm());
  };
  if (rank(second.place) < rank(first.place)) std::swap(first, second);
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

void sample_meshes(const Boundary<3>& body, int count, const WallLayers& layers, const Lattice<3>& lattice,
                   WallParticleCollector<3>& collector) {
  const std::span<const WallMesh> meshes(body.meshes.data(), static_cast<std::size_t>(count));
  if (layers.starts_on_wall && !body.meshes.empty()) {
    throw CaseError(
        "mesh-needs-robust",
        {"{} is a mesh, and wall particles stand behind a mesh, not on it", wall_label(body, body.meshes[0].wall)},
        {"choose scheme.formulation = \"robust\""});
  }
  std::vector<Proposal> proposals;
  PointGrid<3> cells(corner_tolerance * layers.spacing);  // of the proposals
  for (const WallMesh& mesh : meshes) {
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
      if (place.signed_distance > -half_diagonal || space.mesh_beyond_edge(x, half_diagonal).face >= 0) {
        behind = part_behind(space, x, edge);
      }
      if (behind.share < min_cell_share) return;
      const SurfacePlace near = surface.nearest(x + behind.offset, layers.count * layers.spacing + edge.norm());
      Proposal proposal{{.position = x,
                         .foot = near.point,
                         .normals = normals_at(surface.mesh(), near),
                         .wall = mesh.wall,
                         .offset = behind.offset,
                         .share = behind.share * edge.prod() / power<3>(layers.spacing)},
                        number,
                        &mesh};
      if (body.meshes.size() > 1) {
        cells.visit_near(x, [&](int k) { order_equals(body, proposals[k], proposal); });
        cells.add(x);
      }
      proposals.push_back(std::move(proposal));
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
  for (const WallMesh& mesh : meshes) sample_beyond_rim(mesh, layers, lattice, collector);
}

}  // namespace tailwater
