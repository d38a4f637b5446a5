#include "sampling/fluid_particles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <unordered_set>
#include <utility>

#include "base/box.h"
#include "base/random.h"
#include "case/formulation.h"
#include "geometry/from_spec.h"
#include "geometry/mesh_surface.h"
#include "geometry/polygon.h"
#include "sampling/cut_cells.h"
#include "sampling/start_velocity.h"
#include "sampling/wall_particles.h"
#include "sampling/water_lattice.h"
#include "sampling/water_shape.h"

namespace tailwater {
namespace {

constexpr double min_wall_distance = 0.25;  // dx, beside slanted walls

/// Largest fraction of a mesh's volume that may be in cells without particles. At a surface, half of the cut cells are
/// left out, with a quarter of their volume: for a ball of three spacings in diameter, 0.3 of its volume.
constexpr double largest_misfit = 0.4;

/// Whether no fluid particle may stand at the lattice point `x`, because a wall particle stands there or because the
/// point is behind the wall.
template <int Dim>
bool is_taken_by_wall(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidTable& block, const Vec<Dim>& x) {
  const double dx = spec.particles.spacing;
  const NearestWall<Dim> wall = boundary.nearest(x, 0.5 * dx);
  if (wall.face < 0) return false;
  if (traits_of(spec).walls.on_wall) return std::abs(wall.signed_distance) < (0.5 - corner_tolerance) * dx;
  return wall.signed_distance < -corner_tolerance * dx && adapts_to_wall(spec, block, boundary.faces[wall.face]);
}

/// Number of ids reserved for the parts of a cell.
template <int Dim>
std::int64_t ids_per_cell(const SpacingField<Dim>& field) {
  return std::llround(power<Dim>(1.0 / field.finest()));
}

/// `x`, or, if it is too near a wall, the point at min_wall_distance from that wall. `dx` is the spacing at x.
template <int Dim>
Vec<Dim> kept_off_walls(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidTable& block, double dx,
                        Vec<Dim> x) {
  if constexpr (Dim == 3) {
    // A point behind a mesh may be nearer to another wall, in front of it.
    for (const WallMesh& mesh : boundary.meshes) {
      const Vec<3> moved = boundary.displacement_of(mesh);
      const SurfacePlace place = mesh.surface->nearest(x - moved, 0.5 * dx);
      if (place.triangle < 0 || place.is_on_rim || place.signed_distance >= 0.0) continue;
      x += (min_wall_distance * dx - place.signed_distance) * boundary.faces[mesh.first_face + place.triangle].normal;
    }
  }
  // In a corner, a move away from one wall may approach the next. At most Dim walls meet, so Dim moves are enough.
  for (int move = 0; move < Dim; ++move) {
    const NearestWall<Dim> wall = boundary.nearest(x, 0.5 * dx);
    const double missing = min_wall_distance * dx - wall.signed_distance;
    if (wall.face < 0 || missing <= 0.0 || !adapts_to_wall(spec, block, boundary.faces[wall.face])) break;
    const WallFace<Dim>& face = boundary.faces[wall.face];
    // At an edge, move straight away from it: the normal of one of its faces is parallel to the other face.
    const bool is_at_edge =
        wall.signed_distance > corner_tolerance * dx && face.height(x) < wall.signed_distance - corner_tolerance * dx;
    x += missing * (is_at_edge ? Vec<Dim>((x - wall.point) / wall.signed_distance) : face.normal);
  }
  return x;
}

/// The water of one block: the cells of its lattice that hold particles.
template <int Dim>
class BlockWater {
 public:
  using List = std::vector<std::unique_ptr<BlockWater>>;

