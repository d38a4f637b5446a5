#include "sampling/wall_particles.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "geometry/rotation.h"
#include "sampling/wall_layers.h"

namespace tailwater {
namespace {

/// dx; farther than the particles behind a wall are from it.
constexpr double reach_to_wall = 8.0;
/// Smallest part of half a cell that a plate cuts off; smaller ones are left where they are.
constexpr double least_part = 0.05;

// Which function samples the walls in each dimension.
WallParticles<2> sample(const Boundary<2>& body, const WallLayers& layers, const Lattice<2>& /*lattice*/) {
  return sample_chains(body, layers);
}
WallParticles<3> sample(const Boundary<3>& body, const WallLayers& layers, const Lattice<3>& lattice) {
  WallParticleCollector<3> collector(body, layers);
  sample_boxes(body, layers, collector);
  sample_meshes(body, layers, lattice, collector);
  return std::move(collector).particles();
}

/// Appends `part` to `all`, where `on_wall` numbers of particles on the wall, and `behind` of those behind it, are
/// taken.
template <int Dim>
void append(WallParticles<Dim>& all, WallParticles<Dim> part, std::int64_t on_wall, std::int64_t behind) {
  for (std::int64_t& number : part.number) {
    number += number < part.numbers_on_wall ? on_wall : all.numbers_on_wall + behind - part.numbers_on_wall;
  }
  if (all.size() == 0) {
    part.numbers = all.numbers;
    part.numbers_on_wall = all.numbers_on_wall;
    all = std::move(part);
    return;
  }
  const auto put = [](auto& into, const auto& entries) { into.insert(into.end(), entries.begin(), entries.end()); };
  all.apply_to_fields(
      [&](auto&... into) { part.apply_to_fields([&](const auto&... entries) { (put(into, entries), ...); }); });
}

/// A body with its own faces only, without plates.
template <int Dim>
Boundary<Dim> body_alone(const Boundary<Dim>& boundary, int body) {
  Boundary<Dim> alone;
  alone.walls = boundary.walls;
  std::ranges::copy_if(boundary.meshes, std::back_inserter(alone.meshes),
                       [&](const WallMesh& mesh) { return boundary.walls[mesh.wall].body == body; });
  // Meshes first: their faces are consecutive.
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
  return alone;
}

/// Samples each body as if it were alone, because bodies separate.
template <int Dim>
WallParticles<Dim> sample_bodies(const Boundary<Dim>& boundary, const WallLayers& layers, const Lattice<Dim>& lattice) {
  std::set<int> bodies;
  for (const WallProperties& wall : boundary.walls) bodies.insert(wall.body);
  std::vector<WallParticles<Dim>> parts;
  for (const int body : bodies)
    parts.push_back(sample(body_alone(boundary, body), layers.of_wall(body != resting_body), lattice));
  for (WallParticles<Dim>& side : sample_plates<Dim>(boundary, layers, lattice)) parts.push_back(std::move(side));
  if constexpr (Dim == 2) {
    // Plates and free ends have no particles on the wall itself.
    if (!layers.starts_on_wall) {
      for (WallParticles<2>& beyond : sample_beyond_ends(boundary, layers)) parts.push_back(std::move(beyond));
    }
  }
  WallParticles<Dim> all;
  for (const WallParticles<Dim>& part : parts) {
    all.numbers += part.numbers;
    all.numbers_on_wall += part.numbers_on_wall;
  }
  std::int64_t on_wall = 0;
  std::int64_t behind = 0;
  for (WallParticles<Dim>& part : parts) {
    const std::int64_t more_on_wall = part.numbers_on_wall;
    const std::int64_t more_behind = part.numbers - part.numbers_on_wall;
    append(all, std::move(part), on_wall, behind);
    on_wall += more_on_wall;
    behind += more_behind;
  }
  all.apply_to_fields([](auto&... field) { (field.shrink_to_fit(), ...); });
  return all;
}

/// Appends a part of the particle `row` of `whole`.
template <int Dim>
void append_part(WallParticles<Dim>& parts, const WallParticles<Dim>& whole, std::size_t row, const Vec<Dim>& position,
                 double share, std::int64_t number) {
  parts.position.push_back(position);
  parts.normal.push_back(whole.normal[row]);
  parts.blocked.push_back(whole.blocked[row]);
  parts.beyond_edges.push_back(whole.beyond_edges[row]);
  parts.share.push_back(share);
  parts.wall.push_back(whole.wall[row]);
  parts.is_beyond_end.push_back(whole.is_beyond_end[row]);
  parts.number.push_back(number);
}

/// The screen of a plate nearer to `x` than `distance`, drawn on behind the wall of `x`; null if there is none.
template <int Dim>
const Screen<Dim>* plate_through(const Boundary<Dim>& boundary, const Vec<Dim>& x, double distance) {
  for (const int s : boundary.screens_near(x, distance)) {
    const Screen<Dim>& screen = boundary.screens[s];
    if (screen.is_plate && !screen.is_beyond && screen.distance(x) < distance) return &screen;
  }
  return nullptr;
}

/// Divides the particles of walls whose cells are cut by a plate that ends on the wall. Each part acts on the water of
/// its side. A whole particle would fill too much of the support on one side of the plate's foot and too little on the
/// other, and still water would circulate.
template <int Dim>
void cut_by_plates(const Boundary<Dim>& boundary, double spacing, WallParticles<Dim>& particles) {
  if (boundary.plates.empty()) return;
  WallParticles<Dim> cut;
  cut.numbers = 2 * particles.numbers;
  cut.numbers_on_wall = 2 * particles.numbers_on_wall;
  for (std::size_t row = 0; row < particles.size(); ++row) {
    const Vec<Dim>& x = particles.position[row];
    const double half = 0.5 * spacing * std::pow(particles.share[row], 1.0 / (Dim - 1));
    const bool is_of_plate = boundary.walls[particles.wall[row]].is_plate;
    const Screen<Dim>* plate = is_of_plate ? nullptr : plate_through(boundary, x, (1.0 - least_part) * half);
    if (plate == nullptr) {
      append_part(cut, particles, row, x, particles.share[row], 2 * particles.number[row]);
      continue;
    }
    const double height = plate->height(x);
    for (const int part : {0, 1}) {
      const double side = part == 0 ? half : -half;
      const Vec<Dim> middle = x + 0.5 * (side - height) * plate->normal;
      const double share = particles.share[row] * 0.5 * (1.0 + height / side);
      append_part(cut, particles, row, middle, share, 2 * particles.number[row] + part);
    }
  }
  particles = std::move(cut);
}

/// The normal of a wall, and directions along it.
template <int Dim>
Mat<Dim> axes_at_wall(const Boundary<Dim>& boundary, const NearestWall<Dim>& wall) {
  Mat<Dim> axes = Mat<Dim>::Identity();
  if (wall.face < 0) return axes;
  const Vec<Dim>& normal = boundary.faces[wall.face].normal;
  axes.put_column(0, normal);
  if constexpr (Dim == 2) {
    axes.put_column(1, Vec<2>(-normal[1], normal[0]));
  } else {
    axes.put_column(1, across(normal));
    axes.put_column(2, normal.cross(axes.col(1)));
  }
  return axes;
}

}  // namespace

template <int Dim>
WallParticles<Dim> make_dummy_particles(const Boundary<Dim>& boundary, double spacing, int layers,
                                        const SpaceShare& share, const Lattice<Dim>& lattice) {
  WallParticles<Dim> particles = sample_bodies<Dim>(
      boundary, {.spacing = spacing, .count = layers, .starts_on_wall = false, .share = share}, lattice);
  cut_by_plates(boundary, spacing, particles);
  return particles;
}

template <int Dim>
WallParticles<Dim> make_surface_particles(const Boundary<Dim>& boundary, double spacing, const SpaceShare& share) {
  return make_row_and_dummy_particles(boundary, spacing, 1, share);
}

template <int Dim>
WallParticles<Dim> make_row_and_dummy_particles(const Boundary<Dim>& boundary, double spacing, int layers,
                                                const SpaceShare& share) {
  return sample_bodies<Dim>(boundary, {.spacing = spacing, .count = layers, .starts_on_wall = true, .share = share},
                            Lattice<Dim>{});
}

template <int Dim>
void divide_wall_particles(const SpacingField<Dim>& field, const Boundary<Dim>& boundary, double spacing, int layers,
                           WallParticles<Dim>& particles) {
  const std::int64_t parts_of_row = std::llround(power<Dim>(1.0 / field.finest()));
  WallParticles<Dim> divided;
  divided.numbers = particles.numbers * parts_of_row;
  divided.numbers_on_wall = particles.numbers_on_wall * parts_of_row;
  for (std::size_t row = 0; row < particles.size(); ++row) {
    const Vec<Dim>& x = particles.position[row];
    const NearestWall<Dim> wall = boundary.nearest(x, reach_to_wall * spacing);
    const int per_edge = 1 << std::lround(-std::log2(field.at(wall.face < 0 ? x : wall.point)));
    const Mat<Dim> axes = axes_at_wall(boundary, wall);
    const double edge = spacing / per_edge;
    // Where the spacing is the same all around, no water reaches parts behind the layers of this spacing.
    const bool may_leave_out = particles.is_beyond_end[row] == 0 && wall.face >= 0 &&
                               field.nearest_border(x).distance > 2.0 * layers * spacing;
    for (int part = 0; part < static_cast<int>(power<Dim>(per_edge)); ++part) {
      Vec<Dim> steps;
      for (int axis = 0, rest = part; axis < Dim; ++axis, rest /= per_edge) {
        steps[axis] = edge * (rest % per_edge - 0.5 * (per_edge - 1));
      }
      const Vec<Dim> place = x + axes * steps;
      if (may_leave_out && boundary.nearest(place, layers * edge).face < 0) continue;
      append_part(divided, particles, row, place, particles.share[row] / power<Dim>(per_edge),
                  particles.number[row] * parts_of_row + part);
    }
  }
  particles = std::move(divided);
}

TAILWATER_IN_2D_AND_3D(divide_wall_particles);
TAILWATER_IN_2D_AND_3D(make_dummy_particles);
TAILWATER_IN_2D_AND_3D(make_surface_particles);
TAILWATER_IN_2D_AND_3D(make_row_and_dummy_particles);

}  // namespace tailwater
