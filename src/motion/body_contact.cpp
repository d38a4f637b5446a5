#include "motion/body_contact.h"

#include <algorithm>

#include "geometry/mesh_surface.h"
#include "geometry/wall_patches.h"

namespace tailwater {
namespace {

template <int Dim>
Boundary<Dim> resting_part(const Boundary<Dim>& boundary, double reach) {
  Boundary<Dim> resting;
  resting.walls = boundary.walls;
  resting.plates = boundary.plates;  // that there are any; they are not asked for their faces
  boundary.visit_plain_faces([&](int f) {
    if (!boundary.walls[boundary.faces[f].wall].moves()) resting.faces.push_back(boundary.faces[f]);
  });
  for (const WallMesh& mesh : boundary.meshes) {
    if (boundary.walls[mesh.wall].moves()) continue;
    const int first = static_cast<int>(resting.faces.size());
    resting.faces.insert(resting.faces.end(), boundary.faces.begin() + mesh.first_face,
                         boundary.faces.begin() + mesh.end_face());
    resting.meshes.push_back({mesh.surface, first, mesh.wall});
  }
  resting.file_faces(reach);
  return resting;
}

}  // namespace

template <int Dim>
ContactSurfaces<Dim> make_contact_surfaces(const Boundary<Dim>& boundary, const std::vector<FloatingBody<Dim>>& bodies,
                                           double spacing) {
  ContactSurfaces<Dim> surfaces;
  if (bodies.empty()) return surfaces;
  surfaces.resting = resting_part(boundary, spacing);
  surfaces.points.resize(bodies.size());
  const std::vector<WallPatch<Dim>> patches = make_wall_patches(boundary, longest_patch_edge * spacing);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::vector<Vec<Dim>>& points = surfaces.points[b];
    for (const WallPatch<Dim>& patch : patches) {
      if (std::ranges::find(bodies[b].walls, boundary.faces[patch.face].wall) == bodies[b].walls.end()) continue;
      for (int c = 0; c < Dim; ++c) points.push_back(patch.corner(boundary, c));
    }
    const auto is_before = [](const Vec<Dim>& one, const Vec<Dim>& other) {
      return std::lexicographical_compare(one.begin(), one.end(), other.begin(), other.end());
    };
    std::ranges::sort(points, is_before);
    points.erase(std::unique(points.begin(), points.end()), points.end());
  }
  return surfaces;
}

template ContactSurfaces<2> make_contact_surfaces(const Boundary<2>&, const std::vector<FloatingBody<2>>&, double);
template ContactSurfaces<3> make_contact_surfaces(const Boundary<3>&, const std::vector<FloatingBody<3>>&, double);

}  // namespace tailwater
