#include "run/explain.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "case/named_numbers.h"
#include "case/rheology.h"
#include "motion/wave_theory.h"
#include "motion/wave_zone.h"
#include "refinement/zone_words.h"
#include "results/progress.h"

namespace tailwater {
namespace {

std::string plural(double count, std::string_view what) {
  const bool is_of_es = what.ends_with("x");
  return fmt::format("{:.0f} {}{}", count, what, count == 1.0 ? "" : is_of_es ? "es" : "s");
}

/// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& parts) {
  if (parts.empty()) return "";
  const std::vector<std::string> first(parts.begin(), parts.end() - 1);
  return first.empty() ? parts.back() : fmt::format("{} and {}", fmt::join(first, ", "), parts.back());
}

/// A number with its unit, or the expression.
std::string told(const Varying& value, std::string_view unit) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:.4g} {}", *number, unit);
  return fmt::format("{} in {}", std::get<std::string>(value), unit);
}

std::string told(const Coordinates& at) { return fmt::format("({:.4g})", fmt::join(at, ", ")); }

std::string_view per_width(const CaseSpec& spec) { return spec.general.dimension == 2 ? " per metre of width" : ""; }

/// Sentences on zones of refinement, with a space before them; empty if there are none.
std::string about_refinement(const CaseSpec& spec) {
  std::string text;
  for (const RefinementTable& zone : spec.refinement) {
    text += fmt::format(" In zone '{}', {}, they are {:.4g} m apart.", zone.name, place_of_zone(zone),
                        spec.particles.spacing * std::exp2(-zone.level));
  }
  if (!text.empty()) text += " The time step is that of the finest zone.";
  return text;
}

/// "water", or the names of the liquids.
std::string fluid_name(const CaseSpec& spec) {
  const LiquidTable* const liquid = liquid_of(spec);
  if (liquid == nullptr) return "water";
  std::vector<std::string> names;
  for (const LiquidTable& each : spec.liquids) {
    if (has_several_liquids(spec) || &each == liquid) names.push_back(fmt::format("'{}'", each.name));
  }
  return listed(names);
}

std::string about_water(const CaseSpec& spec, const RunEstimate& estimate) {
  const double dx = spec.particles.spacing;
  if (spec.fluid.empty()) return fmt::format("There is no water at the start; particles are {:.4g} m apart.", dx);
  std::map<std::string_view, int> shapes;
  for (const FluidTable& fluid : spec.fluid) ++shapes[name_of(fluid.shape)];
  std::vector<std::string> kinds;
  for (const auto& [shape, count] : shapes) kinds.push_back(plural(count, shape));
  const bool has_one_density = !has_several_liquids(spec);
  return fmt::format("At the start there are {:.4g} m^3 of {}{}{}, in {}: {} particles, {:.4g} m apart.{}",
                     estimate.water, fluid_name(spec), per_width(spec),
                     has_one_density ? fmt::format(" ({:.4g} kg)", estimate.water * spec.physics.density) : "",
                     listed(kinds), fmt::format("{:.0f}", estimate.particles.fluid), dx, about_refinement(spec));
}

/// The law of a liquid with its numbers.
std::string law_of(const LiquidTable& liquid) {
  switch (liquid.rheology) {
    case Rheology::newtonian:
      return fmt::format("a viscosity of {:.4g} Pa s", liquid.viscosity);
    case Rheology::power_law:
      return fmt::format("a consistency of {:.4g} Pa s^n with the index {:.3g}", liquid.consistency, liquid.index);
    case Rheology::bingham:
      return fmt::format("a yield stress of {:.4g} Pa and a plastic viscosity of {:.4g} Pa s", liquid.yield_stress,
                         liquid.viscosity);
    case Rheology::herschel_bulkley:
      return fmt::format("a yield stress of {:.4g} Pa and a consistency of {:.4g} Pa s^n with the index {:.3g}",
                         liquid.yield_stress, liquid.consistency, liquid.index);
    case Rheology::carreau:
      break;
  }
  return fmt::format("a viscosity of {:.4g} Pa s at rest and {:.4g} Pa s at high shear rates", liquid.viscosity,
                     liquid.high_shear_viscosity);
}

