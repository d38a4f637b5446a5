// Triangles from a file, before they are a wall.
#pragma once

#include <array>
#include <vector>

#include "base/vec.h"
#include "case_files/mesh_file.h"

namespace tailwater {

struct TriangleMesh : MeshTriangles {
  const Vec<3>& corner(int triangle, int c) const { return points[triangles[triangle][c]]; }
  /// At right angles to the triangle, on its front; its length is twice the area.
  Vec<3> area_normal(int triangle) const;
};

/// An edge of a triangle. Its number is that of the corner where it starts: edge 2 leads from corner 2 to corner 0.
struct TriangleEdge {
  int low, high;  ///< its ends, indices into `points`
  int triangle;
  int number;
  bool runs_up;  ///< from `low` to `high`

  bool is_between_same_points(const TriangleEdge& other) const { return low == other.low && high == other.high; }
};

/// The edges of all triangles, those between the same points one after the other.
std::vector<TriangleEdge> edges_of(const TriangleMesh& mesh);

/// Makes points that are nearer than `tolerance` (m) to each other one point. A file such as STL repeats the points of
/// every triangle, some exporters with different last digits.
void weld(TriangleMesh& mesh, double tolerance);

/// Six times the volume that the triangles enclose, positive if their fronts look outwards, for those for which
/// `belongs` is true.
template <class Belongs>
double six_volumes(const TriangleMesh& mesh, Belongs&& belongs) {
  double sum = 0.0;
  const Vec<3> origin = mesh.points.empty() ? Vec<3>(Vec<3>::Zero()) : mesh.points[0];
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    if (belongs(t)) sum += (mesh.corner(t, 0) - origin).dot(mesh.area_normal(t));
  }
  return sum;
}

/// Exchanges the front and the back of all triangles.
void turn_over(TriangleMesh& mesh);

}  // namespace tailwater
