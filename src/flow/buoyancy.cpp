#include "flow/buoyancy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/for_each.h"

namespace tailwater {
namespace {

/// Least g'/g. It limits the time step of liquids of equal density, which have no internal wave speed.
constexpr double min_reduced_gravity = 1e-3;

/// kg/m^3; of the lightest and the heaviest liquid.
template <int Dim>
std::pair<double, double> extreme_densities(const Setup<Dim>& setup) {
  if (!setup.liquids.are_several()) return {setup.liquid.density, setup.liquid.density};
  const auto [lightest, heaviest] = std::ranges::minmax_element(setup.liquids.density);
  return {*lightest, *heaviest};
}

}  // namespace

template <int Dim>
double find_fullness_between_openings(const Flow<Dim>& flow) {
  if (!flow.setup.has_air()) return 0.0;
  const Vec<2> nothing = Vec<2>::Zero();
  Vec<2> beside_air_and_all = sum_over(flow.state.particles.owned, nothing, [&](std::size_t i) {
    const double weight = flow.setup.weight_in_statistics(flow.state.particles.volume[i]);
    return flow.role[i] == Role::water ? Vec<2>(weight * (1.0 - flow.surroundings.interior[i]), weight) : nothing;
  });
  flow.setup.ranks.sum_each(beside_air_and_all[0], beside_air_and_all[1]);
  return beside_air_and_all[1] > 0.0 ? std::max(0.0, 1.0 - beside_air_and_all[0]) : 0.0;
}

template <int Dim>
double find_fullness(const Flow<Dim>& flow) {
  return flow.is_open() ? 0.0 : find_fullness_between_openings(flow);
}

template <int Dim>
bool may_be_balanced(const Flow<Dim>& flow) {
  return flow.setup.liquids.are_several() || (flow.is_open() && !flow.setup.has_implicit_viscosity);
}

template <int Dim>
double balanced_density(const Flow<Dim>& flow) {
  return may_be_balanced(flow) ? flow.state.last_step.fullness * extreme_densities(flow.setup).first : 0.0;
}

template <int Dim>
TimeStepRule time_step_rule(const Flow<Dim>& flow) {
  TimeStepRule rule = flow.setup.time_step_rule;
  const double balanced = balanced_density(flow);
  if (balanced == 0.0) return rule;
  const double reduced = extreme_densities(flow.setup).second / balanced - 1.0;
  rule.reference_speed *= std::sqrt(std::clamp(reduced, min_reduced_gravity, 1.0));
  return rule;
}

template <int Dim>
double noise_viscosity(const Setup<Dim>& setup, const TimeStepRule& rule, double speed) {
  return setup.formulation.noise_viscosity * setup.scale.spacing * std::max(speed, rule.reference_speed);
}

template <int Dim>
std::vector<double> without_balanced_pressure(const Flow<Dim>& flow, double density,
                                              const std::vector<double>& pressure) {
  const Particles<Dim>& particles = flow.state.particles;
  const Vec<Dim> across = flow.setup.gravity_across();
  std::vector<double> rest(pressure.size());
  for_each(rest.size(), [&](std::size_t i) { rest[i] = pressure[i] - density * across.dot(particles.position[i]); });
  constexpr double none = std::numeric_limits<double>::lowest();
  const double least = -flow.setup.ranks.largest(
      largest_over(particles.owned, none, [&](std::size_t i) { return particles.is_fluid(i) ? -rest[i] : none; }));
  for_each(rest.size(), [&](std::size_t i) { rest[i] -= least; });
  return rest;
}

template <int Dim>
std::vector<double> balanced_pressure(const Flow<Dim>& flow) {
  const double density = balanced_density(flow);
  if (density == 0.0) return {};
  const std::vector<double>& pressure = flow.state.particles.pressure;
  const std::vector<double> rest = without_balanced_pressure(flow, density, pressure);
  std::vector<double> balanced(flow.state.particles.owned);
  for_each(balanced.size(), [&](std::size_t i) { balanced[i] = pressure[i] - rest[i]; });
  return balanced;
}

TAILWATER_IN_2D_AND_3D(find_fullness_between_openings);
TAILWATER_IN_2D_AND_3D(may_be_balanced);
TAILWATER_IN_2D_AND_3D(balanced_pressure);
TAILWATER_IN_2D_AND_3D(find_fullness);
TAILWATER_IN_2D_AND_3D(balanced_density);
TAILWATER_IN_2D_AND_3D(time_step_rule);
TAILWATER_IN_2D_AND_3D(noise_viscosity);
TAILWATER_IN_2D_AND_3D(without_balanced_pressure);

}  // namespace tailwater