std::string about_liquid(const LiquidTable& liquid) {
  std::string text = fmt::format(" The liquid '{}' ({}) has a density of {:.4g} kg/m^3, and {}.", liquid.name,
                                 name_of(liquid.rheology), liquid.density, law_of(liquid));
  if (liquid.yield_stress > 0.0) {
    text += fmt::format(" Below its yield stress it creeps, with {:.3g} Pa s.", viscosity_at_rest(liquid));
  }
  return text;
}

/// The sentences about the liquid of a case, or all its liquids.
std::string about_liquids(const CaseSpec& spec, const LiquidTable& liquid, bool is_implicit) {
  std::string text = fmt::format("Gravity is {:.4g} m/s^2.", gravity_magnitude(spec.physics));
  if (has_several_liquids(spec)) {
    for (const LiquidTable& each : spec.liquids) text += about_liquid(each);
    return text +
           " The liquids do not mix. Their viscous forces are solved for implicitly and do not shorten the time "
           "step.";
  }
  text += about_liquid(liquid);
  return text + (is_implicit ? " Its viscous forces are solved for implicitly and do not shorten the time step."
                             : " Its viscous forces are explicit, as those of water.");
}

std::string about_physics(const CaseSpec& spec, bool is_implicit) {
  if (const LiquidTable* const liquid = liquid_of(spec)) return about_liquids(spec, *liquid, is_implicit);
  const PhysicsTable& physics = spec.physics;
  std::string text = fmt::format("Gravity is {:.4g} m/s^2, the density {:.4g} kg/m^3, the viscosity {:.3g} m^2/s",
                                 gravity_magnitude(physics), physics.density, physics.viscosity);
  if (physics.channel_width > 0.0) {
    text += fmt::format("; side walls {:.4g} m apart slow the water down", physics.channel_width);
  }
  return text + ".";
}

std::string kind_of(const WallTable& wall) {
  std::string text = fmt::format("'{}' ({}", wall.name, name_of(wall.shape));
  if (!wall.points.empty()) text += fmt::format(" of {}", plural(static_cast<double>(wall.points.size()), "point"));
  if (wall.slip == Slip::no_slip) text += wall.roughness > 0.0 || wall.manning > 0.0 ? ", rough" : ", smooth";
  if (wall.slip == Slip::partial) text += ", with part of the friction";
  if (wall.slip == Slip::coulomb) text += fmt::format(", with a coefficient of friction of {:.3g}", wall.friction);
  const auto varies = [](const Varying& value) { return value != Varying(0.0); };
  const bool moves = !wall.series.empty() || varies(wall.rotation) || std::ranges::any_of(wall.displacement, varies);
  return text + (moves ? ", moves)" : ")");
}

std::string about_walls(const CaseSpec& spec) {
  constexpr std::size_t max_named = 8;
  std::vector<std::string> walls;
  std::size_t more = 0;
  for (const WallTable& wall : spec.walls) {
    if (wall.drive.by == Drive::By::gate || wall.drive.by == Drive::By::wave_maker) continue;
    if (walls.size() < max_named) {
      walls.push_back(kind_of(wall));
    } else {
      ++more;
    }
  }
  if (walls.empty()) return "There are no walls.";
  if (more > 0) walls.push_back(fmt::format("{} more", more));
  return fmt::format("Walls are {}.", listed(walls));
}

void add_gates(const CaseSpec& spec, std::vector<std::string>& sentences) {
  for (const GateTable& gate : spec.gates) {
    const std::string how = gate.motion == GateMotion::speed ? fmt::format("at {:.4g} m/s", gate.speed)
                            : gate.motion == GateMotion::acceleration
                                ? fmt::format("with {:.4g} m/s^2", gate.acceleration)
                                : "with the motion of " + gate.file;
    sentences.push_back(fmt::format("Gate '{}' begins to move at {:.4g} s, {}.", gate.name, gate.start, how));
  }
}

