// The walls as the case file draws them.
#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "geometry/boundary.h"
#include "geometry/from_spec.h"
#include "geometry/mesh_surface.h"
#include "geometry/mesh_walls.h"
#include "geometry/opening.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

/// Some checks compare every piece of the walls with every other.
constexpr std::size_t max_faces = 5000;

double friction_of(const WallTable& wall) {
  switch (wall.slip) {
    case Slip::free:
      return 0.0;
    case Slip::no_slip:
      return 1.0;
    case Slip::partial:
      return wall.friction;
    case Slip::coulomb:
      return wall.friction > 0.0 ? 1.0 : 0.0;
  }
  return 0.0;
}

/// k_s [m]. Strickler: U/u_tau = 8.1 (h/k_s)^(1/6), which is Manning's formula with n = k_s^(1/6)/(8.1 sqrt(g)).
double roughness_of(const WallTable& wall) {
  constexpr double g = 9.81;  // m/s^2; n is a property of the wall on Earth
  return wall.manning > 0.0 ? std::pow(8.1 * std::sqrt(g) * wall.manning, 6) : wall.roughness;
}

/// The table of the case file that a wall is from.
std::string kind_of(const WallTable& wall) {
  switch (wall.drive.by) {
    case Drive::By::gate:
      return "gate";
    case Drive::By::wave_maker:
      return "wave_maker";
    case Drive::By::wall:
    case Drive::By::body:
      break;
  }
  return "wall";
}

/// The body of wall `w`. Walls whose motion is written alike are one body.
int body_of(const CaseSpec& spec, std::size_t w) {
  const WallTable& wall = spec.walls[w];
  const auto varies = [](const Varying& value) { return std::holds_alternative<std::string>(value); };
  const bool is_driven = wall.drive.by != Drive::By::wall || !wall.series.empty();
  if (!is_driven && !varies(wall.rotation) && std::ranges::none_of(wall.displacement, varies)) return resting_body;
  const auto same = std::ranges::find_if(spec.walls, [&](const WallTable& other) {
    return other.displacement == wall.displacement && other.rotation == wall.rotation && other.pivot == wall.pivot &&
           other.axis == wall.axis && other.drive == wall.drive && other.motion == wall.motion;
  });
  return 1 + static_cast<int>(same - spec.walls.begin());
}

/// The faces of a polyline or polygon, in the order of its points.
void append_chain(const WallTable& table, int wall, const CaseLabel& owner, double spacing,
                  std::vector<WallFace<2>>& faces) {
  const bool closed = table.shape == WallShape::polygon;
  std::vector<Vec<2>> points;
  for (std::size_t k = 0; k < table.points.size(); ++k) {
    points.push_back(to_vec<2>(table.points[k], owner, fmt::format("points[{}]", k)));
  }
  const std::size_t least = closed ? 3 : 2;
  if (points.size() < least) {
    throw CaseError("wall-too-few-points", {"{} has {} points", owner, points.size()},
                    {"give a {} at least {}", name_of(table.shape), least});
  }
  const std::size_t face_count = closed ? points.size() : points.size() - 1;
  for (std::size_t k = 0; k < face_count; ++k) {
    const std::size_t next = (k + 1) % points.size();
    const double length = (points[next] - points[k]).norm();
    if (length > corner_tolerance * spacing) continue;
    const CaseLabel key = owner.with_key("points");
    if (length == 0.0) {
      throw CaseError("wall-points-coincide",
                      {"{}[{}] and points[{}] are both at {}, so the piece between them has no length", key, k, next,
                       place(points[k])},
                      {"remove one of them"});
    }
    throw CaseError("wall-points-too-close",
                    {"{}[{}] and points[{}] are {:.3g} apart at {}, too close for a spacing of {:.6g} m", key, k, next,
                     Amount{length, "m"}, place(points[k]), spacing},
                    {"use a smaller spacing, or remove one of the points"});
  }

  bool fluid_is_left = table.fluid_side == FluidSide::left;
  if (table.fluid_side == FluidSide::inside || table.fluid_side == FluidSide::outside) {
    if (!closed) {
      throw CaseError("polyline-fluid-side", {"{}: a polyline has no {}", owner, name_of(table.fluid_side)},
                      {"set fluid_side to \"left\" or \"right\", as seen when walking along its points"});
    }
    const double area = signed_area(points);
    if (std::abs(area) <= corner_tolerance * spacing * spacing) {
      throw CaseError("polygon-without-area",
                      {"{}: the polygon through {} encloses no area, so it has no inside", owner, place(points[0])},
                      {"move its points apart"});
    }
    fluid_is_left = (area > 0.0) == (table.fluid_side == FluidSide::inside);
  }
  for (std::size_t k = 0; k < face_count; ++k) {
    Vec<2> from = points[k];
    Vec<2> to = points[(k + 1) % points.size()];
    if (!fluid_is_left) std::swap(from, to);
    const Vec<2> along = (to - from).normalized();
    faces.push_back({{from, to}, Vec<2>(-along[1], along[0]), wall});
  }
}

