#include "geometry/ending_boxes.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "geometry/from_spec.h"
#include "geometry/mesh_surface.h"
#include "geometry/rim_ends.h"

namespace tailwater {
namespace {

constexpr double points_up = 0.7;  // cosine between the direction in which a rim points and up

/// A box as a mesh with the same faces, which are consecutive.
WallMesh mesh_of_box(const Boundary<3>& boundary, int wall, double tolerance) {
  const auto is_own = [&](const WallFace<3>& face) { return face.wall == wall; };
  const auto first = std::ranges::find_if(boundary.faces, is_own);
  TriangleMesh mesh;
  for (auto face = first; face != boundary.faces.end() && is_own(*face); ++face) {
    const int corner = static_cast<int>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), face->corners.begin(), face->corners.end());
    mesh.triangles.push_back({corner, corner + 1, corner + 2});
  }
  weld(mesh, tolerance);
  return {std::make_shared<const MeshSurface>(std::move(mesh)), static_cast<int>(first - boundary.faces.begin()), wall};
}

/// Whether water can pass over an edge of the rim at a side or the bottom. Walls that an opening continues along a part
/// of an edge end in the air above it.
bool ends_in_water(const Boundary<3>& boundary, const WallMesh& mesh, const Lengths& lengths, const Vec<3>& up) {
  const TriangleMesh& triangles = mesh.surface->mesh();
  for (int t = 0; t < static_cast<int>(triangles.triangles.size()); ++t) {
    for (int e = 0; e < 3; ++e) {
      if (!mesh.has_free_edge(t, e)) continue;
      const Vec<3>& from = triangles.corner(t, e);
      const Vec<3> along = triangles.corner(t, (e + 1) % 3) - from;
      if (up.dot(along.cross(triangles.area_normal(t)).normalized()) > points_up) continue;
      const int steps = std::max(1, static_cast<int>(std::ceil(along.norm() / lengths.spacing)));
      bool is_continued_somewhere = false;
      for (int k = 1; k < steps - 1; ++k) {  // at its ends the edge may be beside a periodic plane
        const Vec<3> x = from + (k + 0.5) / steps * along;
        is_continued_somewhere = is_continued_somewhere || is_continued(boundary, x, mesh.wall, -1, lengths);
      }
      if (!is_continued_somewhere) return true;
    }
  }
  return false;
}

}  // namespace

void make_meshes_of_ending_boxes(const CaseSpec& spec, Boundary<3>& boundary) {
  if (traits_of(spec).walls.on_wall) return;
  const Lengths lengths{spec.particles.spacing, dummy_layers(spec) * spec.particles.spacing};
  const Vec<3> gravity = gravity_of<3>(spec);
  const Vec<3> up = gravity.isZero(0.0) ? gravity : Vec<3>(-gravity.normalized());
  std::vector<WallMesh> found;
  for (std::size_t w = 0; w < spec.walls.size(); ++w) {
    if (spec.walls[w].shape != WallShape::box || spec.walls[w].open.empty()) continue;
    WallMesh mesh = mesh_of_box(boundary, static_cast<int>(w), lengths.tolerance());
    WallMesh with_rim = mesh;
    find_free_edges(boundary, lengths, with_rim);
    if (ends_in_water(boundary, with_rim, lengths, up)) found.push_back(std::move(mesh));
  }
  if (found.empty()) return;
  boundary.meshes.insert(boundary.meshes.end(), found.begin(), found.end());
  std::ranges::sort(boundary.meshes, {}, &WallMesh::first_face);
  boundary.find_free_ends(lengths.spacing, lengths.reach);
  boundary.hang_screens();
}

}  // namespace tailwater
