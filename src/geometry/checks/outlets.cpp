#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/outlet.h"

namespace tailwater {
namespace {

constexpr double rim_tolerance = 0.1;    // dx, between an outlet's rim and the walls
constexpr double wall_clearance = 0.25;  // dx, between walls and the path of the water

/// Points `first`, ..., `last` with at most `step` (m) between them; at most 200.
template <int Dim>
std::vector<Vec<Dim>> points_along(const Vec<Dim>& first, const Vec<Dim>& last, double step) {
  const int pieces = std::clamp(static_cast<int>(std::ceil((last - first).norm() / step)), 1, 200);
  std::vector<Vec<Dim>> points;
  for (int k = 0; k <= pieces; ++k) points.push_back(first + (static_cast<double>(k) / pieces) * (last - first));
  return points;
}

/// Points at most dx apart on the rim of an outlet, without its top, which may be open to the air.
template <int Dim>
std::vector<Vec<Dim>> closed_rim(const Outlet<Dim>& outlet, const Vec<Dim>& gravity, double dx) {
  std::vector<Vec<Dim>> rim;
  if constexpr (Dim == 2) {
    rim = {outlet.corner, outlet.corner + outlet.edges[0]};
  } else {
    for (int k = 0; k < 2; ++k) {
      for (const Vec<3>& start : {outlet.corner, Vec<3>(outlet.corner + outlet.edges[1 - k])}) {
        const std::vector<Vec<3>> side = points_along<3>(start, start + outlet.edges[k], dx);
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

/// Places in an outlet and in front of it, up to `depth` (m) upstream, dx/2 apart and away from the rim.
template <int Dim>
std::vector<Vec<Dim>> places_before(const Outlet<Dim>& outlet, double depth, double dx) {
  const double step = 0.5 * dx;
  std::vector<Vec<Dim>> places = points_along<Dim>(outlet.corner, outlet.corner - depth * outlet.normal, step);
  for (const Vec<Dim>& edge : outlet.edges) {
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
void check_direction(const CaseSpec& spec, const Outlet<Dim>& outlet, Findings& findings) {
  for (int axis = 0; axis < Dim; ++axis) {
    if (periodic_range(spec.domain, axis).empty() || std::abs(outlet.normal[axis]) <= corner_tolerance) continue;
    findings.push_back(Finding::error(
        "{} at {} lets water out in {}, but periodic_{} brings water back in that direction: remove the outlet or "
        "periodic_{}",
        outlet.label(), place(outlet.corner), "xyz"[axis], "xyz"[axis], "xyz"[axis]));
  }
}

template <int Dim>
void check_rim(const CaseSpec& spec, const Boundary<Dim>& boundary, const Outlet<Dim>& outlet, Findings& findings) {
  const double dx = spec.particles.spacing;
  for (const Vec<Dim>& x : closed_rim(outlet, gravity_of<Dim>(spec), dx)) {
    const NearestWall<Dim> wall = boundary.nearest(x, std::numeric_limits<double>::infinity());
    if (wall.face < 0) {
      findings.push_back(Finding::error("{} has its rim at {}, but the case has no wall: draw a bed that ends there",
                                        outlet.label(), place(x)));
      return;
    }
    if (std::abs(wall.signed_distance) <= rim_tolerance * dx) continue;
    findings.push_back(Finding::error(
        "{} {} at {}: the nearest point of {} is {}, {:.6g} m away; put the outlet's end on the wall there",
        outlet.label(), wall.signed_distance > 0.0 ? "leaves a gap to the walls" : "reaches behind the walls", place(x),
        wall_label(boundary, boundary.faces[wall.face].wall), place(wall.point), std::abs(wall.signed_distance)));
    return;
  }
}

template <int Dim>
void check_way_out(const CaseSpec& spec, const Boundary<Dim>& boundary, const Outlet<Dim>& outlet, Findings& findings) {
  const double dx = spec.particles.spacing;
  const double depth = spec.scheme.support * dx;
  for (const Vec<Dim>& x : places_before(outlet, depth, dx)) {
    const NearestWall<Dim> wall = boundary.nearest(x, wall_clearance * dx);
    if (wall.face < 0) continue;
    findings.push_back(Finding::error(
        "{} overlaps {} at {}: no wall may stand in it, nor in the last {:.6g} m before it; leave that piece of wall "
        "out (of a box: open = [...]), or move the outlet",
        outlet.label(), wall_label(boundary, boundary.faces[wall.face].wall), place(wall.point), depth));
    return;
  }
}

template <int Dim>
void check_fluid_beyond(const CaseSpec& spec, const Outlet<Dim>& outlet, const FluidParticles<Dim>& fluid,
                        Findings& findings) {
  std::vector<std::size_t> beyond;
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    const Vec<Dim>& x = fluid.position[i];
    if (outlet.beyond(x) > corner_tolerance * spec.particles.spacing && outlet.spans(x)) beyond.push_back(i);
  }
  if (beyond.empty()) return;
  findings.push_back(Finding::error(
      "{} cuts through {}: {} particles lie beyond it at the start, the first at {}; end the block at the outlet, move "
      "the outlet, or give it the opposite direction",
      outlet.label(), fluid_label(spec, fluid.block[beyond[0]]), beyond.size(), place(fluid.position[beyond[0]])));
}

}  // namespace

template <int Dim>
Findings check_outlets(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  Findings findings;
  for (const Outlet<Dim>& outlet : make_outlets<Dim>(spec)) {
    check_direction(spec, outlet, findings);
    check_rim(spec, boundary, outlet, findings);
    check_way_out(spec, boundary, outlet, findings);
    check_fluid_beyond(spec, outlet, fluid, findings);
  }
  return findings;
}

template Findings check_outlets(const CaseSpec&, const Boundary<2>&, const FluidParticles<2>&);
template Findings check_outlets(const CaseSpec&, const Boundary<3>&, const FluidParticles<3>&);

}  // namespace tailwater
