#include <algorithm>
#include <optional>

#include "base/box.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/mesh_surface.h"
#include "geometry/point_grid.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

/// A mesh that is longer than the water by more than this factor is drawn in another unit.
constexpr double largest_share_of_water = 200.0;

/// A body that is longer than the rest of the case by more than this factor may be drawn in another unit.
constexpr double largest_share_of_case = 2.0;

/// Cosine: walls back to back are a plate where they differ by less than 8 degrees from parallel; else a sharp edge.
constexpr double min_facing_of_plate = 0.99;

Findings check_size(const CaseSpec& spec, const CaseLabel& label, const MeshSurface& surface, const Box<3>& water) {
  const double dx = spec.particles.spacing;
  const double length = (surface.high() - surface.low()).maxCoeff();
  if (length < dx) {
    return {Finding::error("mesh-smaller-than-spacing",
                           {"{} is {:.3g} long, less than a spacing of {:.6g} m", label, Amount{length, "m"}, dx},
                           {"correct its scale, or use a smaller spacing"})};
  }
  const double water_length = water.isEmpty() ? 0.0 : water.sizes().maxCoeff() + dx;
  if (water_length == 0.0 || length <= largest_share_of_water * water_length) return {};
  return {Finding::error(
      "mesh-larger-than-water", {"{} is {:.6g} long and the water {:.6g} m", label, Amount{length, "m"}, water_length},
      {"give scale = 0.001 if its file is in millimetres, otherwise cut off the parts that the water does not reach"})};
}

/// The box around the water, the openings and all walls but one.
Box<3> box_of_others(const CaseSpec& spec, const Boundary<3>& boundary, int wall, const Box<3>& water) {
  Box<3> box = water;
  for (const Opening<3>& end : make_open_ends<3>(spec)) box.extend(box_around(end.as_faces()));
  for (const WallFace<3>& face : boundary.faces) {
    if (face.wall != wall) box.extend(face.box());
  }
  return box;
}

/// Warns of a mesh at rest that stands beside the rest of the case.
Findings check_place(const CaseSpec& spec, const Boundary<3>& boundary, int wall, const MeshSurface& surface,
                     const Box<3>& water) {
  const WallTable& table = spec.walls[wall];
  const Box<3> own(surface.low(), surface.high());
  const Box<3> others = box_of_others(spec, boundary, wall, water);
  if (boundary.walls[wall].moves() || others.isEmpty()) return {};
  const CaseLabel label = wall_label(boundary, wall);
  if (!own.intersects(Box<3>(others).widen(spec.particles.spacing))) {
    return {Finding::warning(
        "mesh-beside-water",
        {"{}: file {} reaches from {} to {}, and the water, the openings and all other walls from {} to {}, so it "
         "stands beside them",
         label, table.file, place<3>(own.min()), place<3>(own.max()), place<3>(others.min()), place<3>(others.max())},
        {"correct translate, or scale = {:g} (0.001 for a file in millimetres)", table.scale})};
  }
  if (table.fluid_side != FluidSide::outside) return {};
  const double length = own.sizes().maxCoeff();
  const double length_of_others = others.sizes().maxCoeff();
  if (length <= largest_share_of_case * length_of_others) return {};
  return {Finding::warning(
      "mesh-displaces-water",
      {"{}: file {} is a body {:.6g} long, and water and walls have a length of {:.6g} m: it would displace the water "
       "inside it",
       label, table.file, Amount{length, "m"}, length_of_others},
      {"correct scale = {:g} (0.001 for a file in millimetres), or cut off the parts that the water does not reach",
       table.scale})};
}

Findings check_size_and_place(const CaseSpec& spec, const Boundary<3>& boundary, int wall, const MeshSurface& surface,
                              const Box<3>& water) {
  Findings findings = check_size(spec, wall_label(boundary, wall), surface, water);
  return findings.empty() ? check_place(spec, boundary, wall, surface, water) : findings;
}

bool share_a_point(const TriangleMesh& mesh, int a, int b) {
  return std::ranges::any_of(mesh.triangles[a], [&](int p) { return std::ranges::count(mesh.triangles[b], p) > 0; });
}

