#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/box.h"
#include "case/probe_columns.h"
#include "checks/checks.h"
#include "checks/swept_box.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "geometry/some_walls.h"
#include "geometry/wall_label.h"
#include "geometry/wall_patches.h"
#include "motion/wall_motion.h"
#include "refinement/hulls_at_zones.h"

namespace tailwater {
namespace {

/// The box around the water at the start and the walls, wherever they are during the run.
template <int Dim>
Box<Dim> box_of_case(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid) {
  Box<Dim> box = fluid.box().merged(box_around(drawn.faces));
  for (const Opening<Dim>& end : make_open_ends<Dim>(spec)) box.extend(box_around(end.as_faces()));
  for (std::size_t w = 0; w < spec.walls.size(); ++w) {
    if (drawn.walls[w].moves()) box.extend(swept_box(spec, drawn, static_cast<int>(w)));
  }
  return box;
}

/// The space that water may reach: a spacing around the box, and above it as high again, for splashes. Floating bodies
/// may carry water as far on all sides.
template <int Dim>
Box<Dim> reach_of_water(const CaseSpec& spec, Box<Dim> box) {
  const double dx = spec.particles.spacing;
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  const double size = box.diagonal().norm();
  Vec<Dim> below = Vec<Dim>::Constant(dx);
  Vec<Dim> above = below;
  for (int axis = 0; axis < Dim; ++axis) {
    const bool is_open = gravity.isZero(0.0) || !spec.bodies.empty();
    if (is_open || gravity[axis] > 0.0) below[axis] += size;
    if (is_open || gravity[axis] < 0.0) above[axis] += size;
  }
  box.min() -= below;
  box.max() += above;
  return box;
}

template <int Dim>
Box<Dim> box_of_probe(const ProbeTable& probe) {
  const CaseLabel owner = label(probe);
  Box<Dim> box;
  if (probe.type == ProbeType::pressure || probe.type == ProbeType::velocity) {
    box.extend(to_vec<Dim>(probe.at, owner, "at"));
  } else if (probe.type == ProbeType::discharge) {
    box.extend(to_vec<Dim>(probe.from, owner, "from"));
    box.extend(to_vec<Dim>(probe.to, owner, "to"));
  }
  return box;  // other probes search for a wall, and report if there is none
}

/// Whether a probe has a result from many of its readings, such as a mean or a maximum.
bool is_reduced_over_time(const ProbeTable& probe) {
  return std::ranges::any_of(info_of(probe.type).results, [](const DeclaredResult& result) {
    return result.statistic != Statistic::last && result.statistic != Statistic::last_min &&
           result.statistic != Statistic::last_max;
  });
}

/// Adds a warning about an interval that leaves few readings in the run.
void check_interval(const CaseSpec& spec, const ProbeTable& probe, Findings& findings) {
  constexpr double few = 10.0;
  if (probe.interval * few <= spec.time.end * (1.0 + 1e-9) || !is_reduced_over_time(probe)) return;
  const double readings = std::floor(spec.time.end / probe.interval * (1.0 + 1e-9)) + 1.0;
  findings.push_back(
      Finding::warning("probe-takes-few-readings",
                       {"{}: interval = {:.6g} gives {:.0f} {} in the run of {:.6g} s, so its means and maxima are "
                        "unreliable or missing",
                        label(probe), Amount{probe.interval, "s"}, readings,
                        readings > 1.0 ? "readings" : "reading, at the start,", spec.time.end},
                       {"give an interval of at most {:.3g} s, or end the run later", spec.time.end / few}));
}

/// Adds a warning about times that are never reached, and about means over more than the run.
void check_times(const CaseSpec& spec, const ProbeTable& probe, Findings& findings) {
  if (probe.averaging_time > spec.time.end) {
    findings.push_back(Finding::warning("averaging-longer-than-run",
                                        {"{}: averaging_time = {:.6g} is longer than the run of {:.6g} s: its largest "
                                         "pressure is not a mean over that time",
                                         label(probe), Amount{probe.averaging_time, "s"}, spec.time.end},
                                        {"give a shorter one, or end the run later"}));
  }
  const auto is_late = [&](double time) { return time > spec.time.end; };
  const auto late = std::ranges::count_if(probe.times, is_late);
  if (late == 0) return;
  findings.push_back(Finding::warning(
      "probe-times-after-end",
      {"{}: {} of its {} times are after time.end = {:.6g} s, the last at {:.6g}; they give no readings", label(probe),
       late, probe.times.size(), spec.time.end, Amount{*std::ranges::max_element(probe.times), "s"}},
      {"end the run later, or leave them out"}));
}

/// Adds a warning for a probe that reads on a wall farther away than a spacing.
template <int Dim>
void check_is_on_wall(const CaseSpec& spec, const Boundary<Dim>& drawn, const ProbeTable& probe, Findings& findings) {
  if (probe.type != ProbeType::wall_pressure) return;
  const Vec<Dim> at = to_vec<Dim>(probe.at, label(probe), "at");
  const NearestWall<Dim> wall = drawn.nearest(at, std::numeric_limits<double>::infinity());
  const double away = (at - wall.point).norm();
  if (wall.face < 0 || away <= spec.particles.spacing) return;
  findings.push_back(
      Finding::warning("probe-far-from-wall",
                       {"{} at {} reads the pressure on the nearest wall, at {}, {:.4g} away", label(probe), place(at),
                        place(wall.point), Amount{away, "m"}},
                       {"move the probe onto its wall, or use type = \"pressure\" for the pressure in the water"}));
}

template <int Dim>
Box<Dim> zone_box(const DampingTable& zone) {
  const CaseLabel owner("damping", zone.name);
  return {to_vec<Dim>(zone.min, owner, "min"), to_vec<Dim>(zone.max, owner, "max")};
}

/// Adds a warning about the common part of two zones. In the corner of a basin, two zones at rest may share a part.
template <int Dim>
void check_zones_apart(const CaseSpec& spec, const DampingTable& first, const DampingTable& second,
                       Findings& findings) {
  const Box<Dim> common = zone_box<Dim>(first).intersection(zone_box<Dim>(second));
  if (common.isEmpty() || common.sizes().minCoeff() < corner_tolerance * spec.particles.spacing) return;
  const auto has_target = [](const DampingTable& zone) {
    return zone.waves != WaveKind::none || zone.transport != 0.0;
  };
  const auto axis = [](const DampingTable& zone) { return static_cast<int>(zone.towards) / 2; };
  if (axis(first) != axis(second) && !(has_target(first) && has_target(second))) return;
  findings.push_back(
      Finding::warning("damping-zones-overlap",
                       {"{} and {} overlap from {} to {}: their rates add, and the water there follows neither of them",
                        CaseLabel("damping", first.name), CaseLabel("damping", second.name), place<Dim>(common.min()),
                        place<Dim>(common.max())},
                       {"end one zone where the other begins, or remove one of them"}));
}

/// The nearest wall, but for floating bodies, that a hull faces across a gap within the reach of its pairs; -1: there
/// is none.
template <int Dim>
int wall_beside(const CaseSpec& spec, const Boundary<Dim>& drawn, const std::vector<WallPatch<Dim>>& patches,
                int hull) {
  std::vector<std::uint8_t> is_other(drawn.walls.size(), 1);
  is_other[hull] = 0;
  int beside = -1;
  double reach = reach_of_shares * spec.particles.spacing;
  for (const WallPatch<Dim>& patch : patches) {
    if (drawn.faces[patch.face].wall != hull) continue;
    const Vec<Dim> centre = patch.centre(drawn);
    const NearestWall<Dim> nearest = nearest_among<Dim>(drawn, is_other, centre, reach);
    const double gap = std::abs(nearest.signed_distance);
    if (nearest.face < 0 || gap >= reach) continue;
    const double ahead = drawn.faces[patch.face].normal.dot(nearest.point - centre);
    if (ahead < std::max(0.5 * gap, corner_tolerance * spec.particles.spacing)) continue;
    beside = drawn.faces[nearest.face].wall;
    reach = gap;
  }
  return beside;
}

/// Adds a warning for each force probe on a part of the walls with a hull that has another wall and a zone of
/// refinement beside it.
template <int Dim>
void check_hulls_at_zones(const CaseSpec& spec, const Boundary<Dim>& drawn, Findings& findings) {
  const auto is_on_part = [](const ProbeTable& probe) {
    return probe.type == ProbeType::force && !(probe.walls.empty() && probe.region_min.empty());
  };
  if (spec.refinement.empty() || std::ranges::none_of(spec.probes, is_on_part)) return;
  const SpacingField<Dim> field(spec, drawn);
  const std::vector<WallPatch<Dim>> patches = make_wall_patches(drawn, spec.particles.spacing);
  for (std::size_t w = 0; w < spec.walls.size(); ++w) {
    const auto hull = static_cast<int>(w);
    if (!is_hull(spec.walls[w]) || spec.walls[w].drive.by == Drive::By::body) continue;
    if (is_outside_zones(field, drawn, hull, spec.particles.spacing)) continue;
    const int beside = wall_beside(spec, drawn, patches, hull);
    if (beside < 0) continue;
    for (const ProbeTable& probe : spec.probes) {
      const bool has_hull =
          probe.walls.empty() || std::ranges::find(probe.walls, drawn.walls[w].name) != probe.walls.end();
      if (!is_on_part(probe) || !has_hull) continue;
      findings.push_back(Finding::warning(
          "force-beside-zone",
          {"{}: beside a zone of refinement the force on {} is the sum over pairs of particles, "
           "without the pressure in the gap to {}",
           label(probe), wall_label(drawn, hull), wall_label(drawn, beside)},
          {"end the zones {:.4g} before the hull, or measure with type = \"wall-pressure-mean\", if the gap "
           "holds two rows of particles",
           Amount{reach_of_shares * spec.particles.spacing, "m"}}));
    }
  }
}

}  // namespace

template <int Dim>
std::vector<AffineMap<Dim>> path_of_wall(const CaseSpec& spec, const Boundary<Dim>& drawn, int wall) {
  std::vector<AffineMap<Dim>> maps;
  const WallPath<Dim> path(spec, spec.walls[wall], wall_label(drawn, wall));
  for (int k = 0; k <= looks_at_path; ++k) {
    const AffineMap<Dim> map = path.at(spec.time.end * k / looks_at_path);
    const bool is_finite = map.linear.allFinite() && map.constant.allFinite();  // check_paths reports others
    if (is_finite) maps.push_back(map);
  }
  return maps;
}

template <int Dim>
Box<Dim> swept_box(const CaseSpec& spec, const Boundary<Dim>& drawn, int wall) {
  Box<Dim> box;
  for (const AffineMap<Dim>& map : path_of_wall(spec, drawn, wall)) {
    for (const WallFace<Dim>& face : drawn.faces) {
      if (face.wall == wall) box.extend(moved(map, face).box());
    }
  }
  return box;
}

template <int Dim>
Findings check_damping(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid) {
  Findings findings;
  if (spec.damping.empty() || drawn.faces.empty()) return findings;
  const Box<Dim> box = box_of_case(spec, drawn, fluid);
  for (const DampingTable& zone : spec.damping) {
    const CaseLabel owner("damping", zone.name);
    const Box<Dim> where = zone_box<Dim>(zone);
    if (box.intersects(where)) continue;
    findings.push_back(Finding::error(
        "damping-outside-case",
        {"{} from {} to {} is outside of the case, whose walls and water lie between {} and {}: it would damp nothing",
         owner, place<Dim>(where.min()), place<Dim>(where.max()), place<Dim>(box.min()), place<Dim>(box.max())},
        {"move it to where the waves are to decay"}));
  }
  for (std::size_t b = 1; b < spec.damping.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) check_zones_apart<Dim>(spec, spec.damping[a], spec.damping[b], findings);
  }
  return findings;
}

template <int Dim>
Findings check_probes(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid) {
  Findings findings;
  const Box<Dim> box = box_of_case(spec, drawn, fluid);
  check_hulls_at_zones(spec, drawn, findings);
  for (const ProbeTable& probe : spec.probes) {
    check_interval(spec, probe, findings);
    check_times(spec, probe, findings);
    check_is_on_wall(spec, drawn, probe, findings);
    const Box<Dim> where = box_of_probe<Dim>(probe);
    if (drawn.faces.empty() || where.isEmpty() || reach_of_water(spec, box).intersects(where)) continue;
    findings.push_back(Finding::error(
        "probe-outside-case",
        {"{} at {} is outside of the case, whose walls and water lie between {} and {}: no water comes there",
         label(probe), place<Dim>(where.min()), place<Dim>(box.min()), place<Dim>(box.max())},
        {"move it"}));
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(path_of_wall);
TAILWATER_IN_2D_AND_3D(swept_box);
TAILWATER_IN_2D_AND_3D(check_damping);
TAILWATER_IN_2D_AND_3D(check_probes);

}  // namespace tailwater
