#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/for_each.h"
#include "schemes/verbs.h"
#include "schemes/wall_state.h"

namespace tailwater {
namespace {

/// Exponent of the solver's tolerance in that of the rough solve: rows whose rough pressure is within it of 0 may be
/// told wrongly, and are cut.
constexpr double roughness = 0.6;

/// Whether particle i pulls and may not with all of it.
template <int Dim>
bool pulls(const Flow<Dim>& flow, std::size_t i) {
  return flow.particles.pressure[i] < 0.0 && suction_share(flow, i) < 1.0;
}

/// Limits suction in the equation where the present pressure asks for it. Returns 1 for each row held, by owned
/// particle.
template <int Dim>
std::vector<std::uint8_t> hold_suction(Flow<Dim>& flow) {
  std::vector<std::uint8_t> is_held(flow.particles.owned, 0);
  for_each(flow.particles.owned, [&](std::size_t i) {
    if (!pulls(flow, i)) return;
    const double share = suction_share(flow, i);
    flow.pressure_system.divide_diagonal(i, share);
    flow.particles.pressure[i] *= share;
    is_held[i] = 1;
  });
  return is_held;
}

/// Cuts what pulls all the same in rows that are not held. Returns how many.
template <int Dim>
std::size_t cut_suction(Flow<Dim>& flow, const std::vector<std::uint8_t>& is_held) {
  return count_each(flow.particles.owned, [&](std::size_t i) {
    if (is_held[i] || !flow.particles.is_fluid(i) || !pulls(flow, i)) return false;  // dummies follow the fluid
    flow.particles.pressure[i] *= suction_share(flow, i);
    return true;
  });
}

/// Dummies again from the clamped fluid, and never below 0.
template <int Dim>
void refresh_dummies(Flow<Dim>& flow) {
  const Pairs<Dim>& pairs = flow.pairs();
  std::vector<double>& pressure = flow.particles.pressure;
  for_each(flow.particles.owned, [&](std::size_t i) {
    if (flow.particles.is_fluid(i) || !flow.is_wet[i]) return;
    double sum = 0.0;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      if (!flow.particles.is_fluid(pairs.j[k])) continue;
      sum += pairs.W[k] * (pressure[pairs.j[k]] + hydrostatic_difference(flow, i, k));
    }
    pressure[i] = std::max(0.0, sum / flow.wall_fluid_weight[i]);
  });
}

}  // namespace

template <int Dim>
void finish_pressure(Flow<Dim>& flow) {
  std::vector<double>& pressure = flow.particles.pressure;
  const Halo<Dim>& halo = flow.neighbourhood.halo();
  halo.exchange(pressure);
  if (!has_air(flow) || flow.walls.treatment != WallTreatment::dummies) return;
  refresh_dummies(flow);
  halo.exchange(pressure);
}

template <int Dim>
SolveReport solve(Flow<Dim>& flow, Interventions& interventions) {
  PressureSystem& system = flow.pressure_system;
  const std::span<double> pressure = std::span(flow.particles.pressure).first(flow.particles.owned);
  SolveReport rough;
  std::vector<std::uint8_t> is_held;
  if (has_air(flow)) {
    // Only to tell where water near the surface would pull; and it is the guess of the second solve.
    const double rough_tolerance = std::pow(system.tolerance(), roughness);
    rough = system.solve(pressure, rough_tolerance);
    is_held = hold_suction(flow);
  }
  SolveReport report = system.solve(pressure);
  report.iterations += rough.iterations;
  interventions.restarted_solves += rough.restarts + report.restarts;
  if (has_air(flow)) interventions.clamped_pressures += cut_suction(flow, is_held);
  finish_pressure(flow);
  return report;
}

template void finish_pressure<2>(Flow<2>&);
template void finish_pressure<3>(Flow<3>&);
template SolveReport solve<2>(Flow<2>&, Interventions&);
template SolveReport solve<3>(Flow<3>&, Interventions&);

}  // namespace tailwater