/// A place where an edge of one triangle of the boundary passes through another.
std::optional<Vec<3>> crossing_of_triangles(const WallFace<3>& a, const WallFace<3>& b, double tolerance) {
  for (const auto& [from, through] : {std::pair{&a, &b}, {&b, &a}}) {
    for (int c = 0; c < 3; ++c) {
      const Vec<3>& low = from->corners[c];
      const Vec<3>& high = from->corners[(c + 1) % 3];
      if (crosses(*through, low, high, tolerance)) return meet(*through, low, high);
    }
  }
  return std::nullopt;
}

Findings check_self_crossing(const MeshSurface& surface, const CaseLabel& label, double tolerance) {
  const TriangleMesh& mesh = surface.mesh();
  for (int one = 0; one < static_cast<int>(mesh.triangles.size()); ++one) {
    const WallFace<3> face = face_of(mesh, one);
    const Box<3> box = face.box();
    std::optional<Finding> found;
    surface.visit_in(box.min(), box.max(), [&](int other) {
      if (other <= one || found || share_a_point(mesh, one, other)) return;
      const auto where = crossing_of_triangles(face, face_of(mesh, other), tolerance);
      if (!where) return;
      found = Finding::error("mesh-crosses-itself",
                             {"{} crosses itself at {}, where triangles {} and {} pass through each other", label,
                              place(*where), one + 1, other + 1},
                             {"unite the bodies of the file where they overlap, or correct the triangles"});
    });
    if (found) return {*found};
  }
  return {};
}

/// Tests straight back from the middle of triangles at least dx apart.
Findings check_thickness(const CaseSpec& spec, const Boundary<3>& boundary, const WallMesh& mesh,
                         const CaseLabel& label) {
  const double dx = spec.particles.spacing;
  const double tolerance = corner_tolerance * dx;
  const double needed = dummy_layers(spec) * dx;
  const MeshSurface& surface = *mesh.surface;
  PointGrid<3> seen(dx);
  for (int t = mesh.first_face; t < mesh.end_face(); ++t) {
    const WallFace<3>& face = boundary.faces[t];
    const Vec<3> middle = (face.corners[0] + face.corners[1] + face.corners[2]) / 3.0;
    if (seen.has_near(middle)) continue;
    seen.add(middle);
    const int behind = surface.first_crossed(middle - 2.0 * tolerance * face.normal,
                                             middle - (needed - tolerance) * face.normal, tolerance);
    if (behind < 0 || share_a_point(surface.mesh(), t - mesh.first_face, behind)) continue;
    const WallFace<3>& other = boundary.faces[mesh.first_face + behind];
    if (-face.normal.dot(other.normal) < min_facing_of_plate) continue;
    return {Finding::error("mesh-too-thin",
                           {"{} is only {:.3g} thick at {}, where both of its sides are fronts: its {} layers of wall "
                            "particles need {:.6g} m, or water on one side would interact with that on the other",
                            label, Amount{-other.height(middle), "m"}, place(middle), dummy_layers(spec), needed},
                           {"make it thicker or the spacing smaller, and draw no surface around a hollow inside"})};
  }
  return {};
}

}  // namespace

Findings check_meshes(const CaseSpec& spec, const Boundary<3>& boundary, const FluidParticles<3>& fluid) {
  const double tolerance = corner_tolerance * spec.particles.spacing;
  const Box<3> water = fluid.box();
  Findings findings;
  for (const WallMesh& mesh : boundary.meshes) {
    const CaseLabel label = wall_label(boundary, mesh.wall);
    append(findings, check_size_and_place(spec, boundary, mesh.wall, *mesh.surface, water));
    append(findings, check_self_crossing(*mesh.surface, label, tolerance));
    append(findings, check_thickness(spec, boundary, mesh, label));
  }
  for (const WallPlate& plate : boundary.plates) {
    if (!plate.sheet) continue;
    const CaseLabel label = wall_label(boundary, plate.wall);
    append(findings, check_size_and_place(spec, boundary, plate.wall, *plate.sheet, water));
    append(findings, check_self_crossing(*plate.sheet, label, tolerance));
  }
  for (std::size_t b = 0; b < boundary.water.size(); ++b) {
    if (boundary.water[b]) append(findings, check_self_crossing(*boundary.water[b], fluid_label(spec, b), tolerance));
  }
  return findings;
}

}  // namespace tailwater
