#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>

#include "case/rheology.h"
#include "checks/cell_space.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "geometry/wall_label.h"
#include "motion/channel_end.h"

namespace tailwater {
namespace {

/// Inertia carries a slump farther than a balance of forces does: by 10 % at a Reynolds number of 100
/// (docs/theory/rheology.md). This factor allows for 50 %.
constexpr double reach_with_inertia = 1.5;

/// Whether liquids slide along the ground below their yield stress: it has no friction, or that of Coulomb.
template <int Dim>
bool slides(const Boundary<Dim>& boundary, const Vec<Dim>& down) {
  return std::ranges::any_of(boundary.faces, [&](const WallFace<Dim>& face) {
    const WallProperties& wall = boundary.walls[face.wall];
    const bool is_ground = face.normal.dot(down) < -0.5;
    return is_ground && (wall.friction == 0.0 || wall.coulomb_friction > 0.0);
  });
}

/// The least yield stress over the weight of a unit volume [m], of all liquids; 0 if one has no yield stress.
double min_yield_height(const CaseSpec& spec, double gravity) {
  double least = std::numeric_limits<double>::infinity();
  for (const FluidTable& block : spec.fluid) {
    if (block.liquid.empty()) return 0.0;
    const LiquidTable& liquid = spec.liquids[index_of_liquid(spec, block.liquid)];
    least = std::min(least, liquid.yield_stress / (liquid.density * gravity));
  }
  return spec.fluid.empty() ? 0.0 : least;
}

/// Where yielding liquids come to rest on level ground.
template <int Dim>
struct Slump {
  Vec<Dim> start;  ///< m; the middle of the liquid, or a place on the wall on its one side
  double reach;    ///< m; level distance from there

