#include "geometry/sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <variant>

#include "case/named_numbers.h"
#include "geometry/from_spec.h"

namespace tailwater {
namespace {

constexpr double least_wall_distance = 0.25;  // dx, beside slanted walls

/// Number in [-1, 1) that depends only on the arguments (SplitMix64, Steele, Lea & Flood 2014). The standard library's
/// distributions differ between machines.
double random_number(std::uint64_t seed, std::uint64_t particle, int axis) {
  std::uint64_t z = (seed * 0x9e3779b97f4a7c15) ^ (particle * 3 + static_cast<std::uint64_t>(axis));
  for (int round = 0; round < 2; ++round) {
    z += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    z ^= z >> 31;
  }
  return static_cast<double>(z >> 11) * 0x1p-52 - 1.0;
}

enum class Where { outside, on_outline, inside };

/// Where `x` is relative to a polygon whose outline is `tolerance` thick, by the parity of the edges to its right.
Where where_in(const std::vector<Vec<2>>& corners, const Vec<2>& x, double tolerance) {
  bool is_inside = false;
  for (std::size_t i = 0, last = corners.size() - 1; i < corners.size(); last = i++) {
    const Vec<2>& a = corners[last];
    const Vec<2>& b = corners[i];
    if ((x - closest_point(WallFace<2>{{a, b}, Vec<2>::Zero()}, x)).norm() <= tolerance) {
      return Where::on_outline;
    }
    if ((a[1] > x[1]) != (b[1] > x[1]) && x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) {
      is_inside = !is_inside;
    }
  }
  return is_inside ? Where::inside : Where::outside;
}

/// One block's lattice: node (i, j, k) stands at low + (index + offset) dx.
template <int Dim>
struct Lattice {
  Vec<Dim> low, high;
  std::array<int, Dim> count;
  Vec<Dim> offset;
  std::vector<Vec<2>> outline;  ///< corners of a polygon; empty for a box
};

template <int Dim>
Lattice<Dim> make_lattice(const CaseSpec& spec, const FluidTable& block, const std::string& owner) {
  const double dx = spec.particles.spacing;
  Lattice<Dim> lattice;
  if (block.shape == BlockShape::polygon) {
    if constexpr (Dim == 3) {
      throw InputError(fmt::format("{}: shape = \"polygon\" exists in 2D only: in 3D use shape = \"box\"", owner));
    } else {
      for (std::size_t k = 0; k < block.points.size(); ++k) {
        lattice.outline.push_back(to_vec<2>(block.points[k], owner, fmt::format("points[{}]", k)));
      }
      if (lattice.outline.size() < 3) {
        throw InputError(fmt::format("{} has {} points: a polygon needs at least 3", owner, lattice.outline.size()));
      }
      lattice.low = lattice.high = lattice.outline[0];
      for (const Vec<2>& corner : lattice.outline) {
        lattice.low = lattice.low.cwiseMin(corner);
        lattice.high = lattice.high.cwiseMax(corner);
      }
    }
  } else {
    lattice.low = to_vec<Dim>(block.min, owner, "min");
    lattice.high = to_vec<Dim>(block.max, owner, "max");
  }
  for (int axis = 0; axis < Dim; ++axis) {
    const double extent = lattice.high[axis] - lattice.low[axis];
    if (extent <= 0.0) {
      throw InputError(
          fmt::format("{} has no extent in {}: it starts at {} and ends at {}; the end must be greater than the start",
                      owner, "xyz"[axis], lattice.low[axis], lattice.high[axis]));
    }
    const bool is_on_nodes = placement_of(spec.scheme.walls).on_wall && periodic_range(spec.domain, axis).empty();
    const double cells = extent / dx;
    // A polygon needs every lattice point of its bounding box; a box the number that fits best.
    const double whole = lattice.outline.empty() ? std::round(cells) : std::ceil(cells - corner_tolerance);
    lattice.count[axis] = std::max(1, static_cast<int>(whole)) + (is_on_nodes ? 1 : 0);
    lattice.offset[axis] = is_on_nodes ? 0.0 : 0.5;
  }
  return lattice;
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
  const bool is_axis_parallel = face.normal.cwiseAbs().maxCoeff() > 1.0 - 1e-9;
  return block.shape == BlockShape::polygon || !is_axis_parallel;
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
  // In a corner, a move away from one wall may approach the next. At most Dim walls meet, so Dim moves are enough.
  for (int move = 0; move < Dim; ++move) {
    const NearestWall<Dim> wall = boundary.nearest(x, 0.5 * dx);
    const double missing = least_wall_distance * dx - wall.signed_distance;
    if (wall.face < 0 || missing <= 0.0 || !adapts_to_wall(block, boundary.faces[wall.face])) break;
    x += missing * boundary.faces[wall.face].normal;
  }
  return x;
}

/// Chooses the places of a block's lattice that are in the block. In a box these are all, in a polygon those inside and
/// every second one on its outline.
template <int Dim>
class InBlock {
 public:
  InBlock(const Lattice<Dim>& lattice, double dx) : lattice_(lattice), tolerance_(corner_tolerance * dx) {}

  /// Call once for each place, in order.
  bool operator()(const Vec<Dim>& x) {
    if constexpr (Dim == 2) {
      if (!lattice_.outline.empty()) {
        const Where where = where_in(lattice_.outline, x, tolerance_);
        if (where == Where::on_outline) return takes_next_on_outline_ = !takes_next_on_outline_;
        return where == Where::inside;
      }
    }
    return true;
  }

 private:
  const Lattice<Dim>& lattice_;
  double tolerance_;
  bool takes_next_on_outline_ = false;
};

/// Calls visit(x) for every place of the lattice, along x first.
template <int Dim, class Visit>
void for_each_place(const Lattice<Dim>& lattice, double dx, Visit&& visit) {
  std::array<int, Dim> node{};
  for (int axis = 0; axis < Dim;) {
    Vec<Dim> x;
    for (int k = 0; k < Dim; ++k) x[k] = lattice.low[k] + (node[k] + lattice.offset[k]) * dx;
    visit(x);
    for (axis = 0; axis < Dim && ++node[axis] == lattice.count[axis]; ++axis) node[axis] = 0;
  }
}

}  // namespace

template <int Dim>
FluidParticles<Dim> make_fluid_particles(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const double dx = spec.particles.spacing;
  const double jitter = spec.particles.jitter * dx;
  FluidParticles<Dim> fluid;
  for (std::size_t b = 0; b < spec.fluid.size(); ++b) {
    const FluidTable& block = spec.fluid[b];
    const std::string owner = fluid_label(spec, b);
    const Lattice<Dim> lattice = make_lattice<Dim>(spec, block, owner);
    StartVelocity<Dim> velocity(spec, block, owner);
    InBlock<Dim> is_in_block(lattice, dx);
    for_each_place<Dim>(lattice, dx, [&](Vec<Dim> x) {
      if (!is_in_block(x) || is_taken_by_wall(spec, boundary, block, x)) return;
      for (int axis = 0; axis < Dim && jitter > 0.0; ++axis) {
        x[axis] += jitter * random_number(spec.particles.seed, fluid.position.size(), axis);
      }
      x = kept_off_walls(boundary, block, x, dx);
      fluid.position.push_back(x);
      fluid.velocity.push_back(velocity.at(x));
      fluid.block.push_back(static_cast<int>(b));
    });
  }
  return fluid;
}

template FluidParticles<2> make_fluid_particles(const CaseSpec&, const Boundary<2>&);
template FluidParticles<3> make_fluid_particles(const CaseSpec&, const Boundary<3>&);

}  // namespace tailwater
