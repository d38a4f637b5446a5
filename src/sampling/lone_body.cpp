#include "sampling/lone_body.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include "geometry/images.h"
#include "geometry/mesh_surface.h"

namespace tailwater {
namespace {

/// Adds the images of a mesh in other periods as meshes of walls of their own, as far as they are within `margin` (m)
/// of the domain.
void append_mesh_images(int m, double margin, Boundary<3>& body) {
  const std::shared_ptr<const MeshSurface> surface = body.meshes[m].surface;
  const TriangleMesh& mesh = surface->mesh();
  const Box<3> space = space_around<3>(body.domain, margin);
  visit_images<3>(body.domain, Box<3>(surface->low(), surface->high()), space, [&](const Vec<3>& by) {
    TriangleMesh image;
    image.points = mesh.points;
    for (Vec<3>& x : image.points) x += by;
    surface->visit_in(space.min() - by, space.max() - by, [&](int t) { image.triangles.push_back(mesh.triangles[t]); });
    if (image.triangles.empty()) return;  // only the box around the mesh reaches there
    const int wall = static_cast<int>(body.walls.size());
    body.walls.push_back(body.walls[body.meshes[m].wall]);
    body.meshes.push_back({.surface = std::make_shared<const MeshSurface>(std::move(image)),
                           .first_face = static_cast<int>(body.faces.size()),
                           .wall = wall});
    const TriangleMesh& moved = body.meshes.back().surface->mesh();
    for (int t = 0; t < static_cast<int>(moved.triangles.size()); ++t) body.faces.push_back(face_of(moved, t, wall));
  });
}

}  // namespace

template <int Dim>
LoneBody<Dim> body_alone(const Boundary<Dim>& boundary, int body, double margin) {
  Boundary<Dim> alone;
  alone.domain = boundary.domain;
  alone.walls = boundary.walls;
  std::ranges::copy_if(boundary.meshes, std::back_inserter(alone.meshes),
                       [&](const WallMesh& mesh) { return boundary.walls[mesh.wall].body == body; });
  // Meshes come first, because their faces must stay consecutive.
  for (WallMesh& mesh : alone.meshes) {
    const auto from = boundary.faces.begin();
    const int first = static_cast<int>(alone.faces.size());
    alone.faces.insert(alone.faces.end(), from + mesh.first_face, from + mesh.end_face());
    mesh.first_face = first;
  }
  boundary.visit_plain_faces([&](int f) {
    const WallProperties& wall = boundary.walls[boundary.faces[f].wall];
    if (wall.body == body && !wall.is_plate) alone.faces.push_back(boundary.faces[f]);
  });
  const int meshes = static_cast<int>(alone.meshes.size());
  if constexpr (Dim == 3) {
    for (int m = 0; m < meshes; ++m) append_mesh_images(m, margin, alone);
  }
  return {std::move(alone), meshes};
}

TAILWATER_IN_2D_AND_3D(body_alone);

}  // namespace tailwater