  /// Collective.
  BlockWater(const CaseSpec& spec, std::size_t index, const Boundary<Dim>& boundary, const Bodies<Dim>& bodies,
             StartVelocities velocities, const Communicator& ranks, const List& earlier)
      : spec_(spec),
        block_(spec.fluid[index]),
        boundary_(boundary),
        bodies_(bodies),
        earlier_(earlier),
        owner_(fluid_label(spec, index)),
        axes_(make_lattice<Dim>(spec, index, boundary)),
        shape_(spec, index, boundary, axes_),
        velocity_(spec, block_, owner_),
        velocities_(velocities),
        field_(spec, boundary),
        is_divided_(!field_.is_uniform() && velocities != StartVelocities::left_out),
        lattice_{axes_, {}},
        stands_on_walls_(traits_of(spec).walls.on_wall) {
    for (int axis = 0; axis < Dim; ++axis) {
      const bool is_on_nodes = stands_on_walls_ && periodic_range(spec.domain, axis).empty();
      lattice_.count[axis] = axes_[axis].count() + (is_on_nodes ? 1 : 0);
      share_[axis] = is_on_nodes ? 0.0 : 0.5;
    }
    const CellTest<Dim> is_reached = [&](const Cell<Dim>& cell) { return reaches(cell); };
    if (stands_on_walls_) {
      if (block_.shape == BlockShape::polygon) leave_out_half_of_outline();
      fitted_.in_row = count_in_rows<Dim>(lattice_, is_reached, ranks);
      return;
    }
    const auto has_room = [&](const Vec<Dim>& centre, double local) { return leaves_room(centre, local); };
    fitted_ = fit_cells<Dim>(
        {spec, block_, boundary, shape_, lattice_, is_reached, has_room, is_divided_ ? &field_ : nullptr}, ranks);
    if (block_.shape == BlockShape::mesh) require_room(index);
  }

  std::int64_t particles() const {
    return std::llround(std::accumulate(fitted_.in_row.begin(), fitted_.in_row.end(), 0.0));
  }

  /// Calls put(position, velocity, volume, id) for the particles of the cells `from` to `to` - 1 of this block. `first`
  /// is the number of its first cell among the cells of all blocks.
  template <class Put>
  void make(std::int64_t from, std::int64_t to, std::int64_t first, Put&& put) {
    std::int64_t number = 0;
    for (std::int64_t row = 0; row < lattice_.rows() && number < to; ++row) {
      const std::int64_t in_row = std::llround(fitted_.in_row[row]);
      if (number + in_row <= from) {
        number += in_row;
        continue;
      }
      lattice_.visit_row(row, [&](const Cell<Dim>& cell) {
        if (!takes(cell)) return;
        const std::int64_t n = number++;
        if (n >= from && n < to) make_cell(cell, first + n, put);
      });
    }
  }

 private:
  /// Puts the particles of a cell with this number, which is the id of the first of them.
  template <class Put>
  void make_cell(const Cell<Dim>& cell, std::int64_t number, const Put& put) {
    Vec<Dim> edges;
    for (int axis = 0; axis < Dim; ++axis) edges[axis] = axes_[axis].width(static_cast<int>(cell[axis]));
    const auto put_part = [&](const Vec<Dim>& centre, const Vec<Dim>& part, std::int64_t id) {
      const double relative = is_divided_ ? field_.at(centre) : 1.0;
      const Vec<Dim> x = place_of(centre, spec_.particles.spacing * relative, id);
      double volume = fitted_.share;
      for (int axis = 0; axis < Dim; ++axis) volume *= part[axis];
      put(x, velocities_ == StartVelocities::found ? velocity_.at(x) : Vec<Dim>(Vec<Dim>::Zero()), volume, id);
    };
    if (!is_divided_) {
      put_part(at(cell), edges, number);
      return;
    }
    const std::span<const Cut> cut = cuts_of(cell);
    std::size_t part = 0;
    std::int64_t made = 0;
    divide_cell<Dim>(field_, spec_.particles.spacing, at(cell), edges,
                     [&](const Vec<Dim>& centre, const Vec<Dim>& edges_of_part) {
                       if (!cut.empty() && !cut[part++].is_taken) return;
                       const std::int64_t id_of_part = first_id_of_parts + number * ids_per_cell(field_) + made;
                       put_part(centre, edges_of_part, made++ == 0 ? number : id_of_part);
                     });
  }

  using Cut = typename FittedCells<Dim>::Cut;

  /// The parts of a cell that is cut; none of others.
  std::span<const Cut> cuts_of(const Cell<Dim>& cell) const {
    const auto range = std::ranges::equal_range(fitted_.cut, cell, is_before<Dim>, &Cut::cell);
    return {range.begin(), range.end()};
  }