  double distance(const Vec<Dim>& down, const Vec<Dim>& x) const {
    const Vec<Dim> way = x - start;
    return (way - way.dot(down) * down).norm();
  }
};

/// Whether a straight way from a cell leads to a wall, or round a periodic domain.
template <int Dim>
bool is_walled(const CellSpace<Dim>& space, const typename CellSpace<Dim>::Cell& from, int axis, int step) {
  auto c = std::optional(from);
  do {
    if (space.face_beside(*c, axis, step) >= 0) return true;
    c = space.next(*c, axis, step);
  } while (c && *c != from);
  return c.has_value();
}

/// The slump of liquids that all have a yield stress, cannot slide and are not walled in on all sides; else nothing. A
/// wall on one side is a plane of symmetry. A volume V that spreads to all sides reaches (225 V^2/(128 pi^2 a))^(1/5)
/// (Roussel & Coussot 2005), and a cross-section A between two walls (9 A^2/(32 a))^(1/3) (Liu & Mei 1989), where a is
/// the yield stress over the weight of a unit volume. Both assume that the whole heap yields. Of a heap that is long
/// for its height H only the ends move: a front that has come to rest is H^2/(2a) long (Liu & Mei), a third of it
/// beyond the start. Collective.
template <int Dim>
std::optional<Slump<Dim>> find_slump(const CaseSpec& spec, const Boundary<Dim>& boundary, const CellSpace<Dim>& space,
                                     const FluidParticles<Dim>& fluid, const Vec<Dim>& gravity) {
  const double a = min_yield_height(spec, gravity.norm());
  if (a == 0.0 || slides<Dim>(boundary, gravity.normalized())) return std::nullopt;
  const Box<Dim> box = fluid.box();
  Slump<Dim> slump{0.5 * (box.min() + box.max()), 0.0};
  const auto middle = space.cell_of(slump.start);
  double volume = fluid.ranks.sum(std::accumulate(fluid.volume.begin(), fluid.volume.end(), 0.0));
  const double height = std::abs((box.max() - box.min()).dot(gravity)) / gravity.norm() + spec.particles.spacing;
  double longest = 0.0;  // m; from the start to the end of the heap
  int free_axes = 0;
  for (int axis = 0; axis < Dim; ++axis) {
    if (std::abs(gravity[axis]) > 0.5 * gravity.norm()) continue;
    const bool below = is_walled(space, middle, axis, -1);
    const bool above = is_walled(space, middle, axis, 1);
    if (below && above) {
      volume /= box.max()[axis] - box.min()[axis] + spec.particles.spacing;
      continue;
    }
    ++free_axes;
    const double length = box.max()[axis] - box.min()[axis] + spec.particles.spacing;
    longest = std::max(longest, below == above ? 0.5 * length : length);
    if (below == above) continue;
    volume *= 2.0;
    slump.start[axis] = below ? box.min()[axis] : box.max()[axis];
  }
  if (free_axes == 0) return std::nullopt;
  const double squared = volume * volume / a;
  const double at_rest = free_axes == 2 ? std::pow(225.0 / (128.0 * std::numbers::pi * std::numbers::pi) * squared, 0.2)
                                        : std::cbrt(9.0 / 32.0 * squared);
  slump.reach = reach_with_inertia * at_rest;
  const double front = height * height / (2.0 * a);
  if (longest > 2.0 / 3.0 * front) slump.reach = std::max(slump.reach, longest + reach_with_inertia * front / 3.0);
  return slump;
}

/// Whether no cell that water reaches is lower than the lowest of those that it begins in.
template <int Dim>
bool is_level(const CellSpace<Dim>& space, const std::vector<typename CellSpace<Dim>::Cell>& start,
              const Spread<Dim>& reached, const Vec<Dim>& down) {
  const auto lowest = [&](const auto& cells) {
    double depth = -std::numeric_limits<double>::infinity();
    for (const auto& c : cells) depth = std::max(depth, space.centre(c).dot(down));
    return depth;
  };
  return lowest(reached.cells) <= lowest(start) + 0.5 * space.edge();
}

/// Findings where water reaches the back of a wall, one per wall.
template <int Dim>
Findings water_behind(const Boundary<Dim>& boundary, const Spread<Dim>& reached) {
  Findings findings;
  std::set<int> reported;
  for (std::size_t f = 0; f < boundary.faces.size(); ++f) {
    const int wall = boundary.faces[f].wall;
    const std::optional<Vec<Dim>>& place_behind = reached.behind[f];
    if (!place_behind || boundary.walls[wall].is_plate || !reported.insert(wall).second) continue;
    findings.push_back(
        Finding::error("water-reaches-back-of-wall",
                       {"the water can reach the back of {}, at {}, where nothing would hold it",
                        wall_label(boundary, wall), place(*place_behind)},
                       {"draw a wall that has water on both sides with shape = \"plate\", or with two faces"}));
  }
  return findings;
}

/// The wall or open end nearest to a place.
template <int Dim>
CaseLabel nearest_label(const Boundary<Dim>& boundary, const std::vector<Opening<Dim>>& ends, const Vec<Dim>& x) {
  const NearestWall<Dim> wall = boundary.nearest(x, std::numeric_limits<double>::infinity());
  CaseLabel label = wall_label(boundary, boundary.faces[wall.face].wall);
  double nearest = std::abs(wall.signed_distance);
  for (const Opening<Dim>& end : ends) {
    for (const WallFace<Dim>& face : end.as_faces()) {
      const double distance = (closest_point(face, x) - x).norm();
      if (distance >= nearest) continue;
      nearest = distance;
      label = end.label();
    }
  }
  return label;
}

/// Adds the lowest cells inside the ends through which water enters.
template <int Dim>
void add_cells_at_ends(const CaseSpec& spec, const Boundary<Dim>& boundary, const CellSpace<Dim>& space,
                       std::vector<typename CellSpace<Dim>::Cell>& cells) {
  const double step = space.edge();
  for (const ChannelEnd<Dim>& end : make_channel_ends<Dim>(spec)) {
    if (end.largest_depth(spec.time.end) <= 0.0) continue;
    for (double aside = 0.5 * std::min(step, end.width); aside < end.width; aside += step) {
      for (double above = 0.5 * std::min(step, end.height); above < end.height; above += step) {
        const Vec<Dim> place = end.on_mouth(Vec<Dim>(end.low + above * end.rise + aside * end.aside));
        const Vec<Dim> before = place - step * end.mouth.normal;
        const bool is_below_bed = !end.mouth.spans(place) || boundary.nearest(before, step).signed_distance < 0.0;
        if (is_below_bed) continue;
        if (const auto inside = cell_inside(space, end.mouth, place)) cells.push_back(*inside);
        break;
      }
    }
  }
}

}  // namespace

template <int Dim>
Findings check_leaks(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  if (gravity.isZero(0.0) || boundary.faces.empty()) return {};
  const std::vector<Opening<Dim>> ends = make_open_ends<Dim>(spec);
  const CellSpace<Dim> space(spec, faces_with(boundary, ends), fluid.box(), max_cells_of_case);
  // Along a periodic direction water falls for ever: its level counts only across.
  const Vec<Dim> across = space.across_periods(gravity);
  if (across.isZero(0.0)) return {};
  const Vec<Dim> down = across.normalized();
  std::vector<typename CellSpace<Dim>::Cell> wet = cells_of<Dim>(space, fluid);
  add_cells_at_ends(spec, boundary, space, wet);
  const Spread<Dim> reached = spread(space, wet, down);
  if (!reached.way_out) return water_behind(boundary, reached);
  const Vec<Dim>& way_out = *reached.way_out;
  const auto where = place(way_out);
  const CaseLabel beside = nearest_label(boundary, ends, way_out);
  const std::optional<Slump<Dim>> slump =
      ends.empty() ? find_slump(spec, boundary, space, fluid, gravity) : std::nullopt;
  if (!slump) {
    return {Finding::error("water-pours-out", {"the water would pour out of the case at {}, near {}", where, beside},
                           {"close it there, or make it higher"})};
  }
  if (!is_level(space, wet, reached, down)) {
    return {Finding::warning(
        "liquid-may-pour-out",
        {"the liquid would pour out of the case at {}, near {}, unless it stops before", where, beside},
        {"close it there, make it higher, or make the ground longer"})};
  }
  if (slump->distance(down, way_out) >= slump->reach) return water_behind(boundary, reached);
  return {
      Finding::warning("liquid-may-reach-edge",
                       {"the liquid may pour out of the case at {}, near {}: it comes to rest up to {:.3g} m from {}",
                        where, beside, slump->reach, place(slump->start)},
                       {"let the ground reach that far to all sides, or close it there"})};
}

TAILWATER_IN_2D_AND_3D(check_leaks);

}  // namespace tailwater
