#include <algorithm>
#include <cmath>
#include <limits>

#include "base/box.h"
#include "checks/checks.h"
#include "geometry/ducts.h"
#include "geometry/from_spec.h"
#include "geometry/images.h"
#include "geometry/wall_label.h"
#include "motion/channel_end.h"
#include "parallel/at_start.h"

namespace tailwater {
namespace {

constexpr double wall_clearance = 0.25;   // dx, between walls and the path of the water
constexpr double max_beside_duct = 0.3;   // cosine between an opening's normal and that of a wall beside its duct
constexpr double min_flush = 0.9;         // cosine between an opening's normal and that of the wall that it is cut into
constexpr double largest_opening = 10.0;  // over the size of all walls and water

/// Points `first`, ..., `last` with at most `step` (m) between them; at most 200.
template <int Dim>
std::vector<Vec<Dim>> points_along(const Vec<Dim>& first, const Vec<Dim>& last, double step) {
  const int pieces = static_cast<int>(std::clamp(std::ceil((last - first).norm() / step), 1.0, 200.0));
  std::vector<Vec<Dim>> points;
  for (int k = 0; k <= pieces; ++k) points.push_back(first + (static_cast<double>(k) / pieces) * (last - first));
  return points;
}

/// Points at most dx apart on the whole rim of an opening.
template <int Dim>
std::vector<Vec<Dim>> whole_rim(const Opening<Dim>& end, double dx) {
  const std::vector<Vec<Dim>> corners = end.rim();
  if constexpr (Dim == 2) return corners;
  std::vector<Vec<Dim>> rim;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::vector<Vec<Dim>> side = points_along<Dim>(corners[k], corners[(k + 1) % corners.size()], dx);
    rim.insert(rim.end(), side.begin(), side.end());
  }
  return rim;
}

/// The rim without its top, which may be open to the air, and without parts in a periodic plane.
template <int Dim>
std::vector<Vec<Dim>> closed_rim(const CaseSpec& spec, const Opening<Dim>& end) {
  const double dx = spec.particles.spacing;
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  std::vector<Vec<Dim>> rim = whole_rim(end, dx);
  const auto depth_of = [&](const Vec<Dim>& x) { return gravity.dot(x); };
  const auto [top, bottom] = std::minmax_element(
      rim.begin(), rim.end(), [&](const Vec<Dim>& a, const Vec<Dim>& b) { return depth_of(a) < depth_of(b); });
  const double open_above = depth_of(*top) + corner_tolerance * dx * gravity.norm();
  if (depth_of(*bottom) > open_above) std::erase_if(rim, [&](const Vec<Dim>& x) { return depth_of(x) <= open_above; });
  const PeriodicDomain<Dim> domain = periodic_domain<Dim>(spec.domain);
  std::erase_if(rim, [&](const Vec<Dim>& x) { return is_in_periodic_plane<Dim>(domain, x, corner_tolerance * dx); });
  return rim;
}

/// m; distance of a place in the plane of an opening from its rim
template <int Dim>
double distance_to_rim(const Opening<Dim>& end, const Vec<Dim>& x) {
  const std::vector<Vec<Dim>> corners = end.rim();
  double distance = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec<Dim>& from = corners[k];
    const Vec<Dim> side = Dim == 2 ? Vec<Dim>(Vec<Dim>::Zero()) : Vec<Dim>(corners[(k + 1) % corners.size()] - from);
    const double squared = side.squaredNorm();
    const double share = squared > 0.0 ? std::clamp(side.dot(x - from) / squared, 0.0, 1.0) : 0.0;
    distance = std::min(distance, (x - from - share * side).norm());
  }
  return distance;
}

/// Places in an opening, dx/2 apart and as far from its rim, and straight beyond it, up to `depth` (m) outside.
template <int Dim>
std::vector<Vec<Dim>> places_beyond(const Opening<Dim>& end, double depth, double dx) {
  const double step = 0.5 * dx;
  std::vector<Vec<Dim>> places{end.corner};
  for (const Vec<Dim>& edge : end.edges) {
    std::vector<Vec<Dim>> more;
    for (const Vec<Dim>& x : places) {
      const std::vector<Vec<Dim>> row = points_along<Dim>(x, x + edge, step);
      more.insert(more.end(), row.begin(), row.end());
    }
    places = std::move(more);
  }
  std::erase_if(places, [&](const Vec<Dim>& x) {
    return !end.spans(x) || distance_to_rim(end, x) < (1.0 - corner_tolerance) * step;
  });
  std::vector<Vec<Dim>> beyond;
  for (const Vec<Dim>& out : points_along<Dim>(Vec<Dim>::Zero(), depth * end.normal, step)) {
    for (const Vec<Dim>& x : places) beyond.push_back(x + out);
  }
  return beyond;
}

