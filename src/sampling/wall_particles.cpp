#include "sampling/wall_particles.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "geometry/rotation.h"
#include "geometry/some_walls.h"
#include "sampling/lone_body.h"
#include "sampling/wall_bodies.h"

namespace tailwater {
namespace {

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

/// The rows of dummies of one spacing behind plain walls. Every rank makes all rows.
template <int Dim>
class RowsOfSpacing {
 public:
  RowsOfSpacing(const Boundary<Dim>& boundary, const Boundary<Dim>& plain, double spacing, int layers)
      : rows_(sample_bodies<Dim>(plain, WallLayers{spacing, layers, false, {}}, Lattice<Dim>{})),
        places_(0.5 * spacing),
        half_spacing_(0.5 * spacing) {
    cut_by_plates(boundary, spacing, rows_);
    for (const Vec<Dim>& x : rows_.position) places_.add(x);
  }

  const WallParticles<Dim>& rows() const { return rows_; }

  /// The row nearest to a place, of this wall and not beyond its end, if one is near; else -1.
  int nearest_to(const Vec<Dim>& x, int wall) const {
    int nearest = -1;
    visit_near(x, wall, [&](int row) {
      if (nearest < 0 || (rows_.position[row] - x).norm() < (rows_.position[nearest] - x).norm()) nearest = row;
    });
    return nearest;
  }

  /// Whether such a row, nearer than half a spacing, fulfils a condition.
  template <class Condition>
  bool is_any_near(const Vec<Dim>& x, int wall, Condition&& holds) const {
    bool found = false;
    visit_near(x, wall, [&](int row) {
      const Vec<Dim>& place = rows_.position[row];
      found = found || ((place - x).norm() < half_spacing_ && holds(place));
    });
    return found;
  }

  /// Gives the last of `parts` the normals of the nearest row, if one is near. Beside edges of walls the normals of
  /// coarser rows differ.
  void give_normals(WallParticles<Dim>& parts) const {
    const int nearest = nearest_to(parts.position.back(), parts.wall.back());
    if (nearest < 0) return;
    parts.normal.back() = rows_.normal[nearest];
    parts.blocked.back() = rows_.blocked[nearest];
    parts.beyond_edges.back() = rows_.beyond_edges[nearest];
  }

 private:
  template <class Visit>
  void visit_near(const Vec<Dim>& x, int wall, Visit&& visit) const {
    places_.visit_near(x, [&](int row) {
      if (rows_.wall[row] == wall && rows_.is_beyond_end[row] == 0) visit(row);
    });
  }

  WallParticles<Dim> rows_;
  PointGrid<Dim> places_;
  double half_spacing_;  ///< m
};

/// Where the spacing is the same all around, the rows of that spacing take the place of those of the case: in a sharp
/// corner, parts of coarse particles are in front of the wall.
template <int Dim>
struct EvenSpacing {
  const SpacingField<Dim>& field;
  const Boundary<Dim>& boundary;
  double spacing;  ///< m; of the case
  int layers;

  bool is_around(const Vec<Dim>& x) const {
    return field.carrier() < 0 && field.nearest_border(x).distance > layers * spacing;
  }

