#include "sampling/wall_particles.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "geometry/rotation.h"
#include "sampling/lone_body.h"
#include "sampling/wall_layers.h"

namespace tailwater {
namespace {

/// dx; search radius for the wall of a wall particle, which is nearer to its wall.
constexpr double reach_to_wall = 8.0;
/// Fraction of half a cell. A plate that cuts off less than this does not divide the cell.
constexpr double min_part = 0.05;

/// Appends `part` to `all`. Earlier parts have taken `on_wall` of the numbers for particles on the wall, and `behind`
/// of those for particles behind it.
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

/// The particles of several parts, with numbers one after the other.
template <int Dim>
WallParticles<Dim> joined(std::vector<WallParticles<Dim>> parts) {
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

// The functions that sample a body in each dimension.
WallParticles<2> sample(const LoneBody<2>& body, const WallLayers& layers, const Lattice<2>& /*lattice*/) {
  return sample_chains(body.boundary, layers);
}
WallParticles<3> sample(const LoneBody<3>& body, const WallLayers& layers, const Lattice<3>& lattice) {
  WallParticleCollector<3> collector(body.boundary, layers);
  sample_boxes(body.boundary, layers, collector);
  sample_meshes(body.boundary, body.meshes, layers, lattice, collector);
  return std::move(collector).particles();
}

/// Samples each body as if it were alone, because bodies separate.
template <int Dim>
WallParticles<Dim> sample_bodies(const Boundary<Dim>& boundary, const WallLayers& layers, const Lattice<Dim>& lattice) {
  std::set<int> bodies;
  for (const WallProperties& wall : boundary.walls) bodies.insert(wall.body);
  std::vector<WallParticles<Dim>> parts;
  for (const int body : bodies)
    parts.push_back(sample(body_alone(boundary, body, reach_to_wall * layers.spacing),
                           layers.of_wall(body != resting_body), lattice));
  for (WallParticles<Dim>& side : sample_plates<Dim>(boundary, layers, lattice)) parts.push_back(std::move(side));
  if constexpr (Dim == 2) {
    // Plates and free ends have no particles on the wall itself.
    if (!layers.starts_on_wall) {
      for (WallParticles<2>& beyond : sample_beyond_ends(boundary, layers)) parts.push_back(std::move(beyond));
    }
  }
  return joined(std::move(parts));
}

/// Appends a part of the particle `row` of `whole`.
template <int Dim>
void append_part(WallParticles<Dim>& parts, const WallParticles<Dim>& whole, std::size_t row, const Vec<Dim>& position,
                 double share, std::int64_t number) {
  parts.apply_to_fields(
      [&](auto&... into) { whole.apply_to_fields([&](const auto&... from) { (into.push_back(from[row]), ...); }); });
  parts.position.back() = position;
  parts.share.back() = share;
  parts.number.back() = number;
}

/// The screen of a plate that is nearer to `x` than `distance` and extends behind the wall of `x`; null without one.
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
    const Screen<Dim>* plate = is_of_plate ? nullptr : plate_through(boundary, x, (1.0 - min_part) * half);
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

/// For each wall, whether its particles stand on the lattice of the water, as those of meshes do.
template <int Dim>
std::vector<bool> walls_on_lattice(const Boundary<Dim>& boundary) {
  std::vector<bool> on_lattice(boundary.walls.size(), false);
  for (const WallMesh& mesh : boundary.meshes) on_lattice[mesh.wall] = true;
  for (const WallPlate& plate : boundary.plates) {
    if (plate.sheet) on_lattice[plate.wall] = true;
  }
  return on_lattice;
}

/// The particles of walls on the lattice of the water, without those of other walls.
template <int Dim>
WallParticles<Dim> sample_on_lattice(const Boundary<Dim>& boundary, const WallLayers& layers,
                                     const Lattice<Dim>& lattice) {
  std::vector<WallParticles<Dim>> parts;
  if constexpr (Dim == 3) {
    std::set<int> bodies;
    for (const WallMesh& mesh : boundary.meshes) bodies.insert(boundary.walls[mesh.wall].body);
    for (const int body : bodies) {
      const LoneBody<3> alone = body_alone(boundary, body, reach_to_wall * layers.spacing);
      const WallLayers of_body = layers.of_wall(body != resting_body);
      WallParticleCollector<3> collector(alone.boundary, of_body);
      sample_meshes(alone.boundary, alone.meshes, of_body, lattice, collector);
      parts.push_back(std::move(collector).particles());
    }
    Boundary<3> sheets = boundary;
    std::erase_if(sheets.plates, [](const WallPlate& plate) { return plate.sheet == nullptr; });
    for (WallParticles<3>& side : sample_plates<3>(sheets, layers, lattice)) parts.push_back(std::move(side));
  }
  return joined(std::move(parts));
}

/// Number of times that the edges of a wall particle at `x` are halved; `wall` is the wall nearest to it. Walls at rest
/// have the finest level if a zone moves, because it may come to any of them.
template <int Dim>
int level_at(const SpacingField<Dim>& field, const Boundary<Dim>& boundary, const NearestWall<Dim>& wall,
             const Vec<Dim>& x) {
  const bool is_passed = field.moves() && wall.face >= 0 && !boundary.walls[boundary.faces[wall.face].wall].moves();
  const double spacing = is_passed ? field.finest() : field.at(wall.face < 0 ? x : wall.point);
  return static_cast<int>(std::lround(-std::log2(spacing)));
}

/// The level of each cell of a lattice: the number of times that its edges are halved.
template <int Dim>
struct LevelsOfCells {
  const SpacingField<Dim>& field;
  const Boundary<Dim>& boundary;
  double spacing;
  const Lattice<Dim>& lattice;

  /// The level of the cell that contains x.
  int at(const Vec<Dim>& x) const {
    const auto centre =
        Vec<Dim>::NullaryExpr([&](int axis) { return lattice[axis].centre(lattice[axis].cell_at(x[axis])); });
    return level_at(field, boundary, boundary.nearest(centre, reach_to_wall * spacing), centre);
  }
};

/// The walls that are neither meshes nor plates.
template <int Dim>
Boundary<Dim> plain_walls(const Boundary<Dim>& boundary) {
  Boundary<Dim> plain;
  plain.walls = boundary.walls;
  boundary.visit_plain_faces([&](int f) {
    if (boundary.plate_of(boundary.faces[f].wall) < 0) plain.faces.push_back(boundary.faces[f]);
  });
  return plain;
}

/// The rows of dummies of one spacing behind plain walls. Parts of coarser particles get the normals of these rows,
/// because beside edges of walls the normals of coarser rows differ. Every rank makes all rows.
template <int Dim>
class RowsOfSpacing {
 public:
  RowsOfSpacing(const Boundary<Dim>& plain, double spacing, int layers)
      : rows_(sample_bodies<Dim>(plain, WallLayers{spacing, layers, false, {}}, Lattice<Dim>{})),
        places_(0.5 * spacing) {
    for (const Vec<Dim>& x : rows_.position) places_.add(x);
  }

  /// Gives the last of `parts` the normals of the nearest particle of the same wall, if one is near.
  void give_normals(WallParticles<Dim>& parts) const {
    const Vec<Dim>& x = parts.position.back();
    int nearest = -1;
    places_.visit_near(x, [&](int row) {
      if (rows_.wall[row] != parts.wall.back() || rows_.is_beyond_end[row] != 0) return;
      if (nearest < 0 || (rows_.position[row] - x).norm() < (rows_.position[nearest] - x).norm()) nearest = row;
    });
    if (nearest < 0) return;
    parts.normal.back() = rows_.normal[nearest];
    parts.blocked.back() = rows_.blocked[nearest];
    parts.beyond_edges.back() = rows_.beyond_edges[nearest];
  }

 private:
  WallParticles<Dim> rows_;
  PointGrid<Dim> places_;
};

/// Appends particles of a level on the finer lattice in the cells of that level.
template <int Dim>
void append_level(const LevelsOfCells<Dim>& levels, int level, const WallLayers& layers, WallParticles<Dim>& all) {
  const int per_edge = 1 << level;
  Lattice<Dim> finer = levels.lattice;
  for (LatticeAxis& axis : finer) axis = axis.divided(per_edge);
  // Supports are larger near a coarser level, so one more layer is needed. Beside zones that move, supports may be
  // those of the spacing of the case.
  const int count = levels.field.moves() ? layers.count * per_edge : layers.count + 1;
  const WallParticles<Dim> fine =
      sample_on_lattice<Dim>(levels.boundary, {layers.spacing / per_edge, count, false, layers.share}, finer);
  for (std::size_t row = 0; row < fine.size(); ++row) {
    if (levels.at(fine.position[row]) != level) continue;
    append_part(all, fine, row, fine.position[row], fine.share[row] / power<Dim>(per_edge),
                fine.number[row] + all.numbers);
  }
  all.numbers += fine.numbers;
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
                           const SpaceShare& share, const Lattice<Dim>& lattice, WallParticles<Dim>& particles) {
  const std::int64_t parts_of_row = std::llround(power<Dim>(1.0 / field.finest()));
  const std::vector<bool> on_lattice = walls_on_lattice(boundary);
  const LevelsOfCells<Dim> levels{field, boundary, spacing, lattice};
  const Boundary<Dim> plain = plain_walls(boundary);
  std::vector<RowsOfSpacing<Dim>> finer;
  for (int level = 1; level <= std::lround(-std::log2(field.finest())); ++level) {
    finer.emplace_back(plain, spacing / (1 << level), layers);
  }
  WallParticles<Dim> divided;
  divided.numbers = particles.numbers * parts_of_row;
  divided.numbers_on_wall = particles.numbers_on_wall * parts_of_row;
  for (std::size_t row = 0; row < particles.size(); ++row) {
    const Vec<Dim>& x = particles.position[row];
    const bool is_on_lattice = on_lattice[particles.wall[row]];
    if (is_on_lattice && levels.at(x) > 0) continue;  // sampled below
    const NearestWall<Dim> wall = boundary.nearest(x, reach_to_wall * spacing);
    const int level = is_on_lattice ? 0 : level_at(field, boundary, wall, x);
    const int per_edge = 1 << level;
    const bool has_sides = boundary.walls[particles.wall[row]].is_plate || particles.is_beyond_end[row] != 0;
    const Mat<Dim> axes = axes_at_wall(boundary, wall);
    const double edge = spacing / per_edge;
    // Where the spacing is the same all around, no water reaches parts behind the layers of this spacing.
    const bool may_leave_out = field.carrier() < 0 && particles.is_beyond_end[row] == 0 && wall.face >= 0 &&
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
      if (level > 0 && !has_sides) finer[level - 1].give_normals(divided);
    }
  }
  if (std::ranges::find(on_lattice, true) != on_lattice.end()) {
    const WallLayers of_case{spacing, layers, false, share};
    for (int level = 1; level <= std::lround(-std::log2(field.finest())); ++level) {
      append_level(levels, level, of_case, divided);
    }
  }
  particles = std::move(divided);
}

TAILWATER_IN_2D_AND_3D(divide_wall_particles);
TAILWATER_IN_2D_AND_3D(make_dummy_particles);
TAILWATER_IN_2D_AND_3D(make_surface_particles);
TAILWATER_IN_2D_AND_3D(make_row_and_dummy_particles);

}  // namespace tailwater
