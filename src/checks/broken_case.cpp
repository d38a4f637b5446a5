#include "checks/broken_case.h"

#include <vector>

#include "base/error.h"
#include "geometry/from_spec.h"
#include "geometry/mesh_walls.h"

namespace tailwater {
namespace {

/// Adds the triangles of a file unchanged; none if the file cannot be read.
void append_triangles(const PlacedFile& file, int wall, Boundary<3>& boundary) {
  if (file.file.empty()) return;
  try {
    const TriangleMesh mesh = read_placed_mesh(file, {});
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
      boundary.faces.push_back(
          {{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)}, mesh.area_normal(t).normalized(), wall});
    }
  } catch (const UserError&) {
    // There is nothing to draw.
  }
}

/// The walls that can each be made alone.
template <int Dim>
Boundary<Dim> draw_walls_one_by_one(const CaseSpec& spec) {
  Boundary<Dim> all;
  all.walls.resize(spec.walls.size() + 1);  // the last for meshes of water
  CaseSpec single = spec;
  single.fluid.clear();
  for (int wall = 0; wall < static_cast<int>(spec.walls.size()); ++wall) {
    single.walls = {spec.walls[wall]};
    try {
      const Boundary<Dim> alone = make_boundary<Dim>(single);
      all.walls[wall] = alone.walls.front();
      for (WallFace<Dim> face : alone.faces) {
        face.wall = wall;
        all.faces.push_back(face);
      }
    } catch (const InputError&) {
      if constexpr (Dim == 3) append_triangles(spec.walls[wall], wall, all);
    }
  }
  if constexpr (Dim == 3) {
    for (const FluidTable& block : spec.fluid) {
      if (block.shape == BlockShape::mesh) append_triangles(block, static_cast<int>(spec.walls.size()), all);
    }
  }
  return all;
}

}  // namespace

template <int Dim>
BrokenCase<Dim> draw_broken_case(const CaseSpec& spec) {
  BrokenCase<Dim> drawing;
  try {
    drawing.boundary = make_boundary<Dim>(spec);
  } catch (const InputError&) {
    return {draw_walls_one_by_one<Dim>(spec), {}};
  }
  try {
    drawing.fluid = make_fluid_particles(spec, drawing.boundary, {}, 0, StartVelocities::left_out);
  } catch (const InputError&) {
    // The walls alone show the place.
  }
  return drawing;
}

template <int Dim>
std::vector<Vec<Dim>> places_of(const Findings& findings) {
  std::vector<Vec<Dim>> places;
  for (const Finding& finding : findings) {
    for (const MarkedPlace& place : finding.places) places.push_back(Vec<Dim>::Map(place.x.data()));
  }
  return places;
}

TAILWATER_IN_2D_AND_3D(draw_broken_case);
TAILWATER_IN_2D_AND_3D(places_of);

}  // namespace tailwater
