#include "geometry/sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <variant>

#include "base/random.h"
#include "case/named_numbers.h"
#include "geometry/cut_cells.h"
#include "geometry/fill.h"
#include "geometry/from_spec.h"
#include "geometry/mesh_surface.h"
#include "geometry/polygon.h"

namespace tailwater {
namespace {

/// dx; a face as large as a square of this edge (in 2D as long) divides the lattice.
constexpr double least_edge = 3.0;

constexpr double least_wall_distance = 0.25;  // dx, beside slanted walls

/// Between the volume of a mesh and that of the cells inside it, over the latter. Particles with volumes farther from
/// those of their cells would start with a jolt.
constexpr double largest_misfit = 0.2;

template <int Dim>
bool is_axis_parallel(const WallFace<Dim>& face) {
  return face.normal.cwiseAbs().maxCoeff() > 1.0 - 1e-9;
}

/// The places where one block may have particles.
template <int Dim>
struct Places {
  Lattice<Dim> lattice;
  std::array<int, Dim> count;     ///< of places along each axis
  std::array<double, Dim> share;  ///< of the way through its cell at which a place stands
  std::vector<Vec<2>> outline;    ///< corners of a polygon

  Vec<Dim> at(const Cell<Dim>& cell) const {
    Vec<Dim> x;
    for (int axis = 0; axis < Dim; ++axis) x[axis] = lattice[axis].at(static_cast<int>(cell[axis]), share[axis]);
    return x;
  }
  double volume(const Cell<Dim>& cell) const {
    double volume = 1.0;
    for (int axis = 0; axis < Dim; ++axis) volume *= lattice[axis].width(static_cast<int>(cell[axis]));
    return volume;
  }
};

std::vector<Vec<2>> outline_of(const FluidTable& block, const std::string& owner) {
  std::vector<Vec<2>> outline;
  for (std::size_t k = 0; k < block.points.size(); ++k) {
    outline.push_back(to_vec<2>(block.points[k], owner, fmt::format("points[{}]", k)));
  }
  if (outline.size() < 3) {
    throw InputError(fmt::format("{} has {} points: a polygon needs at least 3", owner, outline.size()));
  }
  return outline;
}

/// The box around a box or polygon.
template <int Dim>
Eigen::AlignedBox<double, Dim> box_around(const FluidTable& block, const std::string& owner) {
  Eigen::AlignedBox<double, Dim> box;
  if (block.shape == BlockShape::polygon) {
    if constexpr (Dim == 3) {
      throw InputError(fmt::format(
          "{}: shape = \"polygon\" exists in 2D only: in 3D use shape = \"box\", \"mesh\" or \"fill\"", owner));
    } else {
      for (const Vec<2>& corner : outline_of(block, owner)) box.extend(corner);
    }
  } else {
    box.min() = to_vec<Dim>(block.min, owner, "min");
    box.max() = to_vec<Dim>(block.max, owner, "max");
  }
  for (int axis = 0; axis < Dim; ++axis) {
    if (box.max()[axis] > box.min()[axis]) continue;
    throw InputError(
        fmt::format("{} has no extent in {}: it starts at {} and ends at {}; the end must be greater than the start",
                    owner, "xyz"[axis], box.min()[axis], box.max()[axis]));
  }
  return box;
}

/// Places of the planes of axis-parallel walls across `axis` that reach into the box.
template <int Dim>
std::vector<double> planes_in(const Boundary<Dim>& boundary, const Eigen::AlignedBox<double, Dim>& box, int axis,
                              double least_measure) {
  std::vector<double> planes;
  for (const WallFace<Dim>& face : boundary.faces) {
    if (is_axis_parallel(face) && face.measure() >= least_measure && std::abs(face.normal[axis]) > 0.5 &&
        box.intersects(face.box())) {
      planes.push_back(face.corners[0][axis]);
    }
  }
  std::ranges::sort(planes);
  planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
  return planes;
}

/// The same of the faces of a mesh, which may be small, if together they are large enough.
std::vector<double> planes_in(const TriangleMesh& mesh, int axis, double spacing) {
  const double tolerance = corner_tolerance * spacing;
  std::vector<std::pair<double, double>> flats;  // plane and area
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const Vec<3> normal = mesh.area_normal(t);
    if (std::abs(normal[axis]) < (1.0 - 1e-9) * normal.norm()) continue;
    flats.emplace_back(mesh.corner(t, 0)[axis], 0.5 * normal.norm());
  }
  std::ranges::sort(flats);
  std::vector<double> planes;
  for (std::size_t k = 0; k < flats.size();) {
    double area = 0.0;
    const double plane = flats[k].first;
    for (; k < flats.size() && flats[k].first - plane <= tolerance; ++k) area += flats[k].second;
    if (area >= power<2>(least_edge * spacing)) planes.push_back(plane);
  }
  return planes;
}

template <int Dim>
Places<Dim> make_places(const CaseSpec& spec, std::size_t index, const Boundary<Dim>& boundary) {
  const FluidTable& block = spec.fluid[index];
  Places<Dim> places{.lattice = make_lattice<Dim>(spec, index, boundary), .count = {}, .share = {}, .outline = {}};
  if (block.shape == BlockShape::polygon) {
    if constexpr (Dim == 2) places.outline = outline_of(block, fluid_label(spec, index));
  }
  for (int axis = 0; axis < Dim; ++axis) {
    const bool is_on_nodes = placement_of(spec.scheme.walls).on_wall && periodic_range(spec.domain, axis).empty();
    places.count[axis] = places.lattice[axis].count() + (is_on_nodes ? 1 : 0);
    places.share[axis] = is_on_nodes ? 0.0 : 0.5;
  }
  return places;
}

/// The starting velocity of one block.
template <int Dim>
class StartVelocity {
 public:
  /// Throws InputError, which names the block's `owner`.
  StartVelocity(const CaseSpec& spec, const FluidTable& block, const std::string& owner) : owner_(owner) {
    if (!block.velocity.empty() && block.velocity.size() != Dim) {
      throw InputError(
          fmt::format("{}: velocity has {} components but the case has {} dimensions: give one per dimension", owner,
                      block.velocity.size(), Dim));
    }
    for (std::size_t axis = 0; axis < block.velocity.size(); ++axis) {
      if (const auto* number = std::get_if<double>(&block.velocity[axis])) {
        constant_[axis] = *number;
      } else {
        const std::string& text = std::get<std::string>(block.velocity[axis]);
        varying_.push_back(
            {static_cast<int>(axis), text, Formula(text, named_numbers(spec), std::span(position_names).first(Dim))});
      }
    }
  }