/// Checks that the opening is not far larger than the case: it has an array of the places across it. Collective.
template <int Dim>
void check_opening_size(const Boundary<Dim>& boundary, const Opening<Dim>& end, const FluidParticles<Dim>& fluid,
                        Findings& findings) {
  Box<Dim> mouth;
  for (const Vec<Dim>& corner : end.rim()) mouth.extend(corner);
  const Box<Dim> box = box_around(boundary.faces).merged(fluid.box());
  if (box.isEmpty() || mouth.diagonal().norm() <= largest_opening * box.diagonal().norm()) return;
  findings.push_back(Finding::error("opening-too-wide",
                                    {"{} at {} is {:.6g} m wide, more than {:g} times the size of all walls and water",
                                     end.label(), place(end.corner), mouth.diagonal().norm(), largest_opening},
                                    {"end it where the walls of the channel end"}));
}

template <int Dim>
void check_direction(const CaseSpec& spec, const Opening<Dim>& end, Findings& findings) {
  for (int axis = 0; axis < Dim; ++axis) {
    if (periodic_range(spec.domain, axis).empty() || std::abs(end.normal[axis]) <= corner_tolerance) continue;
    findings.push_back(Finding::error(
        "opening-across-period",
        {"{} at {} lets water {} in {}, but with periodic_{} water returns to the other side", end.label(),
         place(end.corner), end.kind == OpeningKind::inlet ? "in" : "out", "xyz"[axis], "xyz"[axis]},
        {"remove the open end or periodic_{}", "xyz"[axis]}));
  }
}

template <int Dim>
void check_rim(const CaseSpec& spec, const Boundary<Dim>& boundary, const Opening<Dim>& end, Findings& findings) {
  const double tolerance = rim_tolerance(end) * spec.particles.spacing;
  for (const Vec<Dim>& x : closed_rim(spec, end)) {
    const NearestWall<Dim> wall = boundary.nearest(x, std::numeric_limits<double>::infinity());
    if (wall.face < 0) {
      findings.push_back(Finding::error("opening-without-wall",
                                        {"{} has its rim at {}, but the case has no wall", end.label(), place(x)},
                                        {"draw a bed that ends there"}));
      return;
    }
    if (std::abs(wall.signed_distance) <= tolerance) continue;
    findings.push_back(
        Finding::error("opening-rim-off-wall",
                       {"{} {} at {}: the nearest point of {} is {}, {:.6g} away", end.label(),
                        wall.signed_distance > 0.0 ? "leaves a gap to the walls" : "reaches behind the walls", place(x),
                        wall_label(boundary, boundary.faces[wall.face].wall), place(wall.point),
                        Amount{std::abs(wall.signed_distance), "m"}},
                       {"move the edge of the opening onto the wall there"}));
    return;
  }
}

/// Checks that no part of the rim is on a moving wall alone: the opening stays where it is drawn.
template <int Dim>
void check_rim_rests(const CaseSpec& spec, const Boundary<Dim>& boundary, const Opening<Dim>& end, Findings& findings) {
  const double tolerance = rim_tolerance(end) * spec.particles.spacing;
  for (const Vec<Dim>& x : whole_rim(end, spec.particles.spacing)) {
    const NearestWall<Dim> wall = boundary.nearest(x, tolerance);
    if (wall.face < 0 || !boundary.walls[boundary.faces[wall.face].wall].moves()) continue;
    const bool rests = std::ranges::any_of(boundary.faces, [&](const WallFace<Dim>& face) {
      return !boundary.walls[face.wall].moves() && (closest_point(face, x) - x).norm() <= tolerance;
    });
    if (rests) continue;
    findings.push_back(
        Finding::error("opening-rim-on-moving-wall",
                       {"{} has its rim at {} on {}, which moves; an opening stays where it is drawn, so that a gap "
                        "opens between them",
                        end.label(), place(x), wall_label(boundary, boundary.faces[wall.face].wall)},
                       {"end the moving wall before the opening, and draw a wall at rest around the opening"}));
    return;
  }
}