  /// Position of the particle of a cell with this centre and spacing.
  Vec<Dim> place_of(const Vec<Dim>& centre, double spacing, std::int64_t id) const {
    const double jitter = spec_.particles.jitter * spacing;
    Vec<Dim> x = centre;
    for (int axis = 0; axis < Dim && jitter > 0.0; ++axis) {
      x[axis] += jitter * random_number(spec_.particles.seed, static_cast<std::uint64_t>(id), axis);
    }
    // Jitter must not carry a particle across a wall without thickness.
    if (is_hidden<Dim>(boundary_.screens, boundary_.screens_near(x, (x - centre).norm()), centre, x)) x = centre;
    return kept_off_walls(spec_, boundary_, block_, spacing, x);
  }

  Vec<Dim> at(const Cell<Dim>& cell) const {
    Vec<Dim> x;
    for (int axis = 0; axis < Dim; ++axis) x[axis] = axes_[axis].at(static_cast<int>(cell[axis]), share_[axis]);
    return x;
  }

  /// Whether a particle of this block is nearer to a place than half a spacing, on the same side of plates.
  bool has_particle_at(const Vec<Dim>& x) {
    Cell<Dim> middle;
    for (int axis = 0; axis < Dim; ++axis) middle[axis] = axes_[axis].cell_at(x[axis]);
    bool found = false;
    for_each_around<Dim>(middle, [&](const Cell<Dim>& cell) {
      const bool is_near = (at(cell) - x).norm() < 0.5 * (1.0 - corner_tolerance) * spec_.particles.spacing;
      found =
          found || (is_near && lattice_.has(cell) && takes(cell) &&
                    !is_hidden<Dim>(boundary_.screens, boundary_.screens_near(x, (at(cell) - x).norm()), x, at(cell)));
    });
    return found;
  }

  /// Whether the point of a cell is in the water.
  bool reaches(const Cell<Dim>& cell) {
    const Vec<Dim> x = at(cell);
    // The fill algorithm has already stopped the water at walls.
    if (block_.shape == BlockShape::fill && !stands_on_walls_) return shape_.holds(cell, x);
    return shape_.holds(cell, x) && !left_out_.contains(cell_key<Dim>(cell)) &&
           !is_taken_by_wall(spec_, boundary_, block_, x) && !bodies_.hold(x);
  }

  /// Whether the particle of a cut cell with this centre fits in front of all walls at the spacing dx [m], and beside
  /// the blocks before this one.
  bool leaves_room(const Vec<Dim>& centre, double dx) const {
    const auto is_taken_by = [&](const auto& block) { return block->has_particle_at(centre); };
    if (std::ranges::any_of(earlier_, is_taken_by)) return false;
    const NearestWall<Dim> wall = boundary_.nearest(kept_off_walls(spec_, boundary_, block_, dx, centre), dx);
    return wall.face == -1 || wall.signed_distance > (min_wall_distance - corner_tolerance) * dx;
  }

  bool takes(const Cell<Dim>& cell) {
    const std::span<const Cut> cut = cuts_of(cell);
    return cut.empty() ? reaches(cell) : std::ranges::any_of(cut, &Cut::is_taken);
  }

  /// Leaves out every second point on the outline of a polygon, in order, because half of their cells is inside.
  void leave_out_half_of_outline() {
    if constexpr (Dim == 2) {
      const Polygon outline(outline_of(block_, owner_), corner_tolerance * spec_.particles.spacing);
      bool takes_next = false;
      for (std::int64_t row = 0; row < lattice_.rows(); ++row) {
        lattice_.visit_row(row, [&](const Cell<2>& cell) {
          if (outline.where(at(cell)) != Where::on_outline) return;
          takes_next = !takes_next;
          if (!takes_next) left_out_.insert(cell_key<2>(cell));
        });
      }
    }
  }

  /// Throws CaseError if a mesh is too thin for the spacing.
  void require_room(std::size_t index) const {
    if constexpr (Dim == 3) {
      const MeshSurface& surface = *boundary_.water[index];
      const double dx = spec_.particles.spacing;
      const bool is_thin = (surface.high() - surface.low()).minCoeff() < (1.0 - corner_tolerance) * dx;
      if (!is_thin && fitted_.missed <= largest_misfit) return;
      throw CaseError(
          "block-mesh-too-thin",
          {"{}: file {}: from {} to {} it encloses {:.4g} m^3, and the particles of spacing {:.6g} m that fit "
           "into it leave out {:.0f} of that: it is too small or too thin for them",
           owner_, block_.file, place<3>(surface.low()), place<3>(surface.high()), shape_.volume(), dx,
           Amount{100.0 * fitted_.missed, "%"}},
          {"use a smaller spacing, or correct scale = {:g}", block_.scale});
    }
  }

