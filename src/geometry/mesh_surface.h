// A mesh as a surface with two sides: nearest points with signed distances, and paths that pass through it.
#pragma once

#include <memory>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/triangle_mesh.h"

namespace tailwater {

/// A triangle as a face of a wall.
inline WallFace<3> face_of(const TriangleMesh& mesh, int t, int wall = 0) {
  return {{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)}, mesh.area_normal(t).normalized(), wall};
}

/// The place of a surface nearest to some point.
struct SurfacePlace {
  int triangle = -1;  ///< -1: none within the search distance; of several equally near ones, one that shows the sign
  Vec<3> point = Vec<3>::Zero();
  double signed_distance = 0.0;     ///< m; positive in front
  std::vector<int> triangles = {};  ///< all that hold the point: one, the two at an edge, those around a corner
  bool is_on_rim = false;           ///< of an open mesh, beyond which the sign has no meaning
};

/// The normals of the triangles at a place. Those that differ by less than 5 degrees, as on a finely drawn curve, count
/// once.
std::vector<Vec<3>> normals_at(const TriangleMesh& mesh, const SurfacePlace& place);

/// A welded mesh whose neighbours agree about the front; it may be open.
///
/// The sign of a distance is that of (x - foot).n, where n is the triangle's normal, at an edge the sum of both
/// normals, at a corner the sum of the normals weighted by the angles of the triangles there: exact for closed meshes
/// (J. A. Baerentzen & H. Aanaes, IEEE Trans. Visualization and Computer Graphics 11 (2005) 243).
class MeshSurface {
 public:
  explicit MeshSurface(TriangleMesh mesh);
  ~MeshSurface();

  const TriangleMesh& mesh() const { return mesh_; }
  /// The triangle beyond each edge; -1 at a rim.
  const std::vector<std::array<int, 3>>& neighbours() const { return neighbours_; }
  bool is_closed() const { return is_closed_; }
  const Vec<3>& low() const { return low_; }  ///< lowest corner of the box around it
  const Vec<3>& high() const { return high_; }

  /// The nearest place within `search_distance` (m, may be infinite).
  SurfacePlace nearest(const Vec<3>& x, double search_distance) const;

  /// The triangle that the path from one point to another passes through first (crosses in boundary.h); -1: none.
  int first_crossed(const Vec<3>& from, const Vec<3>& to, double tolerance) const;

  /// Calls visit(triangle) for every triangle whose box meets the box between two corners.
  template <class Visit>
  void visit_in(const Vec<3>& low, const Vec<3>& high, Visit&& visit) const {
    std::vector<int> found;
    find_in(low, high, found);
    for (const int triangle : found) visit(triangle);
  }

 private:
  struct Tree;

  void find_in(const Vec<3>& low, const Vec<3>& high, std::vector<int>& found) const;
  /// Fills the triangles around a corner, and whether they leave a gap.
  void look_around_corner(int triangle, int corner, SurfacePlace& place) const;

  TriangleMesh mesh_;
  std::vector<std::array<int, 3>> neighbours_;
  std::vector<Vec<3>> point_normals_;
  bool is_closed_ = true;
  Vec<3> low_, high_;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace tailwater