  Vec<Dim> at(const Vec<Dim>& x) {
    Vec<Dim> velocity = constant_;
    for (Component& component : varying_) {
      velocity[component.axis] = component.formula.at({x.data(), Dim});
      if (!(std::abs(velocity[component.axis]) <= largest_number)) {  // also when it is not a number
        throw InputError(
            fmt::format("{}: velocity[{}] = \"{}\" is {} at {}: give an expression that is a number of at most {:g} "
                        "wherever the block has particles",
                        owner_, component.axis, component.text, velocity[component.axis], place(x), largest_number));
      }
    }
    return velocity;
  }

 private:
  struct Component {
    int axis;
    std::string text;
    Formula formula;
  };

  std::string owner_;
  Vec<Dim> constant_ = Vec<Dim>::Zero();
  std::vector<Component> varying_;
};

/// Whether the lattice of `block` is fitted to this face. Elsewhere a misfit is the case file's, and check_geometry
/// reports it.
template <int Dim>
bool adapts_to_wall(const FluidTable& block, const WallFace<Dim>& face) {
  return block.shape != BlockShape::box || !is_axis_parallel(face);
}

/// Whether no fluid particle takes the lattice place `x`, because a wall particle stands there or because it is behind
/// the wall.
template <int Dim>
bool is_taken_by_wall(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidTable& block, const Vec<Dim>& x) {
  const double dx = spec.particles.spacing;
  const NearestWall<Dim> wall = boundary.nearest(x, 0.5 * dx);
  if (wall.face < 0) return false;
  if (placement_of(spec.scheme.walls).on_wall) {
    return std::abs(wall.signed_distance) < (0.5 - corner_tolerance) * dx;
  }
  return wall.signed_distance < -corner_tolerance * dx && adapts_to_wall(block, boundary.faces[wall.face]);
}

/// `x`, or, if it is too near to a wall, the place at least_wall_distance from that wall.
template <int Dim>
Vec<Dim> kept_off_walls(const Boundary<Dim>& boundary, const FluidTable& block, Vec<Dim> x, double dx) {
  if constexpr (Dim == 3) {
    // What is behind a mesh may be nearer to another wall, in front of it.
    for (const WallMesh& mesh : boundary.meshes) {
      const Vec<3> way = boundary.way_of(mesh);
      const SurfacePlace place = mesh.surface->nearest(x - way, 0.5 * dx);
      if (place.triangle < 0 || place.is_on_rim || place.signed_distance >= 0.0) continue;
      x += (least_wall_distance * dx - place.signed_distance) * boundary.faces[mesh.first_face + place.triangle].normal;
    }
  }
  // In a corner, a move away from one wall may approach the next. At most Dim walls meet, so Dim moves are enough.
  for (int move = 0; move < Dim; ++move) {
    const NearestWall<Dim> wall = boundary.nearest(x, 0.5 * dx);
    const double missing = least_wall_distance * dx - wall.signed_distance;
    if (wall.face < 0 || missing <= 0.0 || !adapts_to_wall(block, boundary.faces[wall.face])) break;
    const WallFace<Dim>& face = boundary.faces[wall.face];
    // From the edge of a mesh straight away: the normal of one of its faces leads along the other.
    const bool is_at_edge = boundary.mesh_of(wall.face) != nullptr && wall.signed_distance > corner_tolerance * dx &&
                            face.height(x) < wall.signed_distance - corner_tolerance * dx;
    x += missing * (is_at_edge ? Vec<Dim>((x - wall.point) / wall.signed_distance) : face.normal);
  }
  return x;
}

/// Chooses the places of a block's lattice that are in the block. In a box these are all, in a polygon those inside and
/// every second one on its outline.
template <int Dim>
class InBlock {
 public:
  InBlock(const std::vector<Vec<2>>& outline, double dx) : outline_(outline), tolerance_(corner_tolerance * dx) {}

