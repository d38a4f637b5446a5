#include "base/for_each.h"
#include "pressure/floating_bodies.h"
#include "pressure/suction.h"
#include "pressure/tolerance.h"
#include "pressure/verbs.h"

namespace tailwater {
namespace {

/// Whether particle i pulls and may not with all of it.
template <int Dim>
bool pulls(const Flow<Dim>& flow, std::size_t i) {
  return flow.state.particles.pressure[i] < 0.0 && suction_share(flow, i) < 1.0;
}

/// Limits suction in the equation where the present pressure asks for it.
template <int Dim>
void hold_suction(Flow<Dim>& flow) {
  Particles<Dim>& particles = flow.state.particles;
  for_each(particles.owned, [&](std::size_t i) {
    if (!pulls(flow, i)) return;
    const double share = suction_share(flow, i);
    flow.pressure_rows.divide_diagonal(i, share);
    particles.pressure[i] *= share;
  });
}

PressureReport report_of(const SolveReport& solved) {
  PressureReport report{.iterations = solved.iterations, .residual = solved.residual, .interventions = {}};
  report.interventions.restarted_solves = solved.restarts;
  return report;
}

template <int Dim>
PressureReport find_pressure(Flow<Dim>& flow, const StepStart<Dim>& start, double dt, WallDrive<Dim>& drive) {
  const double tolerance = flow.pressure_solver.tolerance();
  Particles<Dim>& particles = flow.state.particles;
  // The guess is what this projection found last.
  for_each(particles.owned, [&](std::size_t i) { particles.pressure[i] -= particles.second_pressure[i]; });
  BodyCoupling<Dim> coupling(flow, start, dt, drive);
  PressureReport report;
  if (flow.setup.has_air()) {
    // Only to tell where water near the surface would pull; and it is the guess of the second solve.
    const PressureReport rough = report_of(coupling.solve_roughly(rough_tolerance(tolerance)));
    hold_suction(flow);
    report = report_of(coupling.solve(tolerance));
    report.iterations += rough.iterations;
    report.interventions += rough.interventions;
  } else {
    report = report_of(coupling.solve(tolerance));
  }
  coupling.carry_over();
  flow.forget_matrix();
  return report;
}

}  // namespace

template <int Dim>
void finish_pressure(Flow<Dim>& flow, const WallDrive<Dim>& drive) {
  std::vector<double>& pressure = flow.state.particles.pressure;
  flow.halo().exchange(pressure);
  if (!flow.setup.has_air()) return;
  if (flow.setup.wall_model->follow_pressure(flow.wall_scene(), flow.wall_force(drive.acceleration), pressure)) {
    flow.halo().exchange(pressure);
  }
}

template <int Dim>
PressureReport solve(Flow<Dim>& flow, const StepStart<Dim>& start, const PosedEquation& equation, double dt,
                     WallDrive<Dim>& drive) {
  PressureReport report = find_pressure(flow, start, dt, drive);
  report.interventions.fallback_rows = equation.fallback_rows;
  finish_pressure(flow, drive);
  return report;
}

template void finish_pressure<2>(Flow<2>&, const WallDrive<2>&);
template void finish_pressure<3>(Flow<3>&, const WallDrive<3>&);
template PressureReport solve<2>(Flow<2>&, const StepStart<2>&, const PosedEquation&, double, WallDrive<2>&);
template PressureReport solve<3>(Flow<3>&, const StepStart<3>&, const PosedEquation&, double, WallDrive<3>&);

}  // namespace tailwater
