#include <cmath>
#include <cstdint>

#include "base/for_each.h"
#include "pressure/suction.h"
#include "pressure/verbs.h"

namespace tailwater {
namespace {

/// Exponent of the solver's tolerance in that of the rough solve: rows whose rough pressure is within it of 0 may be
/// told wrongly, and are cut.
constexpr double roughness = 0.6;

/// Whether particle i pulls and may not with all of it.
template <int Dim>
bool pulls(const Flow<Dim>& flow, std::size_t i) {
  return flow.state.particles.pressure[i] < 0.0 && suction_share(flow, i) < 1.0;
}

/// Limits suction in the equation where the present pressure asks for it. Returns 1 for each row held, by owned
/// particle.
template <int Dim>
std::vector<std::uint8_t> hold_suction(Flow<Dim>& flow) {
  Particles<Dim>& particles = flow.state.particles;
  std::vector<std::uint8_t> is_held(particles.owned, 0);
  for_each(particles.owned, [&](std::size_t i) {
    if (!pulls(flow, i)) return;
    const double share = suction_share(flow, i);
    flow.pressure_rows.divide_diagonal(i, share);
    particles.pressure[i] *= share;
    is_held[i] = 1;
  });
  return is_held;
}

/// Cuts what pulls all the same in rows that are not held. Returns how many.
template <int Dim>
std::size_t cut_suction(Flow<Dim>& flow, const std::vector<std::uint8_t>& is_held) {
  Particles<Dim>& particles = flow.state.particles;
  return count_each(particles.owned, [&](std::size_t i) {
    if (is_held[i] || !particles.is_fluid(i) || !pulls(flow, i)) return false;  // walls follow the fluid
    particles.pressure[i] *= suction_share(flow, i);
    return true;
  });
}

PressureReport report_of(const SolveReport& solved) {
  PressureReport report{.iterations = solved.iterations, .residual = solved.residual, .interventions = {}};
  report.interventions.restarted_solves = solved.restarts;
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
PressureReport solve(Flow<Dim>& flow, const WallDrive<Dim>& drive, const PosedEquation& equation) {
  KrylovSolver& solver = flow.pressure_solver;
  const std::span<double> pressure = std::span(flow.state.particles.pressure).first(flow.state.particles.owned);
  PressureReport report;
  if (flow.setup.has_air()) {
    // Only to tell where water near the surface would pull; and it is the guess of the second solve.
    const PressureReport rough =
        report_of(solver.solve(flow.pressure_rows, pressure, std::pow(solver.tolerance(), roughness)));
    const std::vector<std::uint8_t> is_held = hold_suction(flow);
    report = report_of(solver.solve(flow.pressure_rows, pressure));
    report.iterations += rough.iterations;
    report.interventions += rough.interventions;
    report.interventions.clamped_pressures = cut_suction(flow, is_held);
  } else {
    report = report_of(solver.solve(flow.pressure_rows, pressure));
  }
  report.interventions.fallback_rows = equation.fallback_rows;
  finish_pressure(flow, drive);
  return report;
}

template void finish_pressure<2>(Flow<2>&, const WallDrive<2>&);
template void finish_pressure<3>(Flow<3>&, const WallDrive<3>&);
template PressureReport solve<2>(Flow<2>&, const WallDrive<2>&, const PosedEquation&);
template PressureReport solve<3>(Flow<3>&, const WallDrive<3>&, const PosedEquation&);

}  // namespace tailwater