  /// Call once for each place, in order.
  bool operator()(const Vec<Dim>& x) {
    if constexpr (Dim == 2) {
      if (!outline_.empty()) {
        const Where where = where_in(outline_, x, tolerance_);
        if (where == Where::on_outline) return takes_next_on_outline_ = !takes_next_on_outline_;
        return where == Where::inside;
      }
    }
    return true;
  }

 private:
  const std::vector<Vec<2>>& outline_;  ///< empty for a box
  double tolerance_;
  bool takes_next_on_outline_ = false;
};

/// Bodies that stand in the water.
template <int Dim>
class Bodies {
 public:
  Bodies(const CaseSpec& spec, const Boundary<Dim>& boundary)
      : boundary_(boundary), tolerance_(corner_tolerance * spec.particles.spacing) {
    for (std::size_t w = 0; w < spec.walls.size(); ++w) {
      const WallTable& wall = spec.walls[w];
      if (wall.fluid_side != FluidSide::outside) continue;
      const std::string owner = wall_label(boundary, static_cast<int>(w));
      if (wall.shape == WallShape::box) {
        boxes_.emplace_back(to_vec<Dim>(wall.min, owner, "min"), to_vec<Dim>(wall.max, owner, "max"));
      } else if constexpr (Dim == 2) {
        std::vector<Vec<2>>& outline = outlines_.emplace_back();
        for (const Coordinates& point : wall.points) outline.push_back(to_vec<2>(point, owner, "points"));
      }
    }
    for (const WallMesh& mesh : boundary.meshes) {
      if (spec.walls[mesh.wall].fluid_side == FluidSide::outside) meshes_.push_back(&mesh);
    }
  }

  /// Whether `x` is inside one of them, and not on its surface.
  bool hold(const Vec<Dim>& x) const {
    const Vec<Dim> margin = Vec<Dim>::Constant(tolerance_);
    for (const Eigen::AlignedBox<double, Dim>& box : boxes_) {
      if (((x - margin).array() > box.min().array()).all() && ((x + margin).array() < box.max().array()).all()) {
        return true;
      }
    }
    if constexpr (Dim == 2) {
      for (const std::vector<Vec<2>>& outline : outlines_) {
        if (where_in(outline, x, tolerance_) == Where::inside) return true;
      }
    }
    return std::ranges::any_of(meshes_, [&](const WallMesh* mesh) {
      return boundary_.height_above(*mesh, x, std::numeric_limits<double>::infinity()) < -tolerance_;
    });
  }

