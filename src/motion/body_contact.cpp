#include "motion/body_contact.h"

#include <algorithm>

#include "geometry/mesh_surface.h"
#include "geometry/wall_patches.h"

namespace tailwater {
namespace {

/// The walls for which `is_part(wall)`, filed for searches up to `reach` (m).
template <int Dim, class IsPart>
Boundary<Dim> part_of(const Boundary<Dim>& boundary, double reach, IsPart&& is_part) {
  Boundary<Dim> part;
  part.walls = boundary.walls;
  for (WallProperties& wall : part.walls) wall.body = resting_body;
  part.plates = boundary.plates;  // only their presence matters: their faces are not used
  boundary.visit_plain_faces([&](int f) {
    if (is_part(boundary.faces[f].wall)) part.faces.push_back(boundary.faces[f]);
  });
  for (const WallMesh& mesh : boundary.meshes) {
    if (!is_part(mesh.wall)) continue;
    const int first = static_cast<int>(part.faces.size());
    part.faces.insert(part.faces.end(), boundary.faces.begin() + mesh.first_face,
                      boundary.faces.begin() + mesh.end_face());
    part.meshes.push_back({mesh.surface, first, mesh.wall});
  }
  part.file_faces(reach);
  return part;
}

/// Corners of the body's patches, each once.
template <int Dim>
std::vector<Vec<Dim>> points_of(const FloatingBody<Dim>& body, const Boundary<Dim>& boundary,
                                const std::vector<WallPatch<Dim>>& patches) {
  std::vector<Vec<Dim>> points;
  for (const WallPatch<Dim>& patch : patches) {
    if (std::ranges::find(body.walls, boundary.faces[patch.face].wall) == body.walls.end()) continue;
    for (int c = 0; c < Dim; ++c) points.push_back(patch.corner(boundary, c));
  }
  const auto is_before = [](const Vec<Dim>& one, const Vec<Dim>& other) {
    return std::lexicographical_compare(one.begin(), one.end(), other.begin(), other.end());
  };
  std::ranges::sort(points, is_before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace

template <int Dim>
ContactSurfaces<Dim> make_contact_surfaces(const Boundary<Dim>& boundary, const std::vector<FloatingBody<Dim>>& bodies,
                                           double spacing) {
  ContactSurfaces<Dim> surfaces;
  if (bodies.empty()) return surfaces;
  const double reach = reach_behind_walls * spacing;
  const std::vector<int> body_of_wall = bodies_of_walls(bodies, boundary.walls.size());
  surfaces.each.push_back({part_of(boundary, reach, [&](int wall) { return !boundary.walls[wall].moves(); })});
  for (int w = 0; w < static_cast<int>(boundary.walls.size()); ++w) {
    if (!boundary.walls[w].moves() || body_of_wall[w] >= 0) continue;
    surfaces.each.push_back({part_of(boundary, reach, [&](int wall) { return wall == w; }), w, -1});
  }
  const std::vector<WallPatch<Dim>> patches = make_wall_patches(boundary, longest_patch_edge * spacing);
  for (int b = 0; b < static_cast<int>(bodies.size()); ++b) {
    surfaces.each.push_back({part_of(boundary, reach, [&](int wall) { return body_of_wall[wall] == b; }), -1, b, b});
    surfaces.points.push_back(points_of(bodies[b], boundary, patches));
  }
  return surfaces;
}

template <int Dim>
std::vector<ContactSurface<Dim>> make_hull_surfaces(const Boundary<Dim>& boundary, const std::vector<int>& hull_of_wall,
                                                    const std::vector<int>& body_of_wall, double spacing) {
  const double reach = reach_behind_walls * spacing;
  std::vector<ContactSurface<Dim>> surfaces;
  surfaces.push_back(
      {part_of(boundary, reach, [&](int wall) { return !boundary.walls[wall].moves() && hull_of_wall[wall] < 0; })});
  for (int w = 0; w < static_cast<int>(boundary.walls.size()); ++w) {
    const bool moves = boundary.walls[w].moves();
    if (body_of_wall[w] >= 0 || (!moves && hull_of_wall[w] < 0)) continue;
    surfaces.push_back(
        {part_of(boundary, reach, [&](int wall) { return wall == w; }), moves ? w : -1, -1, hull_of_wall[w]});
  }
  return surfaces;
}

TAILWATER_IN_2D_AND_3D(make_contact_surfaces);
TAILWATER_IN_2D_AND_3D(make_hull_surfaces);

}  // namespace tailwater
