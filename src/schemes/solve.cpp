#include <algorithm>

#include "base/for_each.h"
#include "schemes/verbs.h"
#include "schemes/wall_state.h"

namespace tailwater {
namespace {

/// Suction only where the fluid is whole: a negative pressure is cut to its share `interior`, 0 in the outermost rows,
/// where nothing holds the particles together (docs/theory/robustness.md), all of it inside. Returns how many were cut.
template <int Dim>
std::size_t limit_suction(Flow<Dim>& flow) {
  return count_each(flow.particles.owned, [&](std::size_t i) {
    if (!flow.particles.is_fluid(i) || flow.interior[i] == 1.0 || flow.particles.pressure[i] >= 0.0) return false;
    flow.particles.pressure[i] *= flow.interior[i];
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
void finish_pressure(Flow<Dim>& flow, Interventions& interventions) {
  std::vector<double>& pressure = flow.particles.pressure;
  const Halo<Dim>& halo = flow.neighbourhood.halo();
  if (flow.scheme.surface == SurfaceTreatment::air && !flow.is_closed) {
    interventions.clamped_pressures += limit_suction(flow);
    halo.exchange(pressure);
    if (flow.walls.treatment == WallTreatment::dummies) refresh_dummies(flow);
  }
  halo.exchange(pressure);
}

template <int Dim>
SolveReport solve(Flow<Dim>& flow, Interventions& interventions) {
  const SolveReport report = flow.pressure_system.solve(std::span(flow.particles.pressure).first(flow.particles.owned));
  finish_pressure(flow, interventions);
  return report;
}

template void finish_pressure<2>(Flow<2>&, Interventions&);
template void finish_pressure<3>(Flow<3>&, Interventions&);
template SolveReport solve<2>(Flow<2>&, Interventions&);
template SolveReport solve<3>(Flow<3>&, Interventions&);

}  // namespace tailwater