void add_bodies(const CaseSpec& spec, std::vector<std::string>& sentences) {
  for (const BodyTable& body : spec.bodies) {
    const auto lines = std::ranges::count_if(spec.moorings, [&](const MooringTable& mooring) {
      return std::ranges::find(mooring.bodies, body.name) != mooring.bodies.end();
    });
    std::vector<std::string> held;
    if (lines > 0) held.push_back(plural(static_cast<double>(lines), "line"));
    const auto add = [&](const std::vector<double>& numbers, const char* words) {
      if (std::ranges::any_of(numbers, [](double number) { return number > 0.0; })) held.emplace_back(words);
    };
    add(body.springs, "springs");
    add(body.damping, "linear dampers");
    add(body.quadratic_damping, "quadratic dampers");
    sentences.push_back(fmt::format("Body '{}' of {:.4g} kg{} floats, free in {}{}.", body.name, body.mass,
                                    per_width(spec), body.free.empty() ? "no way" : listed(body.free),
                                    held.empty() ? "" : ", on " + listed(held)));
  }
}

/// Wave makers and zones, with the waves that they reflect by their own theory.
void add_waves(const CaseSpec& spec, std::vector<std::string>& sentences) {
  const double gravity = gravity_magnitude(spec.physics);
  for (const WaveMakerTable& maker : spec.wave_makers) {
    std::string waves = fmt::format("makes {} waves {:.4g} m high", name_of(maker.waves), maker.height);
    if (maker.waves == WaveKind::none) waves = "only absorbs";
    if (maker.waves == WaveKind::solitary) waves = fmt::format("makes a solitary wave {:.4g} m high", maker.height);
    if (maker.waves == WaveKind::n_wave) waves = fmt::format("makes an N-wave with a crest of {:.4g} m", maker.height);
    if (maker.period > 0.0 && has_period(maker.waves)) waves += fmt::format(" with a period of {:.4g} s", maker.period);
    if (maker.absorption == Absorption::active && maker.period > 0.0 && gravity > 0.0) {
      const double omega = 2.0 * std::numbers::pi / maker.period;
      waves += fmt::format(" and sends back {:.2g} % of waves of this period",
                           100.0 * plate_reflection(maker.type, omega, gravity, maker.depth));
    }
    sentences.push_back(fmt::format("Wave maker '{}', a {} in water {:.4g} m deep, {}.", maker.name,
                                    name_of(maker.type), maker.depth, waves));
  }
  for (const DampingTable& zone : spec.damping) {
    const std::optional<ZoneForecast> forecast = forecast_zone(spec, zone, gravity);
    if (!forecast) continue;
    const std::string made = zone.waves != WaveKind::none
                                 ? fmt::format("makes {} waves {:.4g} m high, within {:.2g} % of theory, and ",
                                               name_of(zone.waves), zone.height, 100.0 * forecast->estimate.leak)
                                 : "";
    sentences.push_back(fmt::format(
        "Zone '{}' {}reflects {:.2g} % of waves of kh = {:.3g}; its strength is {:.3g} 1/s.", zone.name, made,
        100.0 * forecast->estimate.reflection, forecast->wave_number * forecast->waves.depth, forecast->strength));
  }
}

void add_open_ends(const CaseSpec& spec, std::vector<std::string>& sentences) {
  const std::string_view discharge = spec.general.dimension == 2 ? "m^3/s per metre of width" : "m^3/s";
  for (const InletTable& inlet : spec.inlets) {
    std::vector<std::string> parts;
    if (inlet.discharge) parts.push_back("a discharge of " + told(*inlet.discharge, discharge));
    if (inlet.velocity) parts.push_back("a velocity of " + told(*inlet.velocity, "m/s"));
    if (inlet.level) parts.push_back("a level of " + told(*inlet.level, "m"));
    if (!inlet.file.empty()) parts.push_back("the values of the file " + inlet.file);
    const std::string source =
        inlet.water_from.empty() ? "" : fmt::format(", from the outflow at '{}'", inlet.water_from);
    sentences.push_back(fmt::format("Water enters at '{}' with {}{}.", inlet.name, listed(parts), source));
  }
  for (const OutletTable& outlet : spec.outlets) {
    const std::string how = outlet.level                   ? "against a tailwater at " + told(*outlet.level, "m")
                            : !outlet.file.empty()         ? "against the tailwater level of the file " + outlet.file
                            : outlet.beyond == Beyond::air ? "as a free jet into air"
                                                           : "as if the channel continued";
    sentences.push_back(fmt::format("It leaves at '{}', {}.", outlet.name, how));
  }
}