 private:
  const Boundary<Dim>& boundary_;
  double tolerance_;  ///< m
  std::vector<Eigen::AlignedBox<double, Dim>> boxes_;
  std::vector<std::vector<Vec<2>>> outlines_;
  std::vector<const WallMesh*> meshes_;
};

/// Whether places are inside a closed mesh or on it. Asked along a line it looks at the mesh seldom: what is nearer to
/// the last place than the surface was is on the same side.
class InMesh {
 public:
  InMesh(const MeshSurface& surface, double tolerance) : surface_(surface), tolerance_(tolerance) {}

  bool holds(const Vec<3>& x) {
    if (const double way = (x - last_).norm(); !(way < std::abs(height_) - tolerance_)) {
      last_ = x;
      height_ = surface_.nearest(x, std::numeric_limits<double>::infinity()).signed_distance;
    }
    return height_ <= tolerance_;
  }

 private:
  const MeshSurface& surface_;
  double tolerance_;  ///< m
  Vec<3> last_ = Vec<3>::Zero();
  double height_ = 0.0;  ///< m; of the last place above the surface
};

/// Calls visit(cell) for every cell with a place, along x first.
template <int Dim, class Visit>
void for_each_cell(const std::array<int, Dim>& count, Visit&& visit) {
  Cell<Dim> cell{};
  for (int axis = 0; axis < Dim;) {
    visit(cell);
    for (axis = 0; axis < Dim && ++cell[axis] == count[axis]; ++axis) cell[axis] = 0;
  }
}

/// The cells whose places are inside a mesh.
std::vector<Cell<3>> cells_inside(const MeshSurface& surface, const Places<3>& places, double dx) {
  InMesh mesh(surface, corner_tolerance * dx);
  std::vector<Cell<3>> cells;
  for_each_cell<3>(places.count, [&](const Cell<3>& cell) {
    if (mesh.holds(places.at(cell))) cells.push_back(cell);
  });
  return cells;
}

/// The volume of a mesh over that of the cells whose centres are inside it. Throws InputError if they differ too much.
double volume_per_cell(const CaseSpec& spec, const FluidTable& block, const std::string& owner,
                       const MeshSurface& surface, const Places<3>& places, const std::vector<Cell<3>>& cells) {
  const double volume = six_volumes(surface.mesh(), [](int) { return true; }) / 6.0;
  double of_cells = 0.0;
  for (const Cell<3>& cell : cells) of_cells += places.volume(cell);
  const bool is_thin = (surface.high() - surface.low()).minCoeff() < (1.0 - corner_tolerance) * spec.particles.spacing;
  if (is_thin || std::abs(volume - of_cells) > largest_misfit * of_cells) {
    throw InputError(fmt::format(
        "{}: file {}: from {} to {} it encloses {:.4g} m^3, and the particles of spacing {:.6g} m that fit into it "
        "have {:.4g} m^3: it is too small or too thin for them; use a smaller spacing, or correct scale = {:g}",
        owner, block.file, place<3>(surface.low()), place<3>(surface.high()), volume, spec.particles.spacing, of_cells,
        block.scale));
  }
  return volume / of_cells;
}

}  // namespace

