#include <algorithm>
#include <cmath>
#include <limits>

#include "case/formulation.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "parallel/at_start.h"

namespace tailwater {
namespace {

constexpr double rim_tolerance = 0.1;    // dx, between an opening's rim and the walls
constexpr double wall_clearance = 0.25;  // dx, between walls and the path of the water
constexpr double least_flush = 0.9;      // cosine of the slope of a wall that leads to a hole in the floor
constexpr double least_downward = 0.9;   // cosine between gravity and the way out through a floor

/// Points `first`, ..., `last` with at most `step` (m) between them; at most 200.
template <int Dim>
std::vector<Vec<Dim>> points_along(const Vec<Dim>& first, const Vec<Dim>& last, double step) {
  const int pieces = static_cast<int>(std::clamp(std::ceil((last - first).norm() / step), 1.0, 200.0));
  std::vector<Vec<Dim>> points;
  for (int k = 0; k <= pieces; ++k) points.push_back(first + (static_cast<double>(k) / pieces) * (last - first));
  return points;
}

/// Points at most dx apart on the rim of an opening, without its top, which may be open to the air.
template <int Dim>
std::vector<Vec<Dim>> closed_rim(const Opening<Dim>& end, const Vec<Dim>& gravity, double dx) {
  std::vector<Vec<Dim>> rim;
  if constexpr (Dim == 2) {
    rim = {end.corner, end.corner + end.edges[0]};
  } else {
    for (int k = 0; k < 2; ++k) {
      for (const Vec<3>& start : {end.corner, Vec<3>(end.corner + end.edges[1 - k])}) {
        const std::vector<Vec<3>> side = points_along<3>(start, start + end.edges[k], dx);
        rim.insert(rim.end(), side.begin(), side.end());
      }
    }
  }
  const auto depth_of = [&](const Vec<Dim>& x) { return gravity.dot(x); };
  const auto [top, bottom] = std::minmax_element(
      rim.begin(), rim.end(), [&](const Vec<Dim>& a, const Vec<Dim>& b) { return depth_of(a) < depth_of(b); });
  const double open_above = depth_of(*top) + corner_tolerance * dx * gravity.norm();
  if (depth_of(*bottom) > open_above) std::erase_if(rim, [&](const Vec<Dim>& x) { return depth_of(x) <= open_above; });
  return rim;
}

/// Places in an opening and in front of it, up to `depth` (m) inside, dx/2 apart and away from the rim.
template <int Dim>
std::vector<Vec<Dim>> places_before(const Opening<Dim>& end, double depth, double dx) {
  const double step = 0.5 * dx;
  std::vector<Vec<Dim>> places = points_along<Dim>(end.corner, end.corner - depth * end.normal, step);
  for (const Vec<Dim>& edge : end.edges) {
    const double length = edge.norm();
    if (length <= 2.0 * step) return {};
    const Vec<Dim> along = edge / length;
    std::vector<Vec<Dim>> more;
    for (const Vec<Dim>& x : places) {
      const std::vector<Vec<Dim>> row = points_along<Dim>(x + step * along, x + (length - step) * along, step);
      more.insert(more.end(), row.begin(), row.end());
    }
    places = std::move(more);
  }
  return places;
}

template <int Dim>
void check_direction(const CaseSpec& spec, const Opening<Dim>& end, Findings& findings) {
  for (int axis = 0; axis < Dim; ++axis) {
    if (periodic_range(spec.domain, axis).empty() || std::abs(end.normal[axis]) <= corner_tolerance) continue;
    findings.push_back(
        Finding::error({"{} at {} lets water {} in {}, but periodic_{} returns water in that direction", end.label(),
                        place(end.corner), end.kind == OpeningKind::inlet ? "in" : "out", "xyz"[axis], "xyz"[axis]},
                       {"remove the open end or periodic_{}", "xyz"[axis]}));
  }
}

template <int Dim>
void check_rim(const CaseSpec& spec, const Boundary<Dim>& boundary, const Opening<Dim>& end, Findings& findings) {
  const double dx = spec.particles.spacing;
  for (const Vec<Dim>& x : closed_rim(end, gravity_of<Dim>(spec), dx)) {
    const NearestWall<Dim> wall = boundary.nearest(x, std::numeric_limits<double>::infinity());
    if (wall.face < 0) {
      findings.push_back(Finding::error({"{} has its rim at {}, but the case has no wall", end.label(), place(x)},
                                        {"draw a bed that ends there"}));
      return;
    }
    if (std::abs(wall.signed_distance) <= rim_tolerance * dx) continue;
    findings.push_back(
        Finding::error({"{} {} at {}: the nearest point of {} is {}, {:.6g} away", end.label(),
                        wall.signed_distance > 0.0 ? "leaves a gap to the walls" : "reaches behind the walls", place(x),
                        wall_label(boundary, boundary.faces[wall.face].wall), place(wall.point),
                        Amount{std::abs(wall.signed_distance), "m"}},
                       {"put its end on the wall there"}));
    return;
  }
}

template <int Dim>
void check_way_out(const CaseSpec& spec, const Boundary<Dim>& boundary, const Opening<Dim>& end, Findings& findings) {
  const double dx = spec.particles.spacing;
  const double depth = traits_of(spec).support * dx;
  for (const Vec<Dim>& x : places_before(end, depth, dx)) {
    const NearestWall<Dim> wall = boundary.nearest(x, wall_clearance * dx);
    if (wall.face < 0) continue;
    findings.push_back(
        Finding::error({"{} overlaps {} at {}: no wall may stand in it, nor in the last {:.6g} m before it",
                        end.label(), wall_label(boundary, boundary.faces[wall.face].wall), place(wall.point), depth},
                       {"leave that piece of wall out (of a box: open = [...]), or move the open end"}));
    return;
  }
}

/// The end stretch of a hole in the floor stands between walls, or water comes into it from the sides, where it presses
/// on nothing.
template <int Dim>
void check_pit(const CaseSpec& spec, const Boundary<Dim>& boundary, const Opening<Dim>& end, Findings& findings) {
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  if (gravity.norm() == 0.0 || end.normal.dot(gravity) < least_downward * gravity.norm()) return;
  const double dx = spec.particles.spacing;
  const double depth = (traits_of(spec).support + 1.0) * dx;
  for (const Vec<Dim>& x : closed_rim(end, gravity, dx)) {
    const NearestWall<Dim> wall = boundary.nearest(x - depth * end.normal, std::numeric_limits<double>::infinity());
    if (wall.face >= 0 && std::abs(wall.signed_distance) <= least_flush * depth) continue;
    findings.push_back(Finding::error(
        {"{} is a hole in the floor without walls above its edge at {}: water that comes to it from the sides would be "
         "crushed",
         end.label(), place(x)},
        {"draw a pit below the hole, with upright walls {:.3g} m deep or more, and put the {} on its floor", depth,
         end.kind == OpeningKind::inlet ? "inlet" : "outlet"}));
    return;
  }
}

/// Returns whether it is sound.
template <int Dim>
bool check_fluid_beyond(const CaseSpec& spec, const Opening<Dim>& end, const FluidParticles<Dim>& fluid,
                        Findings& findings) {
  struct Particle {
    Vec<Dim> place;
    int block;
  };
  std::vector<Particle> first;  // on each rank
  std::int64_t own = 0;
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    const Vec<Dim>& x = fluid.position[i];
    if (end.beyond(x) <= corner_tolerance * spec.particles.spacing || !end.spans(x)) continue;
    if (own++ == 0) first.push_back({x, fluid.block[i]});
  }
  const std::int64_t beyond = fluid.ranks.sum(own);
  if (beyond == 0) return true;
  first = gather_on_all(fluid.ranks, first);
  findings.push_back(Finding::error({"{} cuts through {}: {} particles lie beyond it at the start, the first at {}",
                                     end.label(), fluid_label(spec, first[0].block), beyond, place(first[0].place)},
                                    {"end the block there, move the open end, or give it the opposite direction"}));
  return false;
}

/// An end of the walls, with all of them on the side where the water should not be.
template <int Dim>
void check_facing(const CaseSpec& spec, const Boundary<Dim>& boundary, const Opening<Dim>& end, Findings& findings) {
  const double dx = spec.particles.spacing;
  const auto has_walls = [&](double distance) {
    std::vector<Vec<Dim>> rim = closed_rim(end, gravity_of<Dim>(spec), dx);
    return std::ranges::any_of(
        rim, [&](const Vec<Dim>& x) { return boundary.nearest(x + distance * end.normal, 0.5 * dx).face >= 0; });
  };
  if (has_walls(-2.0 * dx) || !has_walls(2.0 * dx)) return;
  findings.push_back(
      Finding::error({"{} at {} faces the wrong way: the walls are on the side that is outside by its direction {}",
                      end.label(), place(end.corner), vector_text(end.direction())},
                     {"give the opposite direction"}));
}

}  // namespace

template <int Dim>
Findings check_open_ends(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  Findings findings;
  for (const Opening<Dim>& end : make_open_ends<Dim>(spec)) {
    check_direction(spec, end, findings);
    check_rim(spec, boundary, end, findings);
    check_way_out(spec, boundary, end, findings);
    check_pit(spec, boundary, end, findings);
    if (check_fluid_beyond(spec, end, fluid, findings)) check_facing(spec, boundary, end, findings);
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_open_ends);

}  // namespace tailwater