/// Checks that no walls or water of the case are in the space of the duct that the program adds, or of a free jet.
template <int Dim>
void check_space_beyond(const CaseSpec& spec, const Boundary<Dim>& boundary, const ChannelEnd<Dim>& channel_end,
                        Findings& findings) {
  const double dx = spec.particles.spacing;
  const Opening<Dim>& end = channel_end.mouth;
  const double depth = end.meets_air ? lead_over_spacing * dx : channel_end.duct;
  for (const Vec<Dim>& x : places_beyond(end, depth, dx)) {
    const NearestWall<Dim> wall = boundary.nearest(x, (0.5 + corner_tolerance) * dx);
    if (wall.face < 0) continue;
    // A wall may be the side of the duct, but not with its back to it, where its particles are.
    const WallFace<Dim>& face = boundary.faces[wall.face];
    const bool is_along =
        std::abs(face.normal.dot(end.normal)) < max_beside_duct && !boundary.walls[face.wall].is_plate;
    const bool turns_its_back = is_along && wall.signed_distance < -wall_clearance * dx;
    if (std::abs(wall.signed_distance) > wall_clearance * dx && !turns_its_back) continue;
    const CaseLabel label = wall_label(boundary, face.wall);
    if (end.beyond(x) <= wall_clearance * dx && !turns_its_back) {
      findings.push_back(Finding::error(
          "wall-in-opening", {"{} overlaps {} at {}: no wall may stand in it", end.label(), label, place(wall.point)},
          {"leave that piece of wall out (of a box: open = [...]), or move the {}", end.label().table}));
    } else {
      findings.push_back(
          Finding::error("wall-beyond-opening",
                         {"{} stands beyond {} at {}: the space up to {:.6g} m outside of it must be free, because the "
                          "program {} there",
                          label, end.label(), place(wall.point), depth,
                          end.meets_air ? "follows the jet" : "adds a duct with the prescribed flow"},
                         {"end the walls at the {}, or move it out to the ends of the walls", end.label().table}));
    }
    return;
  }
}

/// Whether the opening is cut into the wall beside a place on the rim, so that the wall does not lead to it.
template <int Dim>
bool is_cut_into_wall(const Boundary<Dim>& boundary, const Opening<Dim>& end, const Vec<Dim>& on_rim, double dx) {
  Vec<Dim> middle = end.corner;
  for (const Vec<Dim>& edge : end.edges) middle += 0.5 * edge;
  const NearestWall<Dim> wall = boundary.nearest(on_rim + dx * (on_rim - middle).normalized(), 0.5 * dx);
  return wall.face >= 0 && std::abs(boundary.faces[wall.face].normal.dot(end.normal)) >= min_flush;
}

/// Checks that the far side of a hole in a wall is defined: a continuing channel is impossible there.
template <int Dim>
void check_beyond(const CaseSpec& spec, const Boundary<Dim>& boundary, const ChannelEnd<Dim>& end, Findings& findings) {
  const Opening<Dim>& mouth = end.mouth;
  if (mouth.kind == OpeningKind::inlet || end.air() || end.flow.level) return;
  const double dx = spec.particles.spacing;
  const auto is_cut = [&](const Vec<Dim>& x) { return is_cut_into_wall(boundary, mouth, x, dx); };
  if (!std::ranges::all_of(whole_rim(mouth, dx), is_cut)) return;
  findings.push_back(Finding::error(
      "opening-in-wall-undefined",
      {"{} at {} is a hole in a wall, and the case does not define the far side", mouth.label(), place(mouth.corner)},
      {"give beyond = \"air\" for a free jet, or the level of the water there"}));
}

