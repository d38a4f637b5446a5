// Source of the pressure equation. For fluid particle i
//
//   -(rho/dt) (div u_star - target) + gamma rho (s_i (C/C_0 - 1) + o_i)/dt^2
//
// The first term with a target of 0 is (F15).
//
//   o_i    fraction of the particle behind a wall (wall_contact.h): keeps films, where C/C_0 < 1, in front of walls
//   gamma  fraction of the density error that a step corrects
//   s_i    factor of the correction: for particles too close, the fraction that the energy balance allows
//          (`balance_energy`); for particles too far apart, `pull` times `interior`, which is 0 at the surface
#include <algorithm>

#include "base/for_each.h"
#include "flow/balanced_pressure.h"
#include "flow/stages.h"
#include "neighbours/pair_lanes.h"
#include "operators/laplacian_morris.h"
#include "robust/discretisation.h"

namespace tailwater {
namespace {

/// Factor of the correction where particles are too far apart: particle shifting only ever expands the water, and
/// pulling particles together needs no energy. With 1 the dam break is 0.2 to 0.4 % too light, with 2 at fine spacing
/// 0.1 % too dense.
constexpr double pull = 1.5;

/// Steps in which the correction grows to its full rate in cases with zones of refinement. The volumes of the start do
/// not fit beside borders and beside the walls of zones that move. Corrected at once, they change forces by a quarter.
constexpr double steps_to_full_rate = 10.0;

/// Fraction of the rate of the correction.
template <int Dim>
double share_of_rate(const Flow<Dim>& flow) {
  if (flow.setup.graded == nullptr) return 1.0;
  return std::min(1.0, static_cast<double>(flow.state.step) / steps_to_full_rate);
}

/// Source of the density correction, without the divergence; owned particles, Pa/m^2.
template <int Dim>
std::vector<double> find_density_source(const Flow<Dim>& flow, double relaxation, double dt) {
  const Setup<Dim>& setup = flow.setup;
  const std::size_t owned = flow.state.particles.owned;
  const std::vector<double>& concentration = flow.surroundings.concentration;
  std::vector<double> source(owned, 0.0);
  const double unit = setup.liquid.density / (dt * dt);
  std::vector<double> overlap(owned);
  find_wall_overlap<Dim>(flow.pairs(), flow.walls.boundary, setup.scale.spacing, flow.state.particles, overlap);
  const double lift = flow.state.last_step.density_share;
  const double courant = time_step_rule(flow).limiting_speed(largest_speed(flow)) * dt / setup.scale.spacing;
  const double share = relaxation * share_of_rate(flow) * courant;
  for_each(owned, [&](std::size_t i) {
    const double error = concentration[i] - 1.0;
    const double answered = (error < 0.0 ? pull * flow.surroundings.interior[i] : lift) * error + overlap[i];
    source[i] = share / flow.pairs().relative_spacing_of(i) * unit * answered;
  });
  return source;
}

/// Adds to the sources of the pressure the error that the sum of Morris weights has for the balanced pressure
/// (flow/balanced_pressure.h) because the particles are disordered, so that it balances the weight among any particles.
template <int Dim>
void add_error_of_balanced_pressure(const Flow<Dim>& flow, std::span<double> source) {
  const BalancedPressure<Dim> balanced(flow);
  if (!balanced.is_any()) return;
  const double spacing = flow.setup.scale.spacing;
  const std::vector<double> q = balanced_pressure(flow, flow.state.particles.pressure);
  for_each(source.size(), [&](std::size_t i) {
    if (flow.role[i] != Role::water) return;
    LaneSum sum;
    const Lanes own = in_all_lanes(q[i]);
    for_each_pair(flow.pairs(), i, [&](const auto& batch) {
      const PlaceLanes<Dim> place = batch.place();
      const Lanes share = share_of_morris_weight(batch.squared_over_spacing(place.d.dot(place.d)), spacing);
      sum += (2.0F * share * place.volume() * batch.F(place.d)) * (own - batch.of(q));
    });
    source[i] += sum.total() - balanced.morris_sum_at(flow.state.particles.position[i]);
  });
}

}  // namespace

template <int Dim>
PressureSource RobustDiscretisation<Dim>::find_source(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                                                      std::span<const double> target, double dt) const {
  const std::size_t owned = flow.state.particles.owned;
  PressureSource source{std::vector<double>(owned, 0.0), find_density_source(flow, laws_.density_relaxation, dt)};
  find_divergence(flow, velocity, source.rows);
  const double unit = flow.setup.liquid.density / dt;
  for_each(owned, [&](std::size_t i) {
    if (flow.role[i] == Role::water) source.rows[i] = -unit * (source.rows[i] - target[i]);
  });
  add_error_of_balanced_pressure<Dim>(flow, source.rows);
  return source;
}

#define TAILWATER_INSTANTIATE(Dim)                                                                            \
  template PressureSource RobustDiscretisation<Dim>::find_source(const Flow<Dim>&, std::span<const Vec<Dim>>, \
                                                                 std::span<const double>, double) const;
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