/// One face of a box: the low (`side` 0) or high (1) one across `axis`, with corners ordered as seen from the fluid.
template <int Dim>
void append_box_face(const std::array<Vec<Dim>, 2>& ends, int axis, int side, bool fluid_is_inside, int wall,
                     std::vector<WallFace<Dim>>& faces) {
  const double sign = (side == 0) == fluid_is_inside ? 1.0 : -1.0;
  const Vec<Dim> normal = sign * Vec<Dim>::Unit(axis);
  const auto corner = [&](int first, int second) {
    Vec<Dim> x = ends[side];
    x[(axis + 1) % Dim] = ends[first][(axis + 1) % Dim];
    if constexpr (Dim == 3) x[(axis + 2) % Dim] = ends[second][(axis + 2) % Dim];
    return x;
  };
  if constexpr (Dim == 2) {
    // Fluid on the left: walk along (n_y, -n_x).
    const bool upwards = (axis == 0 ? -normal[0] : normal[1]) > 0.0;
    faces.push_back({{corner(upwards ? 0 : 1, 0), corner(upwards ? 1 : 0, 0)}, normal, wall});
  } else {
    std::array<Vec<3>, 4> c{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
    if (sign < 0.0) std::reverse(c.begin(), c.end());
    faces.push_back({{c[0], c[1], c[2]}, normal, wall});
    faces.push_back({{c[0], c[2], c[3]}, normal, wall});
  }
}

template <int Dim>
void append_box(const WallTable& table, int wall, const CaseLabel& owner, double spacing,
                std::vector<WallFace<Dim>>& faces) {
  static const std::array<std::string, 6> all_names{"-x", "+x", "-y", "+y", "-z", "+z"};
  const std::array<Vec<Dim>, 2> ends{to_vec<Dim>(table.min, owner, "min"), to_vec<Dim>(table.max, owner, "max")};
  for (int axis = 0; axis < Dim; ++axis) {
    if (ends[1][axis] - ends[0][axis] <= corner_tolerance * spacing) {
      throw CaseError(
          "box-without-extent",
          {"{} has no extent in {}: its max is {} and its min {}", owner, "xyz"[axis], ends[1][axis], ends[0][axis]},
          {"give a max above min"});
    }
  }
  const auto names_end = all_names.begin() + 2 * Dim;
  for (const std::string& name : table.open) {
    if (std::find(all_names.begin(), names_end, name) == names_end) {
      throw CaseError("box-unknown-face", {"{} = \"{}\" is not a face of a {}D box", owner.with_key("open"), name, Dim},
                      {"use \"{}\"", fmt::join(all_names.begin(), names_end, "\", \"")});
    }
  }
  const bool fluid_is_inside = table.fluid_side == FluidSide::inside || table.fluid_side == FluidSide::left;
  const std::size_t before = faces.size();
  for (int face = 0; face < 2 * Dim; ++face) {
    if (std::find(table.open.begin(), table.open.end(), all_names[face]) == table.open.end()) {
      append_box_face<Dim>(ends, face / 2, face % 2, fluid_is_inside, wall, faces);
    }
  }
  if (faces.size() == before) {
    throw CaseError("box-without-faces",
                    {"{}, the box from {} to {}, has no face left", owner, place(ends[0]), place(ends[1])},
                    {"shorten its list of open faces"});
  }
}

/// The two triangles of a rectangle, whose corners are in order, as seen from either side.
std::vector<WallFace<3>> rectangle_faces(const std::vector<Vec<3>>& c, const Vec<3>& normal, int wall) {
  return {{{c[0], c[1], c[2]}, normal, wall},
          {{c[0], c[2], c[3]}, normal, wall},
          {{c[0], c[2], c[1]}, -normal, wall},
          {{c[0], c[3], c[2]}, -normal, wall}};
}

template <int Dim>
void append_plate(const WallTable& table, int wall, const CaseLabel& owner, double spacing, Boundary<Dim>& boundary) {
  const int first = static_cast<int>(boundary.faces.size());
  if constexpr (Dim == 2) {
    WallTable side = table;
    side.shape = WallShape::polyline;
    for (const FluidSide water : {FluidSide::left, FluidSide::right}) {
      side.fluid_side = water;
      append_chain(side, wall, owner, spacing, boundary.faces);
    }
  } else {
    std::vector<Vec<3>> corners;
    for (std::size_t k = 0; k < table.points.size(); ++k) {
      corners.push_back(to_vec<3>(table.points[k], owner, fmt::format("points[{}]", k)));
    }
    const double tolerance = corner_tolerance * spacing;
    const bool is_rectangle =
        corners.size() == 4 && (corners[0] + corners[2] - corners[1] - corners[3]).norm() <= tolerance &&
        (corners[1] - corners[0]).norm() > tolerance && (corners[3] - corners[0]).norm() > tolerance &&
        std::abs((corners[1] - corners[0]).normalized().dot(corners[3] - corners[0])) <= tolerance;
    if (!is_rectangle) {
      throw CaseError(
          "plate-not-rectangle",
          {"{}: its {} points are not the corners of a rectangle, as a plate in 3D needs", owner, corners.size()},
          {"give its four corners in order, with right angles between its edges"});
    }
    const Vec<3> normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalized();
    for (const WallFace<3>& face : rectangle_faces(corners, normal, wall)) boundary.faces.push_back(face);
  }
  boundary.plates.push_back({wall, first, (static_cast<int>(boundary.faces.size()) - first) / 2});
}

/// Plates are filed in cells of space before the memory of the particles is known (Boundary::hang_screens).
constexpr double max_cells_of_a_plate = 3e8;
/// Cells beside the plate, which are filed, take a hundred bytes each. So long a plate has 1e8 particles and more.
constexpr double max_filed_cells = 1e7;

template <int Dim>
void require_few_cells(const Boundary<Dim>& boundary, std::size_t first_face, const CaseLabel& owner, double spacing,
                       double reach) {
  Box<Dim> box;
  double filed = 0.0;
  for (std::size_t f = first_face; f < boundary.faces.size(); ++f) {
    box.extend(boundary.faces[f].box());
    filed += boundary.faces[f].measure() / power<Dim>(reach) * reach;
  }
  const bool has_few_cells = box.isEmpty() || (box.sizes() / reach).cwiseMax(1.0).prod() <= max_cells_of_a_plate;
  if (has_few_cells && filed <= max_filed_cells) return;
  const double length = box.sizes().maxCoeff();
  throw CaseError(
      "plate-too-large",
      {"{} reaches over {:.3g}, which is {:.3g} times particles.spacing", owner, Amount{length, "m"}, length / spacing},
      {"use a larger spacing, or a smaller plate, drawn in metres"});
}

/// The meshes of the blocks of water.
std::vector<std::shared_ptr<const MeshSurface>> water_meshes(const CaseSpec& spec, const Boundary<3>& boundary) {
  const Box<3> walls = box_around(boundary.faces);
  std::vector<std::shared_ptr<const MeshSurface>> water(spec.fluid.size());
  for (std::size_t b = 0; b < spec.fluid.size(); ++b) {
    if (spec.fluid[b].shape != BlockShape::mesh) continue;
    water[b] = std::make_shared<const MeshSurface>(make_water_mesh(spec, spec.fluid[b], fluid_label(spec, b), walls));
  }
  return water;
}

/// The openings beyond which walls continue, and the planes between which the case repeats itself, as far as the walls
/// reach.
template <int Dim>
std::vector<WallFace<Dim>> places_where_walls_continue(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  std::vector<WallFace<Dim>> faces;
  for (const Opening<Dim>& end : make_open_ends<Dim>(spec)) {
    if (end.meets_air) continue;
    for (const WallFace<Dim>& face : end.as_faces()) faces.push_back(face);
  }
  Box<Dim> box = box_around(boundary.faces);
  for (int axis = 0; axis < Dim && !box.isEmpty(); ++axis) {  // around a single flat wall the planes need an area
    if (box.min()[axis] == box.max()[axis]) box.max()[axis] += spec.particles.spacing;
  }
  for (int axis = 0; axis < Dim && !box.isEmpty(); ++axis) {
    for (const double at : periodic_range(spec.domain, axis)) {
      std::array<Vec<Dim>, 2> ends{box.min(), box.max()};
      for (const int side : {0, 1}) ends[side][axis] = at;
      append_box_face<Dim>(ends, axis, 0, true, -1, faces);
    }
  }
  return faces;
}

}  // namespace