/// Checks that the ducts of two openings do not meet.
template <int Dim>
void check_ducts_apart(const CaseSpec& spec, const std::vector<ChannelEnd<Dim>>& ends, Findings& findings) {
  for (const ChannelEnd<Dim>& end : ends) {
    if (end.air()) continue;
    for (const Vec<Dim>& x : places_beyond(end.mouth, end.duct, spec.particles.spacing)) {
      const auto holds = [&](const ChannelEnd<Dim>& other) {
        return &other != &end && Duct<Dim>{other.mouth, other.duct}.holds(x);
      };
      const auto other = std::ranges::find_if(ends, holds);
      if (other == ends.end()) continue;
      findings.push_back(Finding::error(
          "openings-share-space",
          {"{} and {} share the space at {}, up to {:.6g} m outside of each, where the program adds a duct for each",
           end.mouth.label(), other->mouth.label(), place(x), end.duct},
          {"move them apart"}));
      return;
    }
  }
}

/// Returns whether the opening is sound.
template <int Dim>
bool check_fluid_beyond(const CaseSpec& spec, const ChannelEnd<Dim>& channel_end, const FluidParticles<Dim>& fluid,
                        Findings& findings) {
  struct Particle {
    Vec<Dim> place;
    int block;
  };
  const Opening<Dim>& end = channel_end.mouth;
  const double layers = dummy_layers(spec) * spec.particles.spacing;  // of the walls of the duct
  std::vector<Particle> first;                                        // on each rank
  std::int64_t own = 0;
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    const Vec<Dim>& x = fluid.position[i];
    const bool is_beside_duct = !end.meets_air && end.beyond(x) < channel_end.duct && end.aside(x) < layers;
    if (end.beyond(x) <= corner_tolerance * spec.particles.spacing || !(is_beside_duct || end.spans(x))) continue;
    if (own++ == 0) first.push_back({x, fluid.block[i]});
  }
  const std::int64_t beyond = fluid.ranks.sum(own);
  if (beyond == 0) return true;
  first = gather_on_all(fluid.ranks, first);
  findings.push_back(Finding::error("opening-cuts-water",
                                    {"{} cuts through {}: {} particles lie beyond it at the start, the first at {}",
                                     end.label(), fluid_label(spec, first[0].block), beyond, place(first[0].place)},
                                    {"end the block at the opening, move the opening, or reverse its direction"}));
  return false;
}

/// Reports an end of the walls with all walls on the side where the water should not be.
template <int Dim>
void check_facing(const CaseSpec& spec, const Boundary<Dim>& boundary, const Opening<Dim>& end, Findings& findings) {
  const double dx = spec.particles.spacing;
  const std::vector<Vec<Dim>> rim = closed_rim(spec, end);
  const auto is_cut = [&](const Vec<Dim>& x) { return is_cut_into_wall(boundary, end, x, dx); };
  if (std::ranges::any_of(rim, is_cut)) return;
  const auto has_walls = [&](double distance) {
    return std::ranges::any_of(
        rim, [&](const Vec<Dim>& x) { return boundary.nearest(x + distance * end.normal, 0.5 * dx).face >= 0; });
  };
  if (has_walls(-2.0 * dx) || !has_walls(2.0 * dx)) return;
  findings.push_back(
      Finding::error("opening-faces-inwards",
                     {"{} at {} faces the wrong way: the walls are on the side that is outside by its direction {}",
                      end.label(), place(end.corner), vector_text(end.direction())},
                     {"give the opposite direction"}));
}

}  // namespace

template <int Dim>
Findings check_open_ends(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  Findings findings;
  for (const Opening<Dim>& end : make_open_ends<Dim>(spec)) check_opening_size(boundary, end, fluid, findings);
  if (!findings.empty()) return findings;
  const std::vector<Duct<Dim>> ducts = find_ducts(spec, boundary);
  const std::vector<ChannelEnd<Dim>> ends = make_channel_ends<Dim>(spec, std::span<const Duct<Dim>>(ducts));
  for (const ChannelEnd<Dim>& end : ends) {
    check_direction(spec, end.mouth, findings);
    check_rim(spec, boundary, end.mouth, findings);
    check_rim_rests(spec, boundary, end.mouth, findings);
    check_space_beyond(spec, boundary, end, findings);
    check_beyond(spec, boundary, end, findings);
    if (check_fluid_beyond(spec, end, fluid, findings)) check_facing(spec, boundary, end.mouth, findings);
  }
  if (findings.empty()) check_ducts_apart(spec, ends, findings);
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_open_ends);

}  // namespace tailwater