template <int Dim>
Lattice<Dim> make_lattice(const CaseSpec& spec, std::size_t block, const Boundary<Dim>& boundary) {
  const FluidTable& water = spec.fluid[block];
  const std::string owner = fluid_label(spec, block);
  const double dx = spec.particles.spacing;
  std::array<LatticeAxis, Dim> lattice;
  Eigen::AlignedBox<double, Dim> box;
  if (water.shape == BlockShape::fill) {
    for (const WallFace<Dim>& face : boundary.faces) box.extend(face.box());
    box.extend(to_vec<Dim>(water.seed, owner, "seed"));
    box.max()[Dim - 1] = water.level;
  } else if (Dim == 3 && water.shape == BlockShape::mesh) {
    if constexpr (Dim == 3) box = {boundary.water[block]->low(), boundary.water[block]->high()};
  } else {
    box = box_around<Dim>(water, owner);
  }
  // Walls that only touch the water's sides do not divide it.
  const Vec<Dim> margin = Vec<Dim>::Constant(0.25 * dx);
  const Eigen::AlignedBox<double, Dim> inside(Vec<Dim>(box.min() + margin), Vec<Dim>(box.max() - margin));
  for (int axis = 0; axis < Dim; ++axis) {
    const double low = box.min()[axis];
    const double high = box.max()[axis];
    std::vector<double> planes{low, high};
    if (water.shape == BlockShape::polygon) {
      // Every place of the box around it, at distances of exactly dx.
      planes = {low, low + dx * std::max(1.0, std::ceil((high - low) / dx - corner_tolerance))};
    } else if (const std::vector<double>& range = periodic_range(spec.domain, axis);
               water.shape == BlockShape::fill && range.size() == 2) {
      planes = range;
    } else {
      const std::vector<double> walls = planes_in(boundary, inside, axis, std::pow(least_edge * dx, Dim - 1));
      planes.insert(planes.end(), walls.begin(), walls.end());
      if constexpr (Dim == 3) {
        const auto divide_at = [&](const MeshSurface& mesh) {
          if (!inside.intersects(Eigen::AlignedBox<double, 3>(mesh.low(), mesh.high()))) return;
          for (const double plane : planes_in(mesh.mesh(), axis, dx)) {
            if (plane > inside.min()[axis] && plane < inside.max()[axis]) planes.push_back(plane);
          }
        };
        if (boundary.water[block]) divide_at(*boundary.water[block]);
        for (const WallPlate& plate : boundary.plates) {
          if (plate.sheet) divide_at(*plate.sheet);
        }
      }
    }
    lattice[axis] = LatticeAxis(planes, dx);
  }
  return lattice;
}

template <int Dim>
FluidParticles<Dim> make_fluid_particles(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const double dx = spec.particles.spacing;
  const double jitter = spec.particles.jitter * dx;
  const Bodies<Dim> bodies(spec, boundary);
  FluidParticles<Dim> fluid;
  for (std::size_t b = 0; b < spec.fluid.size(); ++b) {
    const FluidTable& block = spec.fluid[b];
    const std::string owner = fluid_label(spec, b);
    const Places<Dim> places = make_places<Dim>(spec, b, boundary);
    StartVelocity<Dim> velocity(spec, block, owner);
    InBlock<Dim> is_in_block(places.outline, dx);
    double share = 1.0;      // of its cell's volume that a particle has
    bool is_fitted = false;  // whether walls have had their places already
    const auto put = [&](const Cell<Dim>& cell) {
      Vec<Dim> x = places.at(cell);
      if (!is_fitted && (!is_in_block(x) || is_taken_by_wall(spec, boundary, block, x) || bodies.hold(x))) return;
      for (int axis = 0; axis < Dim && jitter > 0.0; ++axis) {
        x[axis] += jitter * random_number(spec.particles.seed, fluid.position.size(), axis);
      }
      x = kept_off_walls(boundary, block, x, dx);
      fluid.position.push_back(x);
      fluid.velocity.push_back(velocity.at(x));
      fluid.volume.push_back(share * places.volume(cell));
      fluid.block.push_back(static_cast<int>(b));
    };
    if (block.shape == BlockShape::fill) {
      std::vector<Cell<Dim>> cells = filled_cells<Dim>(spec, block, owner, boundary, places.lattice);
      if (!placement_of(spec.scheme.walls).on_wall) {
        share = fit_to_volume<Dim>(spec, boundary, places.lattice, cells);
        is_fitted = true;
      }
      for (const Cell<Dim>& cell : cells) put(cell);
    } else if (Dim == 3 && block.shape == BlockShape::mesh) {
      if constexpr (Dim == 3) {
        const MeshSurface& surface = *boundary.water[b];
        const std::vector<Cell<3>> cells = cells_inside(surface, places, dx);
        // Particles that stand on the edge of a block have whole volumes.
        if (!placement_of(spec.scheme.walls).on_wall) {
          share = volume_per_cell(spec, block, owner, surface, places, cells);
        }
        for (const Cell<3>& cell : cells) put(cell);
      }
    } else {
      for_each_cell<Dim>(places.count, put);
    }
  }
  return fluid;
}

template Lattice<2> make_lattice<2>(const CaseSpec&, std::size_t, const Boundary<2>&);
template Lattice<3> make_lattice<3>(const CaseSpec&, std::size_t, const Boundary<3>&);
template FluidParticles<2> make_fluid_particles(const CaseSpec&, const Boundary<2>&);
template FluidParticles<3> make_fluid_particles(const CaseSpec&, const Boundary<3>&);

}  // namespace tailwater
