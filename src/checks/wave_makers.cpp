#include <algorithm>
#include <limits>
#include <numbers>

#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "motion/wave_maker.h"
#include "motion/wave_theory.h"
#include "motion/wave_zone.h"

namespace tailwater {
namespace {

constexpr double reach = 4.0;         // dx; distance in front of a plate at which the water is sampled
constexpr double most_error = 0.1;    // error of the depth, as a fraction of it
constexpr double most_columns = 1.0;  // dx; error of the depth
constexpr double most_plate_reflection = 0.1;
constexpr double most_zone_reflection = 0.05;

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

/// dx; a solitary wave of 0.38 dx grows by 11 % over 28 depths.
constexpr double lowest_wave = 0.5;

/// Waves that the particles do not resolve.
Findings check_height(const WaveKeys& waves, const CaseLabel& owner, double dx) {
  if (waves.waves == WaveKind::none || waves.height >= lowest_resolved_wave * dx) return {};
  if (waves.height < lowest_wave * dx) {
    return {Finding::error(
        "waves-below-spacing",
        {"{} = {:.4g} is {:.2g} spacings: waves lower than {:g} spacings grow on their way instead of keeping their "
         "height",
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

/// Warns of a plate that absorbs badly according to linear theory.
Findings check_absorption(const WaveMakerTable& maker, double gravity) {
  if (maker.absorption == Absorption::none || maker.period == 0.0) return {};
  const double omega = 2.0 * std::numbers::pi / maker.period;
  const double reflection = plate_reflection(maker.type, omega, gravity, maker.depth);
  if (reflection <= most_plate_reflection) return {};
  return {Finding::warning("maker-reflects-waves",
                           {"{} reflects {:.0f} % of incoming waves of its own period, {:.4g} (kh = {:.3g})",
                            CaseLabel("wave_maker", maker.name), 100.0 * reflection, Amount{maker.period, "s"},
                            wave_number(omega, gravity, maker.depth) * maker.depth},
                           {"replace it with a [[damping]] zone, which makes and absorbs waves of any depth"})};
}

}  // namespace

template <int Dim>
Findings check_wave_makers(const CaseSpec& spec, const FluidParticles<Dim>& fluid) {
  Findings findings;
  const double dx = spec.particles.spacing;
  for (const WaveMakerTable& maker : spec.wave_makers) {
    append(findings, check_height(maker, CaseLabel("wave_maker", maker.name), dx));
    append(findings, check_absorption(maker, gravity_of<Dim>(spec).norm()));
    const std::optional<double> depth = depth_at(WavePlate<Dim>(spec, maker), fluid, dx);
    if (!depth || std::abs(*depth - maker.depth) <= std::max(most_error * maker.depth, most_columns * dx)) continue;
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
Findings check_wave_zones(const CaseSpec& spec) {
  Findings findings;
  const double gravity = gravity_of<Dim>(spec).norm();
  for (const DampingTable& zone : spec.damping) {
    const CaseLabel owner("damping", zone.name);
    append(findings, check_height(zone, owner, spec.particles.spacing));
    const WaveZone<Dim> made(spec, zone);  // throws where the waves break
    const std::optional<ZoneForecast> forecast = forecast_zone(spec, zone, gravity);
    if (!forecast) continue;
    const ZoneEstimate& estimate = forecast->estimate;
    const double error = made.has_waves() ? estimate.worse() : estimate.reflection;
    if (error <= most_zone_reflection) continue;
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