  const CaseSpec& spec_;
  const FluidTable& block_;
  const Boundary<Dim>& boundary_;
  const Bodies<Dim>& bodies_;
  const List& earlier_;  ///< the blocks before it
  CaseLabel owner_;
  Lattice<Dim> axes_;
  WaterShape<Dim> shape_;
  StartVelocity<Dim> velocity_;
  StartVelocities velocities_;
  SpacingField<Dim> field_;
  bool is_divided_;
  LatticeBlock<Dim> lattice_;
  bool stands_on_walls_;
  std::array<double, Dim> share_{};  ///< position of a point within its cell, as a fraction of the edge
  FittedCells<Dim> fitted_;
  std::unordered_set<std::uint64_t> left_out_;  ///< points on the outline of a polygon
};

}  // namespace

template <int Dim>
Box<Dim> FluidParticles<Dim>::box() const {
  // Least coordinates, and negated largest ones, for one reduction.
  std::array<double, 2 * Dim> least;
  least.fill(std::numeric_limits<double>::max());
  for (const Vec<Dim>& x : position) {
    for (int axis = 0; axis < Dim; ++axis) {
      least[axis] = std::min(least[axis], x[axis]);
      least[Dim + axis] = std::min(least[Dim + axis], -x[axis]);
    }
  }
  ranks.min_of_each(least);
  Box<Dim> box;
  if (all == 0) return box;
  for (int axis = 0; axis < Dim; ++axis) {
    box.min()[axis] = least[axis];
    box.max()[axis] = -least[Dim + axis];
  }
  return box;
}

template <int Dim>
double FluidParticles<Dim>::extent_along(const Vec<Dim>& direction) const {
  std::array least{std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
  for (const Vec<Dim>& x : position) {
    const double height = direction.dot(x);
    least[0] = std::min(least[0], height);
    least[1] = std::min(least[1], -height);
  }
  ranks.min_of_each(least);
  return all == 0 ? 0.0 : -least[1] - least[0];
}

template <int Dim>
FluidParticles<Dim> make_fluid_particles(const CaseSpec& spec, const Boundary<Dim>& boundary, const Communicator& ranks,
                                         std::int64_t others, StartVelocities velocities) {
  const Bodies<Dim> bodies(spec, boundary);
  typename BlockWater<Dim>::List blocks;
  FluidParticles<Dim> fluid;
  fluid.ranks = ranks;
  for (std::size_t b = 0; b < spec.fluid.size(); ++b) {
    blocks.push_back(std::make_unique<BlockWater<Dim>>(spec, b, boundary, bodies, velocities, ranks, blocks));
    fluid.of_blocks.push_back(blocks.back()->particles());
    fluid.all += fluid.of_blocks.back();
  }
  const auto begin_of = [&](int rank) { return std::min((fluid.all + others) * rank / ranks.size(), fluid.all); };
  fluid.first = begin_of(ranks.rank());
  const std::int64_t end = begin_of(ranks.rank() + 1);
  fluid.position.reserve(end - fluid.first);
  fluid.velocity.reserve(end - fluid.first);
  fluid.volume.reserve(end - fluid.first);
  fluid.block.reserve(end - fluid.first);
  std::int64_t first = 0;  // number of the block's first cell
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const auto put = [&](const Vec<Dim>& x, const Vec<Dim>& velocity, double volume, std::int64_t id) {
      if (!spec.refinement.empty() && velocities == StartVelocities::found) fluid.id.push_back(id);
      fluid.position.push_back(x);
      fluid.velocity.push_back(velocity);
      fluid.volume.push_back(volume);
      fluid.block.push_back(static_cast<int>(b));
    };
    blocks[b]->make(fluid.first - first, end - first, first, put);
    first += blocks[b]->particles();
  }
  return fluid;
}

template <int Dim>
std::int64_t first_id_after_start(const SpacingField<Dim>& field, std::int64_t cells) {
  return first_id_of_parts + cells * ids_per_cell(field);
}

TAILWATER_IN_2D_AND_3D(first_id_after_start);
template struct FluidParticles<2>;
template struct FluidParticles<3>;
TAILWATER_IN_2D_AND_3D(make_fluid_particles);

}  // namespace tailwater