void add_porous_layers(const CaseSpec& spec, std::vector<std::string>& sentences) {
  for (const PorousTable& layer : spec.porous) {
    const std::string law =
        layer.resistance == PorousResistance::coefficients
            ? fmt::format("the coefficients a = {:.4g} s/m and b = {:.4g} s^2/m^2", layer.linear, layer.quadratic)
            : fmt::format("grains of {:.4g} m ({})", layer.grain_size, name_of(layer.resistance));
    sentences.push_back(
        fmt::format("Porous layer '{}' has a porosity of {:.3g}, and {}.", layer.name, layer.porosity, law));
  }
}

void add_air(const CaseSpec& spec, std::vector<std::string>& sentences) {
  if (spec.air.pockets == AirPockets::none) return;
  sentences.push_back(fmt::format("Air that water and walls enclose is a gas ({}), in an atmosphere of {:.6g} Pa.",
                                  name_of(spec.air.pockets), spec.air.pressure));
  for (const PocketTable& pocket : spec.pockets) {
    sentences.push_back(fmt::format("That at {} begins {:.4g} Pa {} it.", told(pocket.at),
                                    std::abs(pocket.overpressure), pocket.overpressure < 0.0 ? "below" : "above"));
  }
  for (const VentTable& vent : spec.vents) {
    sentences.push_back(fmt::format("A vent at {} has {:.3g} m^2{}, with a loss coefficient of {:.3g}.", told(vent.at),
                                    vent.area, per_width(spec), vent.loss));
  }
}

std::string about_probes(const CaseSpec& spec) {
  if (spec.probes.empty()) return "Nothing is measured: there are no probes.";
  std::map<std::string_view, std::vector<std::string>> by_type;
  for (const ProbeTable& probe : spec.probes) by_type[name_of(probe.type)].push_back("'" + probe.name + "'");
  std::vector<std::string> parts;
  for (const auto& [type, names] : by_type) {
    constexpr std::size_t max_named = 4;
    parts.push_back(names.size() > max_named ? fmt::format("{} ({} probes)", type, names.size())
                                             : fmt::format("{} ({})", type, listed(names)));
  }
  return fmt::format("Measured are {}.", listed(parts));
}

std::string about_method(const CaseSpec& spec) {
  const SchemeTable& scheme = spec.scheme;
  return fmt::format("The scheme is {} ({}, {} integrator).", name_of(scheme.name), name_of(scheme.formulation),
                     name_of(scheme.integrator));
}

std::string about_cost(const CaseSpec& spec, const RunEstimate& estimate) {
  const double interval = spec.output.fields_interval > 0.0 ? spec.output.fields_interval : spec.time.end / 100.0;
  const std::string growth =
      estimate.largest_fluid > 1.1 * estimate.particles.fluid
          ? fmt::format(" With the inflow there will be about {:.2g} particles of water.", estimate.largest_fluid)
          : "";
  return fmt::format(
      "It ends at {:.4g} s: about {:.0f} steps, {} on one core of this machine and {:.0f} MB; fields are written every "
      "{:.3g} s.{}",
      spec.time.end, estimate.steps, readable_duration(estimate.seconds), estimate.memory / 1e6, interval, growth);
}

}  // namespace

std::vector<std::string> explain_case(const CaseSpec& spec, const RunEstimate& estimate) {
  std::vector<std::string> sentences{fmt::format("\"{}\" is a case in {} dimensions.", spec.general.title,
                                                 spec.general.dimension == 2 ? "two" : "three"),
                                     about_water(spec, estimate), about_walls(spec)};
  if (!spec.general.datum.empty()) sentences.push_back(fmt::format("The datum of heights is {}.", spec.general.datum));
  if (!spec.general.crs.empty()) sentences.push_back(fmt::format("Coordinates are in {}.", spec.general.crs));
  add_gates(spec, sentences);
  add_waves(spec, sentences);
  add_bodies(spec, sentences);
  add_porous_layers(spec, sentences);
  add_open_ends(spec, sentences);
  add_air(spec, sentences);
  sentences.push_back(about_physics(spec, estimate.has_implicit_viscosity));
  sentences.push_back(about_probes(spec));
  sentences.push_back(about_method(spec));
  sentences.push_back(about_cost(spec, estimate));
  return sentences;
}

}  // namespace tailwater
