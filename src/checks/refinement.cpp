#include "refinement/spacing_field.h"

#include "base/box.h"
#include "case/formulation.h"
#include "checks/checks.h"
#include "checks/swept_box.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "geometry/wall_label.h"
#include "motion/floating_body.h"
#include "refinement/zone_depth.h"

namespace tailwater {
namespace {

/// dx; from a zone to open ends, walls that move and bodies outside of it. Those have the spacing of the case, and so
/// has all water in their supports.
constexpr double clearance = 8.0;

Finding refused(const CaseLabel& owner, const std::string& what, Clause remedy) {
  return Finding::error("zone-refuses-feature", {"{}: zones of refinement do not work with {}", owner, what},
                        std::move(remedy));
}

/// Features of the case that no zone works with, wherever it is.
Findings check_features(const CaseSpec& spec, const CaseLabel& owner) {
  Findings findings;
  const auto refuse = [&](bool is_given, const std::string& what, Clause remedy) {
    if (is_given) findings.push_back(refused(owner, what, std::move(remedy)));
  };
  const std::string_view choice = traits_of(spec).no_zones;
  refuse(!choice.empty(), std::string(choice), {"remove the zone, or this key"});
  refuse(spec.air.pockets != AirPockets::none, "enclosed air", {"give pockets = \"none\" in [air]"});
  refuse(!spec.porous.empty(), "porous layers", {"remove the zone or the layers"});
  refuse(!spec.liquids.empty(), "other liquids than water", {"remove the zone or [[liquid]]"});
  return findings;
}

/// Whether a zone ends or fades within the repeated stretch on one side of a period and not on the other.
template <int Dim>
Findings check_period(const CaseSpec& spec, const typename SpacingField<Dim>::Zone& zone, const CaseLabel& owner) {
  Findings findings;
  int periodic = 0;
  for (int axis = 0; axis < Dim; ++axis) {
    const std::vector<double>& range = periodic_range(spec.domain, axis);
    if (range.empty()) continue;
    ++periodic;
    const bool is_below = zone.box.min()[axis] <= range[0];
    const bool is_above = zone.box.max()[axis] >= range[1];
    if (is_below == is_above) continue;
    findings.push_back(Finding::error(
        "zone-across-period",
        {"{} reaches over one end of the periodic direction {}, which goes from {:g} to {:g}, and not over the other: "
         "the spacing would jump there",
         owner, "xyz"[axis], range[0], range[1]},
        {"let it reach over both ends, or end it between them"}));
  }
  if (periodic == Dim) findings.push_back(refused(owner, "a domain that is periodic in all directions", {"add walls"}));
  return findings;
}

/// Calls visit(x) for places all over a box, at most a spacing apart if it is not large.
template <int Dim, class Visit>
void visit_places(const CaseSpec& spec, const Box<Dim>& box, Visit&& visit) {
  constexpr double most = Dim == 2 ? 100.0 : 40.0;  // along each edge
  std::array<int, Dim> counts;
  double all = 1.0;
  for (int axis = 0; axis < Dim; ++axis) {
    counts[axis] = 1 + static_cast<int>(std::ceil(std::min(most, box.sizes()[axis] / spec.particles.spacing)));
    all *= counts[axis];
  }
  for (int n = 0; n < static_cast<int>(all); ++n) {
    Vec<Dim> x = box.min();
    for (int axis = 0, rest = n; axis < Dim; rest /= counts[axis++]) {
      x[axis] += box.sizes()[axis] * (rest % counts[axis]) / std::max(counts[axis] - 1, 1);
    }
    visit(x);
  }
}

/// Calls visit(depth) with the depths of these places in a zone.
template <int Dim, class Visit>
void visit_depths(const CaseSpec& spec, const typename SpacingField<Dim>::Zone& zone, const Box<Dim>& box,
                  Visit&& visit) {
  visit_places<Dim>(spec, box, [&](const Vec<Dim>& x) { visit(zone.depth->depth(x)); });
}

/// A polygon that nowhere is as deep as its border is wide.
template <int Dim>
Findings check_depth(const CaseSpec& spec, const Box<Dim>& all, const typename SpacingField<Dim>::Zone& zone,
                     const CaseLabel& owner) {
  double deepest = 0.0;
  visit_depths<Dim>(spec, zone, zone.box.intersection(all), [&](double depth) { deepest = std::max(deepest, depth); });
  if (deepest >= zone.border - spec.particles.spacing) return {};
  return {Finding::error("zone-too-thin",
                         {"{} reaches at most {:.4g} inwards from its edges, but the transition to its spacing takes "
                          "{:.4g} m: no part of the zone would be as fine as prescribed",
                          owner, Amount{deepest, "m"}, zone.border},
                         {"make the polygon wider, let it reach beyond the outermost walls, or use a lower level"})};
}

/// A zone that moves beside others.
Findings check_alone(const CaseSpec& spec, const CaseLabel& owner) {
  if (spec.refinement.size() == 1) return {};
  return {Finding::error("moving-zone-not-alone", {"{} moves: a zone that moves must be the only one", owner},
                         {"remove the other zones, or give a fixed box that contains its path"})};
}

/// A zone that is carried by walls, where it cannot be.
template <int Dim>
Findings check_carried(const CaseSpec& spec, const Boundary<Dim>& boundary, int carrier, const RefinementTable& table,
                       const CaseLabel& owner) {
  Findings findings = check_alone(spec, owner);
  const CaseLabel by = wall_label(boundary, carrier);
  for (const WallProperties& wall : boundary.walls) {
    if (wall.body == boundary.walls[carrier].body || std::ranges::count(table.walls, wall.name) == 0) continue;
    findings.push_back(Finding::error("zone-walls-move-apart",
                                      {"{} moves with {}, and '{}' does not move with that wall", owner, by, wall.name},
                                      {"name walls of one body only, or give shape = \"box\""}));
  }
  bool repeats = false;
  for (int axis = 0; axis < Dim; ++axis) repeats = repeats || !periodic_range(spec.domain, axis).empty();
  if (repeats) {
    findings.push_back(Finding::error("moving-zone-in-periodic-domain",
                                      {"{} moves with {}, which is not possible in a periodic domain", owner, by},
                                      {"give shape = \"box\" with a box that contains its path"}));
  }
  if (const double least = clearance * spec.particles.spacing * std::exp2(-table.level); table.distance < least) {
    findings.push_back(Finding::error("moving-zone-too-narrow",
                                      {"{} = {:.4g} is less than the reach of particles beside walls that move",
                                       owner.with_key("distance"), Amount{table.distance, "m"}},
                                      {"give at least {:.4g}", least}));
  }
  return findings;
}

/// A zone that is narrower than its borders.
template <int Dim>
Findings check_width(const CaseSpec& spec, const Box<Dim>& all, const typename SpacingField<Dim>::Zone& zone,
                     const CaseLabel& owner) {
  for (int axis = 0; axis < Dim; ++axis) {
    const bool has_low = std::isfinite(zone.box.min()[axis]);
    const bool has_high = std::isfinite(zone.box.max()[axis]);
    const double low = has_low ? zone.box.min()[axis] : all.min()[axis];
    const double high = has_high ? zone.box.max()[axis] : all.max()[axis];
    const double needed = zone.border * (static_cast<int>(has_low) + static_cast<int>(has_high));
    if (high - low >= needed - corner_tolerance * spec.particles.spacing) continue;
    return {Finding::error(
        "zone-too-narrow",
        {"{} is {:.4g} long in {}, but the transition to its spacing takes {:.4g} m behind each face: no part of the "
         "zone would be as fine as prescribed",
         owner, Amount{high - low, "m"}, "xyz"[axis], zone.border},
        {"make the zone at least {:.4g} m long, let it reach to the outermost walls, or use a lower level", needed})};
  }
  return {};
}

/// Where a zone that moves is, from where it is drawn, at instants of the run.
template <int Dim>
std::vector<AffineMap<Dim>> path_of_zone(const CaseSpec& spec, const Boundary<Dim>& boundary,
                                         const SpacingField<Dim>& field) {
  if (field.carrier() >= 0) {
    std::vector<AffineMap<Dim>> path = path_of_wall(spec, boundary, field.carrier());
    if (spec.walls[field.carrier()].drive.by == Drive::By::body) path.resize(1);
    return path;
  }
  std::vector<AffineMap<Dim>> path;
  for (int k = 0; k <= looks_at_path; ++k) {
    path.emplace_back().constant = field.displacement(spec.time.end * k / looks_at_path);
  }
  return path;
}

/// Whether a zone and its border meet a box at some place of the zone's path.
template <int Dim>
bool comes_near(const CaseSpec& spec, const SpacingField<Dim>& field, const typename SpacingField<Dim>::Zone& zone,
                const std::vector<AffineMap<Dim>>& path, const Box<Dim>& box) {
  const double margin = clearance * spec.particles.spacing;
  bool is_near = false;
  visit_places<Dim>(spec, box, [&](const Vec<Dim>& x) {
    for (const AffineMap<Dim>& map : path) is_near = is_near || field.depth_in(zone, map.inverse(x)) > -margin;
  });
  return is_near;
}

/// Whether a zone and its border meet a box.
template <int Dim>
bool is_near(const CaseSpec& spec, const SpacingField<Dim>& field, const typename SpacingField<Dim>::Zone& zone,
             const Box<Dim>& box) {
  const double margin = clearance * spec.particles.spacing;
  Box<Dim> wider = box;
  wider.widen(margin);
  if (zone.depth == nullptr || !zone.box.intersects(wider)) return zone.box.intersects(wider);
  return comes_near<Dim>(spec, field, zone, {AffineMap<Dim>()}, box);
}

/// Distance [m] from the faces of a zone at which water has its finest spacing in all of a support.
template <int Dim>
double margin_inside(const CaseSpec& spec, const typename SpacingField<Dim>::Zone& zone) {
  return zone.border + clearance * spec.particles.spacing * std::exp2(-zone.level);
}

/// Whether a box lies so far inside a zone that walls that move there keep the spacing of their rows.
template <int Dim>
bool is_inside(const CaseSpec& spec, const typename SpacingField<Dim>::Zone& zone, const Box<Dim>& box) {
  if (zone.depth != nullptr) {
    bool is_inside = true;
    visit_depths<Dim>(spec, zone, box,
                      [&](double depth) { is_inside = is_inside && depth >= margin_inside<Dim>(spec, zone); });
    return is_inside;
  }
  Box<Dim> finest = zone.box;
  return finest.widen(-margin_inside<Dim>(spec, zone)).contains(box);
}

/// Walls that move and open ends on the way of a zone that moves.
template <int Dim>
Findings check_way(const CaseSpec& spec, const Boundary<Dim>& boundary, const SpacingField<Dim>& field,
                   const CaseLabel& owner) {
  Findings findings;
  const auto& zone = field.zones().front();
  const std::vector<AffineMap<Dim>> path = path_of_zone(spec, boundary, field);
  const int body = field.carrier() < 0 ? resting_body : boundary.walls[field.carrier()].body;
  const auto refuse_near = [&](const Box<Dim>& box, const CaseLabel& what) {
    if (!comes_near<Dim>(spec, field, zone, path, box)) return;
    findings.push_back(Finding::error("moving-zone-near-part",
                                      {"{} moves and comes within {:g} spacings of {}", owner, clearance, what},
                                      {"keep it farther from there, or give a box at rest that contains both"}));
  };
  for (std::size_t w = 0; w < boundary.walls.size(); ++w) {
    const int wall = static_cast<int>(w);
    if (!boundary.walls[w].moves() || boundary.walls[w].body == body) continue;
    refuse_near(swept_box(spec, boundary, wall), wall_label(boundary, wall));
  }
  for (const Opening<Dim>& end : make_open_ends<Dim>(spec)) refuse_near(box_around(end.as_faces()), end.label());
  return findings;
}

/// Walls that move and open ends beside a zone.
template <int Dim>
Findings check_neighbours(const CaseSpec& spec, const Boundary<Dim>& boundary, const SpacingField<Dim>& field,
                          const typename SpacingField<Dim>::Zone& zone, const CaseLabel& owner) {
  Findings findings;
  const std::string within = fmt::format(" within {:g} spacings", clearance);
  const std::vector<int> body_of_wall = bodies_of_walls(make_bodies<Dim>(spec), boundary.walls.size());
  for (std::size_t w = 0; w < spec.walls.size(); ++w) {
    const int wall = static_cast<int>(w);
    if (!boundary.walls[wall].moves()) continue;
    const Box<Dim> swept = swept_box(spec, boundary, wall);
    if (!is_near<Dim>(spec, field, zone, swept) || is_inside<Dim>(spec, zone, swept)) continue;
    if (body_of_wall[wall] >= 0) {
      findings.push_back(refused(
          owner, "bodies" + within + " of its border",
          {"end the zone farther from all places that {} reaches, which starts from {} to {}, or let it reach at "
           "least {:.4g} m beyond them",
           wall_label(boundary, wall), place(swept.min()), place(swept.max()), margin_inside<Dim>(spec, zone)}));
      continue;
    }
    findings.push_back(
        refused(owner, "walls that move" + within + " of its border",
                {"end the zone at least {:.4g} m before the path of {}, which is from {} to {}, or let it "
                 "reach at least {:.4g} m beyond that path",
                 clearance * spec.particles.spacing, wall_label(boundary, wall), place(swept.min()), place(swept.max()),
                 margin_inside<Dim>(spec, zone)}));
  }
  for (const Opening<Dim>& end : make_open_ends<Dim>(spec)) {
    const Box<Dim> box = box_around(end.as_faces());
    if (!is_near<Dim>(spec, field, zone, box) || is_inside<Dim>(spec, zone, box)) continue;
    findings.push_back(refused(owner, "inlets and outlets" + within + " of its border",
                               {"end the zone farther from {}, or let it reach at least {:.4g} m beyond it",
                                end.label(), margin_inside<Dim>(spec, zone)}));
  }
  return findings;
}

/// A zone with a displacement of its own.
template <int Dim>
Findings check_displaced(const CaseSpec& spec, const Boundary<Dim>& boundary, const SpacingField<Dim>& field,
                         const CaseLabel& owner) {
  Findings findings = check_alone(spec, owner);
  if (!findings.empty()) return findings;
  const std::vector<AffineMap<Dim>> path = path_of_zone(spec, boundary, field);
  for (std::size_t k = 0; k < path.size(); ++k) {
    if (path[k].constant.allFinite()) continue;
    return {Finding::error("value-not-finite-in-time",
                           {"{} has no finite value at t = {:.6g} s", owner.with_key("displacement"),
                            spec.time.end * static_cast<double>(k) / looks_at_path},
                           {"give an expression that has one during the whole run"})};
  }
  return check_way(spec, boundary, field, owner);
}

/// Whether a zone is in a box at some time.
template <int Dim>
bool comes_into(const Box<Dim>& box, const CaseSpec& spec, const Boundary<Dim>& boundary,
                const SpacingField<Dim>& field, const typename SpacingField<Dim>::Zone& zone) {
  if (!field.moves() || field.carrier() >= 0) return box.intersects(zone.box);
  return std::ranges::any_of(path_of_zone(spec, boundary, field), [&](const AffineMap<Dim>& map) {
    if (!map.constant.allFinite()) return true;  // check_displaced reports it
    return box.intersects(Box<Dim>(zone.box.min() + map.constant, zone.box.max() + map.constant));
  });
}

}  // namespace

template <int Dim>
Findings check_refinement(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid) {
  Findings findings;
  const SpacingField<Dim> field(spec, drawn);
  const Box<Dim> box = fluid.box().merged(box_around(drawn.faces));
  for (std::size_t n = 0; n < spec.refinement.size(); ++n) {
    const RefinementTable& table = spec.refinement[n];
    const CaseLabel owner("refinement", table.name);
    const auto& zone = field.zones()[n];
    append(findings, check_features(spec, owner));
    if (!comes_into(box, spec, drawn, field, zone)) {
      findings.push_back(Finding::error("zone-outside-case",
                                        {"{} is outside of the case, whose walls and water lie between {} and {}: it "
                                         "would refine nothing",
                                         owner, place<Dim>(box.min()), place<Dim>(box.max())},
                                        {"move it to where the water is to be finer"}));
      continue;
    }
    if (field.carrier() >= 0) {
      const Findings carried = check_carried(spec, drawn, field.carrier(), table, owner);
      append(findings, carried);
      if (carried.empty()) append(findings, check_way(spec, drawn, field, owner));
      continue;
    }
    append(findings, check_period<Dim>(spec, zone, owner));
    if (zone.depth == nullptr) append(findings, check_width<Dim>(spec, box, zone, owner));
    if (table.shape == ZoneShape::polygon) append(findings, check_depth<Dim>(spec, box, zone, owner));
    append(findings, field.moves() ? check_displaced(spec, drawn, field, owner)
                                   : check_neighbours(spec, drawn, field, zone, owner));
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_refinement);

}  // namespace tailwater
