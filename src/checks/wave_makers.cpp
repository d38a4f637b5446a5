#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/box.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "motion/wave_maker.h"
#include "motion/wave_theory.h"
#include "motion/wave_zone.h"

namespace tailwater {
namespace {

constexpr double reach = 4.0;        // dx; distance in front of a plate at which the water is sampled
constexpr double max_error = 0.1;    // error of the depth, as a fraction of it
constexpr double max_columns = 1.0;  // dx; error of the depth
constexpr double max_plate_reflection = 0.1;
constexpr double max_zone_reflection = 0.05;

/// Height [m] of the water in front of a plate above its foot, over all ranks; none where there is no water.
template <int Dim>
std::optional<double> depth_at(const WavePlate<Dim>& plate, const FluidParticles<Dim>& fluid, double dx) {
  constexpr double none = -std::numeric_limits<double>::infinity();
  double highest = none;
  for (const Vec<Dim>& x : fluid.position) {
    const double ahead = plate.forward.dot(x - plate.foot);
    const bool is_beside = Dim == 3 && std::abs(plate.along.dot(x - plate.foot)) > 0.5 * plate.width;
    if (ahead < 0.0 || ahead > reach * dx || is_beside) continue;
    highest = std::max(highest, plate.up.dot(x - plate.foot) + 0.5 * dx);
  }
  highest = fluid.ranks.largest(highest);
  return highest > none ? std::optional(highest) : std::nullopt;
}

/// dx; a standing wave of 0.4 dx falls to a sixth in 20 periods. The crest of a solitary wave of 0.38 dx rises by 10 %
/// over 28 depths, at constant energy.
constexpr double lowest_wave = 0.5;

/// Waves that the particles do not resolve.
Findings check_height(const WaveKeys& waves, const CaseLabel& owner, double dx) {
  if (waves.waves == WaveKind::none || waves.height >= lowest_resolved_wave * dx) return {};
  if (waves.height < lowest_wave * dx) {
    return {Finding::error("waves-below-spacing",
                           {"{} = {:.4g} is {:.2g} spacings: waves lower than {:g} spacings do not keep their height",
                            owner.with_key("height"), Amount{waves.height, "m"}, waves.height / dx, lowest_wave},
                           {"use a spacing of at most {:.3g} m, better a tenth of the height",
                            0.99 * waves.height / lowest_resolved_wave})};
  }
  return {Finding::warning(
      "waves-few-rows",
      {"{} = {:.4g} is {:.2g} spacings: waves lower than {:g} spacings are not resolved, and their heights are "
       "unreliable",
       owner.with_key("height"), Amount{waves.height, "m"}, waves.height / dx, lowest_resolved_wave},
      {"use a spacing of at most {:.3g} m, better a tenth of the height", 0.99 * waves.height / lowest_resolved_wave})};
}

/// Crests of a focused group that cannot have come to their focus by its time, at the group velocity of the peak. A
/// zone may leave its depth to the wave maker; then nothing is checked.
Findings check_focus(const WaveKeys& waves, const CaseLabel& owner, double depth, double gravity) {
  if (waves.waves != WaveKind::focused || gravity == 0.0 || depth == 0.0) return {};
  const double omega = 2.0 * std::numbers::pi / waves.period;
  const double k = wave_number(omega, gravity, depth);
  const double group_velocity = 0.5 * omega / k * (1.0 + 2.0 * k * depth / std::sinh(2.0 * k * depth));
  const double travel = waves.focus[0] / group_velocity;
  if (waves.focus[1] >= waves.start + travel) return {};
  return {Finding::error(
      "focus-too-early",
      {"{} = [{:g}, {:g}]: waves of the period {:.4g} that begin at t = {:.4g} s take {:.3g} s over this distance",
       owner.with_key("focus"), waves.focus[0], waves.focus[1], Amount{waves.period, "s"}, waves.start, travel},
      {"give a time of at least {:.3g} s, or a shorter distance", waves.start + travel + 2.0 * waves.period})};
}

/// Warns of a plate that absorbs badly according to linear theory.
Findings check_absorption(const WaveMakerTable& maker, double gravity) {
  if (maker.absorption == Absorption::none || maker.period == 0.0) return {};
  const double omega = 2.0 * std::numbers::pi / maker.period;
  const double reflection = plate_reflection(maker.type, omega, gravity, maker.depth);
  if (reflection <= max_plate_reflection) return {};
  return {Finding::warning("maker-reflects-waves",
                           {"{} reflects {:.0f} % of incoming waves of its own period, {:.4g} (kh = {:.3g})",
                            CaseLabel("wave_maker", maker.name), 100.0 * reflection, Amount{maker.period, "s"},
                            wave_number(omega, gravity, maker.depth) * maker.depth},
                           {"replace it with a [[damping]] zone, which makes and absorbs waves of any depth"})};
}

/// Waves that run over the top of their wave maker.
template <int Dim>
Findings check_top(const WaveMakerTable& maker, const WavePlate<Dim>& plate) {
  const bool is_long = maker.waves == WaveKind::solitary || maker.waves == WaveKind::n_wave;
  const double crest = (is_long ? 1.0 : 0.5) * maker.height;
  const CaseLabel owner("wave_maker", maker.name);
  const double above = plate.up.dot(to_vec<Dim>(maker.to, owner, "to") - plate.foot) - maker.depth;
  if (maker.waves == WaveKind::none || above >= crest) return {};
  return {
      Finding::warning("maker-below-crests",
                       {"{} ends {:.3g} above the still water, and the crests of its waves are {:.3g} m high or more",
                        owner, Amount{above, "m"}, crest},
                       {"let it end above the waves that it makes and those that come back"})};
}

/// m; height along `up` of the highest particle of water at the start with is_there(place); minus infinity without one.
/// Collective.
template <int Dim, class IsThere>
double highest_water(const FluidParticles<Dim>& fluid, const Vec<Dim>& up, IsThere&& is_there) {
  double highest = -std::numeric_limits<double>::infinity();
  for (const Vec<Dim>& x : fluid.position) {
    if (is_there(x)) highest = std::max(highest, up.dot(x));
  }
  return fluid.ranks.largest(highest);
}

/// The water at the start must stand where the waves of a zone have their still level.
template <int Dim>
Findings check_level(const CaseSpec& spec, const DampingTable& zone, const FluidParticles<Dim>& fluid) {
  const CaseLabel owner("damping", zone.name);
  const Vec<Dim> up = -gravity_of<Dim>(spec).normalized();
  const Box<Dim> box(to_vec<Dim>(zone.min, owner, "min"), to_vec<Dim>(zone.max, owner, "max"));
  const double dx = spec.particles.spacing;
  const double surface = 0.5 * dx + highest_water(fluid, up, [&](const Vec<Dim>& x) { return box.contains(x); });
  const double top = std::max(up.dot(box.min()), up.dot(box.max()));
  const bool is_known = std::isfinite(surface) && surface < top - dx;
  if (!is_known || std::abs(surface - zone.level) <= std::max(max_error * zone.depth, max_columns * dx)) return {};
  return {Finding::error("zone-level-differs",
                         {"{} = {:.4g}, but the surface of the water in the zone is at {:.4g} m at the start",
                          owner.with_key("level"), Amount{zone.level, "m"}, surface},
                         {"set level to the height of the surface, or change the water"})};
}

/// Warns of a zone that damps most on its side towards the water, and of one that leaves out water near the surface.
template <int Dim>
Findings check_side_and_top(const CaseSpec& spec, const DampingTable& zone, const FluidParticles<Dim>& fluid) {
  const CaseLabel owner("damping", zone.name);
  const auto axis = static_cast<int>(zone.towards) / 2;
  const bool is_upwards = static_cast<int>(zone.towards) % 2 == 1;
  const Box<Dim> water = fluid.box();
  if (water.isEmpty() || axis >= Dim || !periodic_range(spec.domain, axis).empty()) return {};
  Findings findings;
  const double higher = std::max(water.max()[axis] - zone.max[axis], 0.0);
  const double lower = std::max(zone.min[axis] - water.min()[axis], 0.0);
  if (is_upwards ? higher > lower : lower > higher) {
    findings.push_back(Finding::warning(
        "damping-turned-to-water",
        {"{} damps most at its {}{} side, and most of the water is on that side: its waves meet the full damping at "
         "once and are reflected",
         owner, is_upwards ? '+' : '-', "xyz"[axis]},
        {"give towards = \"{}{}\"", is_upwards ? '-' : '+', "xyz"[axis]}));
  }
  if (axis == Dim - 1 || gravity_of<Dim>(spec)[Dim - 1] >= 0.0) return findings;
  const auto is_in_plan = [&](const Vec<Dim>& x) {
    for (int d = 0; d < Dim - 1; ++d) {
      if (x[d] < zone.min[d] || x[d] > zone.max[d]) return false;
    }
    return true;
  };
  const double above = highest_water(fluid, Vec<Dim>(Vec<Dim>::Unit(Dim - 1)), is_in_plan) - zone.max.back();
  if (above > spec.particles.spacing) {
    findings.push_back(Finding::warning(
        "damping-below-surface",
        {"{} ends {:.3g} below the surface, and waves move the water most there", owner, Amount{above, "m"}},
        {"let `max` reach above the crests"}));
  }
  return findings;
}

/// Warns of a zone that brakes the flow from an inlet to an outlet.
template <int Dim>
Findings check_current(const CaseSpec& spec, const DampingTable& zone) {
  if (zone.waves != WaveKind::none || zone.transport != 0.0) return {};
  const auto axis = static_cast<int>(zone.towards) / 2;
  const double middle = 0.5 * (zone.min[axis] + zone.max[axis]);
  const std::vector<Opening<Dim>> ends = make_open_ends<Dim>(spec);
  for (const Opening<Dim>& in : ends) {
    for (const Opening<Dim>& out : ends) {
      const double before = box_around(in.as_faces()).center()[axis] - middle;
      const double beyond = box_around(out.as_faces()).center()[axis] - middle;
      if (in.kind != OpeningKind::inlet || out.kind != OpeningKind::outlet || before * beyond >= 0.0) continue;
      return {Finding::warning("damping-brakes-flow",
                               {"{} lies between {} and {}, and brings the flow between them to rest",
                                CaseLabel("damping", zone.name), in.label(), out.label()},
                               {"give `transport`, the mean velocity of the flow, positive in the direction of "
                                "`towards`"})};
    }
  }
  return {};
}

}  // namespace

template <int Dim>
Findings check_wave_makers(const CaseSpec& spec, const FluidParticles<Dim>& fluid) {
  Findings findings;
  const double dx = spec.particles.spacing;
  for (const WaveMakerTable& maker : spec.wave_makers) {
    append(findings, check_height(maker, CaseLabel("wave_maker", maker.name), dx));
    append(findings,
           check_focus(maker, CaseLabel("wave_maker", maker.name), maker.depth, gravity_of<Dim>(spec).norm()));
    append(findings, check_absorption(maker, gravity_of<Dim>(spec).norm()));
    const WavePlate<Dim> plate(spec, maker);
    append(findings, check_top(maker, plate));
    const std::optional<double> depth = depth_at(plate, fluid, dx);
    if (!depth || std::abs(*depth - maker.depth) <= std::max(max_error * maker.depth, max_columns * dx)) continue;
    findings.push_back(
        Finding::error("maker-depth-differs",
                       {"{} = {:.4g}, but the water in front of it is {:.4g} m deep at the start: its waves would not "
                        "have the prescribed height",
                        CaseLabel("wave_maker", maker.name).with_key("depth"), Amount{maker.depth, "m"}, *depth},
                       {"set depth to the depth of the water, or change the water level"}));
  }
  return findings;
}

template <int Dim>
Findings check_wave_zones(const CaseSpec& spec, const FluidParticles<Dim>& fluid) {
  Findings findings;
  const double gravity = gravity_of<Dim>(spec).norm();
  for (const DampingTable& zone : spec.damping) {
    const CaseLabel owner("damping", zone.name);
    append(findings, check_height(zone, owner, spec.particles.spacing));
    append(findings, check_focus(zone, owner, zone.depth, gravity));
    append(findings, check_side_and_top(spec, zone, fluid));
    append(findings, check_current<Dim>(spec, zone));
    if (zone.waves != WaveKind::none) append(findings, check_level(spec, zone, fluid));
    const WaveZone<Dim> made(spec, zone);  // throws where the waves break
    const std::optional<ZoneForecast> forecast = forecast_zone(spec, zone, gravity);
    if (!forecast) continue;
    const ZoneEstimate& estimate = forecast->estimate;
    const double error = made.has_waves() ? estimate.worse() : estimate.reflection;
    if (error <= max_zone_reflection) continue;
    const double k = forecast->wave_number;
    findings.push_back(Finding::warning(
        "damping-reflects-waves",
        {"{} is {:.3g} long, {:.2g} of the wavelength: it reflects {:.0f} % of waves of kh = {:.3g}{}", owner,
         Amount{length_of(zone), "m"}, length_of(zone) * k / (2.0 * std::numbers::pi), 100.0 * estimate.reflection,
         k * forecast->waves.depth,
         made.has_waves() ? fmt::format(", and its own waves are {:.0f} % off", 100.0 * estimate.leak) : ""},
        {"make the zone {:.3g} m long, one and a half wavelengths, and leave out strength",
         3.0 * std::numbers::pi / k}));
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_wave_makers);
TAILWATER_IN_2D_AND_3D(check_wave_zones);

}  // namespace tailwater
