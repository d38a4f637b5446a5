#include <cmath>

#include "base/for_each.h"
#include "pressure/full_water.h"
#include "pressure/pockets.h"
#include "pressure/solve_rows.h"
#include "pressure/stages.h"
#include "pressure/suction.h"
#include "pressure/tolerance.h"

namespace tailwater {
namespace {

/// Whether particle i pulls and may not with all of it.
template <int Dim>
bool pulls(const Flow<Dim>& flow, std::size_t i) {
  return flow.state.particles.pressure[i] < -allowed_tension(flow, i) && suction_share(flow, i) < 1.0;
}

/// Limits suction in the equation where the present pressure asks for it.
template <int Dim>
void hold_suction(Flow<Dim>& flow) {
  Particles<Dim>& particles = flow.state.particles;
  for_each(particles.owned, [&](std::size_t i) {
    if (!pulls(flow, i)) return;
    const double share = suction_share(flow, i);
    const double least = -allowed_tension(flow, i);
    flow.pressure_rows.divide_diagonal(i, share, least);
    particles.pressure[i] = std::lerp(least, particles.pressure[i], share);
  });
}

}  // namespace

template <int Dim>
void finish_pressure(Flow<Dim>& flow, const WallDrive<Dim>& drive) {
  std::vector<double>& pressure = flow.state.particles.pressure;
  flow.halo().exchange(pressure);
  if (!flow.setup.has_air()) return;
  const std::vector<double>& drop = flow.sides.response_deficit;  // walls may pull by as much, too
  for_each(drop.size(), [&](std::size_t i) { pressure[i] += drop[i]; });
  const bool has_followed =
      flow.wall_model().follow_pressure(flow.wall_scene(), flow.wall_force(drive.acceleration), pressure);
  for_each(drop.size(), [&](std::size_t i) { pressure[i] -= drop[i]; });
  if (has_followed) flow.halo().exchange(pressure);
}

template <int Dim>
PressureReport solve(Flow<Dim>& flow, const PosedEquation& equation, const WallDrive<Dim>& drive,
                     const RowSolver& rows) {
  const double tolerance = flow.pressure_solver.tolerance();
  Particles<Dim>& particles = flow.state.particles;
  // The guess is what this projection found last.
  subtract_air(flow);
  for_each(particles.owned, [&](std::size_t i) { particles.pressure[i] -= particles.second_pressure[i]; });
  PressureReport report;
  if (flow.setup.has_air()) {
    // Only to tell where water near the surface would pull; and it is the guess of the second solve.
    const PressureReport rough = report_of(rows.solve_roughly(rough_tolerance(tolerance)));
    shift_minimum_to_zero<Dim>(flow, equation.fullness, {}, particles.pressure);
    hold_suction(flow);
    report = report_of(rows.solve(tolerance));
    shift_minimum_to_zero<Dim>(flow, equation.fullness, {}, particles.pressure);
    report.iterations += rough.iterations;
    report.interventions += rough.interventions;
  } else {
    report = report_of(rows.solve(tolerance));
  }
  flow.forget_matrix();
  report.interventions.fallback_rows = equation.fallback_rows;
  report.iterations += flow.sides.iterations;
  finish_pressure(flow, drive);
  add_air(flow, equation.dt);
  return report;
}

template <int Dim>
PressureReport solve(Flow<Dim>& flow, const PosedEquation& equation, const WallDrive<Dim>& drive) {
  const auto rows = [&](double tolerance) { return solve_rows(flow, flow.state.particles.pressure, tolerance); };
  return solve(flow, equation, drive, RowSolver{rows, rows});
}

#define TAILWATER_INSTANTIATE(Dim)                                                                               \
  template void finish_pressure<Dim>(Flow<Dim>&, const WallDrive<Dim>&);                                         \
  template PressureReport solve<Dim>(Flow<Dim>&, const PosedEquation&, const WallDrive<Dim>&, const RowSolver&); \
  template PressureReport solve<Dim>(Flow<Dim>&, const PosedEquation&, const WallDrive<Dim>&);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
