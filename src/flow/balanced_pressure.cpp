#include "flow/balanced_pressure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/for_each.h"
#include "operators/pressure_ramp.h"

namespace tailwater {
namespace {

/// Least g'/g. It limits the time step of liquids of equal density, which have no internal wave speed.
constexpr double min_reduced_gravity = 1e-3;

/// dx; from the place of the outermost particles up to the surface.
constexpr double rows_beside_air = 0.5;

/// kg/m^3; of the lightest and the heaviest liquid.
template <int Dim>
std::pair<double, double> extreme_densities(const Setup<Dim>& setup) {
  if (!setup.liquids.are_several()) return {setup.liquid.density, setup.liquid.density};
  const auto [lightest, heaviest] = std::ranges::minmax_element(setup.liquids.density);
  return {*lightest, *heaviest};
}

/// 1 where water fills the space between walls and openings, as find_fullness without the exception of open ends.
/// Collective.
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

/// Whether the weight of water that fills its walls is balanced. The steps of a thick liquid in a conduit follow its
/// weight, which limits the error of the implicit viscous force.
template <int Dim>
bool may_fill_walls(const Flow<Dim>& flow) {
  return flow.setup.liquids.are_several() || (flow.is_open() && !flow.setup.has_implicit_viscosity);
}

/// Whether the weight of water below its free surface is balanced.
template <int Dim>
bool may_have_still_surface(const Flow<Dim>& flow) {
  return flow.setup.formulation.balanced_ramp != nullptr && flow.setup.has_air() && flow.pores == nullptr &&
         !flow.setup.gravity_across().isZero(0.0);
}

/// rho_b [kg/m^3] in water that fills its walls.
template <int Dim>
double density_in_full_walls(const Flow<Dim>& flow) {
  return may_fill_walls(flow) ? flow.state.last_step.fullness * extreme_densities(flow.setup).first : 0.0;
}

/// m along gravity; the lowest place of the surface, less the half spacing of the case that particles beside air are
/// below it; at the start of the range of numbers if there is none. The place of a particle counts as far above it as
/// it is inside water, which changes smoothly with its neighbours. Collective.
template <int Dim>
double lowest_beside_air(const Flow<Dim>& flow, const Vec<Dim>& down) {
  constexpr double none = std::numeric_limits<double>::lowest();
  return flow.setup.ranks.largest(largest_over(flow.state.particles.owned, none, [&](std::size_t i) {
    const double inside = flow.surroundings.interior[i];
    if (flow.role[i] != Role::water || inside >= 1.0) return none;
    const double rows_above = std::pow(inside / (1.0 - inside), 2);
    const double relative = flow.pairs().relative_spacing_of(i);
    const double rows = relative * rows_above - (1.0 - relative) * rows_beside_air;
    return down.dot(flow.state.particles.position[i]) - rows * flow.setup.scale.spacing;
  }));
}

/// Largest value(i) of the fluid, at least `least`. Collective.
template <int Dim, class Value>
double largest_in_fluid(const Flow<Dim>& flow, double least, Value&& value) {
  const Particles<Dim>& particles = flow.state.particles;
  return flow.setup.ranks.largest(
      largest_over(particles.owned, least, [&](std::size_t i) { return particles.is_fluid(i) ? value(i) : least; }));
}

/// 0 where no water is deeper below the level than two rows, 1 where some is deeper than four rows. Thin water, and a
/// free surface that faces down, do not have the neighbours below them that q is for. Collective.
template <int Dim>
double share_by_depth(const Flow<Dim>& flow, const Vec<Dim>& down) {
  constexpr double none = std::numeric_limits<double>::lowest();
  const double deepest =
      largest_in_fluid(flow, none, [&](std::size_t i) { return down.dot(flow.state.particles.position[i]); });
  const double depth = deepest - flow.state.last_step.lowest_unbalanced;
  return std::clamp(0.5 * (depth / flow.setup.scale.spacing + rows_beside_air) - 1.0, 0.0, 1.0);
}

/// The largest fraction of q, at most 1, that leaves no fluid with p < q by more than that fraction of the weight of
/// half a row. Collective.
template <int Dim>
double share_without_tension(const Flow<Dim>& flow, const BalancedPressure<Dim>& balanced,
                             const std::vector<double>& pressure) {
  const double half_row =
      0.5 * flow.setup.scale.spacing * extreme_densities(flow.setup).first * flow.setup.gravity_across().norm();
  return -largest_in_fluid(flow, -1.0, [&](std::size_t i) {
    const double excess = balanced.at(flow.state.particles.position[i]) - half_row;
    return excess > 0.0 ? -std::max(0.0, pressure[i] / excess) : -1.0;
  });
}

/// The largest p - q over the largest p, at most 1. Collective.
template <int Dim>
double largest_unbalanced_share(const Flow<Dim>& flow, const BalancedPressure<Dim>& balanced,
                                const std::vector<double>& pressure) {
  const std::vector<Vec<Dim>>& position = flow.state.particles.position;
  const double largest = largest_in_fluid(flow, 0.0, [&](std::size_t i) { return pressure[i]; });
  const double rest =
      largest_in_fluid(flow, 0.0, [&](std::size_t i) { return pressure[i] - balanced.at(position[i]); });
  return largest > 0.0 ? std::min(1.0, rest / largest) : 1.0;
}

/// m^2/s; where the pairs have this fraction of the pressure.
template <int Dim>
double noise_viscosity_with(const Flow<Dim>& flow, double speed, double unbalanced_share) {
  const double of_noise = time_step_rule(flow).reference_speed * std::sqrt(unbalanced_share);
  return flow.setup.formulation.noise_viscosity * flow.setup.scale.spacing * std::max(speed, of_noise);
}

}  // namespace

template <int Dim>
double find_fullness(const Flow<Dim>& flow) {
  return flow.is_open() ? 0.0 : find_fullness_between_openings(flow);
}

template <int Dim>
void find_balance(Flow<Dim>& flow, bool is_start) {
  StepMemory& memory = flow.state.last_step;
  memory.fullness = may_fill_walls(flow) ? find_fullness_between_openings(flow) : 0.0;
  memory.balanced_share = 0.0;
  memory.unbalanced_share = 1.0;
  if (memory.fullness > 0.0 || !may_have_still_surface(flow)) return;
  const Vec<Dim> down = flow.setup.gravity_across().normalized();
  memory.lowest_beside_air = lowest_beside_air(flow, down);
  if (memory.lowest_beside_air == std::numeric_limits<double>::lowest()) return;
  memory.lowest_unbalanced = memory.lowest_beside_air;
  for (const auto& part : flow.parts) {
    memory.lowest_unbalanced = std::max(memory.lowest_unbalanced, part->lowest_unbalanced(flow, down));
  }
  const double by_depth = share_by_depth(flow, down);
  if (is_start || by_depth == 0.0) {
    memory.balanced_share = by_depth;
    return;
  }
  std::vector<double> pressure = flow.state.particles.pressure;
  for (const auto& part : flow.parts) part->subtract_pressure(std::span(pressure).first(flow.state.particles.owned));
  memory.balanced_share = 1.0;
  memory.balanced_share = std::min(by_depth, share_without_tension(flow, BalancedPressure<Dim>(flow), pressure));
  memory.unbalanced_share = largest_unbalanced_share(flow, BalancedPressure<Dim>(flow), pressure);
}

template <int Dim>
BalancedPressure<Dim>::BalancedPressure(const Flow<Dim>& flow, Extent extent) {
  const StepMemory& memory = flow.state.last_step;
  const Vec<Dim> across = flow.setup.gravity_across();
  const double in_full_walls = density_in_full_walls(flow);
  if (in_full_walls > 0.0) {
    gradient_ = in_full_walls * across;
  } else if (memory.balanced_share > 0.0) {
    gradient_ = memory.balanced_share * extreme_densities(flow.setup).first * across;
    ramp_ = flow.setup.formulation.balanced_ramp.get();
    down_ = across.normalized();
    const double lowest = extent == Extent::all_water ? memory.lowest_beside_air : memory.lowest_unbalanced;
    level_ = lowest - rows_beside_air * flow.setup.scale.spacing;
  }
}

template <int Dim>
double BalancedPressure<Dim>::at(const Vec<Dim>& x) const {
  return is_linear() ? gradient_.dot(x) : below_level(depth_of(x));
}

template <int Dim>
double BalancedPressure<Dim>::on_wall(const Vec<Dim>& x, const Vec<Dim>& normal) const {
  if (is_linear()) return at(x);
  const double level_share = std::pow(down_.dot(normal), 2);
  return std::lerp(at(x), gradient_.norm() * ramp_->on_level_wall(depth_of(x)), level_share);
}

template <int Dim>
double BalancedPressure<Dim>::below_level(double depth) const {
  return gradient_.norm() * ramp_->at(depth);
}

template <int Dim>
std::vector<double> BalancedPressure<Dim>::at_each(const std::vector<Vec<Dim>>& places) const {
  std::vector<double> q(places.size());
  for_each(q.size(), [&](std::size_t i) { q[i] = at(places[i]); });
  return q;
}

template <int Dim>
Vec<Dim> BalancedPressure<Dim>::gradient_at(const Vec<Dim>& x) const {
  return is_linear() ? gradient_ : Vec<Dim>(ramp_->gradient_at(depth_of(x)) * gradient_);
}

template <int Dim>
double BalancedPressure<Dim>::morris_sum_at(const Vec<Dim>& x) const {
  return is_linear() ? 0.0 : gradient_.norm() * ramp_->morris_sum_at(depth_of(x));
}

template <int Dim>
std::vector<double> balanced_pressure(const Flow<Dim>& flow, const std::vector<double>& pressure) {
  const BalancedPressure<Dim> balanced(flow);
  if (!balanced.is_any()) return {};
  std::vector<double> q = balanced.at_each(flow.state.particles.position);
  if (!balanced.is_linear()) return q;
  constexpr double none = std::numeric_limits<double>::lowest();
  const double least = -largest_in_fluid(flow, none, [&](std::size_t i) { return q[i] - pressure[i]; });
  for_each(q.size(), [&](std::size_t i) { q[i] += least; });
  return q;
}

template <int Dim>
void find_pressure_gradient(const Flow<Dim>& flow, const std::vector<double>& pressure, std::span<Vec<Dim>> gradient) {
  const std::vector<double> q = balanced_pressure(flow, pressure);
  if (q.empty()) return flow.discretisation().find_gradient(flow, pressure, gradient);
  const BalancedPressure<Dim> balanced(flow);
  const std::vector<Vec<Dim>>& position = flow.state.particles.position;
  const std::vector<std::size_t> water =
      indices_where(flow.state.particles.owned, [&](std::size_t i) { return flow.role[i] == Role::water; });
  const Interfaces& interfaces = flow.surroundings.interfaces;
  if (!interfaces.are_any()) {
    std::vector<double> rest(pressure.size());
    for_each(rest.size(), [&](std::size_t i) { rest[i] = pressure[i] - q[i]; });
    flow.discretisation().find_gradient(flow, rest, gradient);
    for_each(water.size(), [&](std::size_t n) { gradient[water[n]] += balanced.gradient_at(position[water[n]]); });
    return;
  }
  flow.discretisation().find_gradient(flow, pressure, gradient);
  std::vector<Vec<Dim>> of_pairs(water.size());
  flow.discretisation().find_gradient_at(flow, water, q, of_pairs);
  for_each(water.size(), [&](std::size_t n) {
    const std::size_t i = water[n];
    gradient[i] += (balanced.gradient_at(position[i]) - of_pairs[n]) / interfaces.density[i];
  });
}

template <int Dim>
TimeStepRule time_step_rule(const Flow<Dim>& flow) {
  TimeStepRule rule = flow.setup.time_step_rule;
  const double balanced = density_in_full_walls(flow);
  if (balanced == 0.0) return rule;
  const double reduced = extreme_densities(flow.setup).second / balanced - 1.0;
  rule.reference_speed *= std::sqrt(std::clamp(reduced, min_reduced_gravity, 1.0));
  return rule;
}

template <int Dim>
double noise_viscosity(const Flow<Dim>& flow, double speed) {
  return noise_viscosity_with(flow, speed, flow.state.last_step.unbalanced_share);
}

template <int Dim>
double largest_noise_viscosity(const Flow<Dim>& flow, double speed) {
  return flow.setup.graded == nullptr ? noise_viscosity(flow, speed) : noise_viscosity_with(flow, speed, 1.0);
}

template class BalancedPressure<2>;
template class BalancedPressure<3>;
TAILWATER_IN_2D_AND_3D(find_fullness);
TAILWATER_IN_2D_AND_3D(find_balance);
TAILWATER_IN_2D_AND_3D(balanced_pressure);
TAILWATER_IN_2D_AND_3D(find_pressure_gradient);
TAILWATER_IN_2D_AND_3D(time_step_rule);
TAILWATER_IN_2D_AND_3D(noise_viscosity);
TAILWATER_IN_2D_AND_3D(largest_noise_viscosity);

}  // namespace tailwater