template <int Dim>
Boundary<Dim> make_boundary(const CaseSpec& spec) {
  Boundary<Dim> boundary;
  boundary.domain = periodic_domain<Dim>(spec.domain);
  std::size_t compared = 0;
  for (std::size_t w = 0; w < spec.walls.size(); ++w) {
    const WallTable& table = spec.walls[w];
    const std::size_t before = boundary.faces.size();
    const int wall = static_cast<int>(w);
    boundary.walls.push_back({name_or_number(table.name, "wall", w), friction_of(table), roughness_of(table),
                              body_of(spec, w), kind_of(table)});
    const CaseLabel owner = wall_label(boundary, wall);
    boundary.walls[wall].is_plate = table.shape == WallShape::plate;
    if (table.slip == Slip::coulomb) boundary.walls[wall].coulomb_friction = table.friction;
    if (Dim == 3 && table.shape == WallShape::plate && !table.file.empty()) {
      if constexpr (Dim == 3) append_mesh_plate(spec, table, wall, owner, boundary);
    } else if (table.shape == WallShape::plate) {
      append_plate(table, wall, owner, spec.particles.spacing, boundary);
    } else if (table.shape == WallShape::box) {
      append_box<Dim>(table, wall, owner, spec.particles.spacing, boundary.faces);
    } else if constexpr (Dim == 2) {
      append_chain(table, wall, owner, spec.particles.spacing, boundary.faces);
    } else if (table.shape == WallShape::mesh) {
      append_mesh(spec, table, wall, owner, boundary);
    } else {
      throw CaseError("wall-shape-2d-only",
                      {"{} = \"{}\" exists in 2D only", owner.with_key("shape"), name_of(table.shape)},
                      {"in 3D use shape = \"box\" or \"mesh\""});
    }
    const double reach = dummy_layers(spec) * spec.particles.spacing;
    if (table.shape == WallShape::plate) require_few_cells(boundary, before, owner, spec.particles.spacing, reach);
    // The faces of a resting mesh are found by its own tree.
    if (table.shape != WallShape::mesh || boundary.walls.back().moves()) compared += boundary.faces.size() - before;
    if (compared > max_faces) {
      throw CaseError("too-many-wall-pieces",
                      {"{}: with it the walls have {} pieces{}, and a case has at most {}", owner, compared,
                       boundary.meshes.empty() ? "" : ", without meshes at rest", max_faces},
                      {"draw them coarser"});
    }
  }
  const double reach = dummy_layers(spec) * spec.particles.spacing;
  boundary.continued = places_where_walls_continue(spec, boundary);
  // Particles on the wall itself would act on both of its sides.
  if (!traits_of(spec).walls.on_wall) boundary.find_free_ends(spec.particles.spacing, reach);
  boundary.hang_screens(spec.particles.spacing, reach);
  if constexpr (Dim == 3) boundary.water = water_meshes(spec, boundary);
  return boundary;
}

TAILWATER_IN_2D_AND_3D(make_boundary);

}  // namespace tailwater
