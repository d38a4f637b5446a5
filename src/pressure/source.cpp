// The pressure equation of a step: its target divergence, and its rows with their sources.
#include <utility>

#include "base/for_each.h"
#include "flow/balanced_pressure.h"
#include "flow/pressure_equation.h"
#include "pressure/full_water.h"
#include "pressure/stages.h"

namespace tailwater {

template <int Dim>
std::vector<double> target_divergence(const Flow<Dim>& flow, std::vector<Mat<Dim>> velocity_gradient, double dt) {
  std::vector<double> target(flow.state.particles.owned, 0.0);
  if (!flow.setup.formulation.is_divergence_free_midway) return target;
  for_each(target.size(), [&](std::size_t i) {
    const Mat<Dim>& gradient = velocity_gradient[i];
    target[i] = 0.5 * dt * (gradient * gradient).trace();
  });
  for (const auto& part : flow.parts) part->change_target(flow, velocity_gradient, dt, target);
  return target;
}

/// The terms that close rows draw the pressure towards 0. Where a pressure balances the weight, they draw it towards
/// this one instead, which moves nothing.
template <int Dim>
void add_closing_of_balanced_pressure(const Flow<Dim>& flow, std::vector<double>& source) {
  const std::vector<double> balanced = balanced_pressure(flow, flow.state.particles.pressure);
  if (balanced.empty()) return;
  const std::vector<std::size_t> water =
      indices_where(flow.state.particles.owned, [&](std::size_t i) { return flow.role[i] == Role::water; });
  std::vector<double> weight(water.size());
  flow.discretisation().find_air_weights(flow, water, weight);
  for_each(water.size(), [&](std::size_t n) { source[water[n]] += weight[n] * balanced[water[n]]; });
}

template <int Dim>
PosedEquation assemble(Flow<Dim>& flow, const Prediction<Dim>& predicted, std::span<const double> target,
                       const WallDrive<Dim>& drive, double dt) {
  PressureSource source = flow.discretisation().find_source(flow, predicted.velocity, target, dt);
  PosedEquation equation;
  equation.dt = dt;
  equation.fullness = find_fullness(flow);
  take_out_mean(flow, equation.fullness, source.rows);
  take_out_mean(flow, equation.fullness, source.density);
  equation.density_source = std::move(source.density);
  equation.fallback_rows = assemble_weights(flow, drive);
  add_closing_of_balanced_pressure(flow, source.rows);
  const std::vector<double>& beside = equation.density_source;
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (!is_solved_for(flow.role[i])) return;
    flow.equation->rows.set_rhs(i, source.rows[i] + (beside.empty() ? 0.0 : beside[i]));
  });
  for (const auto& part : flow.parts) equation.iterations += part->pose(flow, predicted.velocity, dt);
  return equation;
}

TAILWATER_IN_2D_AND_3D(target_divergence);
TAILWATER_IN_2D_AND_3D(assemble);

}  // namespace tailwater