  /// The level of the rows that take the place of a row of the case at x, of this wall; 0: none do.
  int level_of(const Vec<Dim>& x, int wall) const {
    if (boundary.walls[wall].is_plate || !is_around(x)) return 0;
    return level_at(field, boundary, boundary.nearest(x, reach_to_wall * spacing), x);
  }
};

/// Appends the rows of a level that take the place of rows of the case.
template <int Dim>
void append_rows(const EvenSpacing<Dim>& even, int level, const RowsOfSpacing<Dim>& of_case,
                 const RowsOfSpacing<Dim>& of_level, const SpaceShare& share, WallParticles<Dim>& all) {
  const WallParticles<Dim>& rows = of_level.rows();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const Vec<Dim>& x = rows.position[row];
    const int wall = rows.wall[row];
    if (rows.is_beyond_end[row] != 0 || !(even.boundary.walls[wall].moves() || share.holds(x))) continue;
    const int coarse = of_case.nearest_to(x, wall);
    if (even.level_of(coarse < 0 ? x : of_case.rows().position[coarse], wall) != level) continue;
    if (of_case.is_any_near(x, wall, [&](const Vec<Dim>& near) { return even.level_of(near, wall) == 0; })) continue;
    append_part(all, rows, row, x, rows.share[row] / power<Dim>(1 << level), rows.number[row] + all.numbers);
  }
  all.numbers += rows.numbers;
}

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
  const EvenSpacing<Dim> even{field, boundary, spacing, layers};
  const Boundary<Dim> plain = plain_walls(boundary);
  const int finest = static_cast<int>(std::lround(-std::log2(field.finest())));
  std::vector<RowsOfSpacing<Dim>> rows;  // by level
  for (int level = 0; level <= finest; ++level) rows.emplace_back(boundary, plain, spacing / (1 << level), layers);
  std::vector<std::uint8_t> is_own(boundary.walls.size(), 0);
  const auto is_in_front = [&](int wall, const Vec<Dim>& x) {
    is_own[wall] = 1;
    const NearestWall<Dim> own = nearest_among<Dim>(boundary, is_own, x, spacing);
    is_own[wall] = 0;
    return own.face >= 0 && own.signed_distance > 0.0;
  };
  WallParticles<Dim> divided;
  divided.numbers = particles.numbers * parts_of_row;
  divided.numbers_on_wall = particles.numbers_on_wall * parts_of_row;
  for (std::size_t row = 0; row < particles.size(); ++row) {
    const Vec<Dim>& x = particles.position[row];
    const bool is_on_lattice = on_lattice[particles.wall[row]];
    if (is_on_lattice && levels.at(x) > 0) continue;  // sampled below
    const bool has_sides = boundary.walls[particles.wall[row]].is_plate || particles.is_beyond_end[row] != 0;
    if (!is_on_lattice && !has_sides && even.level_of(x, particles.wall[row]) > 0) continue;  // appended below
    const NearestWall<Dim> wall = boundary.nearest(x, reach_to_wall * spacing);
    const int level = is_on_lattice ? 0 : level_at(field, boundary, wall, x);
    const int per_edge = 1 << level;
    const Mat<Dim> axes = axes_at_wall(boundary, wall);
    const double edge = spacing / per_edge;
    // Where the spacing is the same all around, no water reaches parts behind the layers of this spacing.
    const bool may_leave_out = particles.is_beyond_end[row] == 0 && wall.face >= 0 && even.is_around(x);
    for (int part = 0; part < static_cast<int>(power<Dim>(per_edge)); ++part) {
      Vec<Dim> steps;
      for (int axis = 0, rest = part; axis < Dim; ++axis, rest /= per_edge) {
        steps[axis] = edge * (rest % per_edge - 0.5 * (per_edge - 1));
      }
      const Vec<Dim> place = x + axes * steps;
      if (may_leave_out && boundary.nearest(place, layers * edge).face < 0) continue;
      if (level > 0 && !has_sides && is_in_front(particles.wall[row], place)) continue;  // of a sharp corner
      append_part(divided, particles, row, place, particles.share[row] / power<Dim>(per_edge),
                  particles.number[row] * parts_of_row + part);
      if (level > 0 && !has_sides) rows[level].give_normals(divided);
    }
  }
  const bool are_some_on_lattice = std::ranges::find(on_lattice, true) != on_lattice.end();
  for (int level = 1; level <= finest; ++level) {
    append_rows(even, level, rows[0], rows[level], share, divided);
    if (are_some_on_lattice) append_level(levels, level, WallLayers{spacing, layers, false, share}, divided);
  }
  particles = std::move(divided);
}

TAILWATER_IN_2D_AND_3D(divide_wall_particles);
TAILWATER_IN_2D_AND_3D(make_dummy_particles);
TAILWATER_IN_2D_AND_3D(make_surface_particles);
TAILWATER_IN_2D_AND_3D(make_row_and_dummy_particles);

}  // namespace tailwater
