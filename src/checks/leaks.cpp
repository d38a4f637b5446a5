#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "checks/cell_space.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "geometry/wall_label.h"
#include "motion/channel_end.h"

namespace tailwater {
namespace {

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
  const CellSpace<Dim> space(spec, faces_with(boundary, ends), fluid.box(), most_cells_of_case);
  std::vector<typename CellSpace<Dim>::Cell> wet = cells_of<Dim>(space, fluid);
  add_cells_at_ends(spec, boundary, space, wet);
  const Spread<Dim> reached = spread(space, wet, Vec<Dim>(gravity.normalized()));
  if (!reached.way_out) return water_behind(boundary, reached);
  return {Finding::error("water-pours-out",
                         {"the water would pour out of the case at {}, near {}", place(*reached.way_out),
                          nearest_label(boundary, ends, *reached.way_out)},
                         {"close it there, or make it higher"})};
}

TAILWATER_IN_2D_AND_3D(check_leaks);

}  // namespace tailwater
