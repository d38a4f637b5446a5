#include <cmath>

#include "base/assert.h"
#include "base/for_each.h"
#include "flow/pressure_equation.h"
#include "neighbours/halo.h"
#include "pressure/full_water.h"
#include "pressure/solve_rows.h"
#include "pressure/stages.h"
#include "pressure/tension.h"
#include "pressure/tolerance.h"
#include "walls/wall_model.h"

namespace tailwater {
namespace {

/// The pressure rows where no other unknowns are solved for.
template <int Dim>
class RowsAlone final : public CoupledUnknowns {
 public:
  explicit RowsAlone(Flow<Dim>& flow) : flow_(flow) {}
  SolveReport solve_roughly(double tolerance) override { return solve(tolerance); }
  SolveReport solve(double tolerance) override { return solve_rows(flow_, flow_.state.particles.pressure, tolerance); }

 private:
  Flow<Dim>& flow_;
};

template <int Dim>
std::unique_ptr<CoupledUnknowns> couple(Flow<Dim>& flow, const PosedEquation& equation, WallDrive<Dim>& drive) {
  for (const auto& part : flow.parts) {
    if (std::unique_ptr<CoupledUnknowns> unknowns = part->couple(flow, equation, drive)) return unknowns;
  }
  return std::make_unique<RowsAlone<Dim>>(flow);
}

/// The last pressure of this projection, without the contributions of parts and a second projection.
template <int Dim>
std::vector<double> guess(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<double> pressure = particles.pressure;
  for (const auto& part : flow.parts) part->subtract_pressure(std::span(pressure).first(particles.owned));
  for_each(particles.owned, [&](std::size_t i) { pressure[i] -= particles.second_pressure[i]; });
  return pressure;
}

/// Limits tension in the equation where a rough pressure exceeds the allowed one. Returns the guess of the solution of
/// the limited equation.
template <int Dim>
std::vector<double> limit_tension(Flow<Dim>& flow, const std::vector<double>& allowed, std::vector<double> rough) {
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    const double share = tension_share(flow, i);
    const double least = min_pressure(flow, allowed, i);
    if (rough[i] >= least || share >= 1.0) return;
    flow.equation->rows.divide_diagonal(i, share, least);
    rough[i] = std::lerp(least, rough[i], share);
  });
  return rough;
}

}  // namespace

template <int Dim>
void finish_pressure(Flow<Dim>& flow, const WallDrive<Dim>& drive, const std::vector<double>& allowed) {
  std::vector<double>& pressure = flow.state.particles.pressure;
  flow.walls.acceleration = drive.acceleration;
  flow.halo().exchange(pressure);
  if (!flow.setup.has_air()) return;
  TAILWATER_ASSERT(allowed.empty() || allowed.size() == pressure.size(), "each present particle has its tension");
  for_each(allowed.size(), [&](std::size_t i) { pressure[i] += allowed[i]; });  // walls may keep as much tension, too
  const bool has_followed =
      flow.wall_model().follow_pressure(flow.wall_scene(), flow.wall_force(drive.acceleration), pressure);
  for_each(allowed.size(), [&](std::size_t i) { pressure[i] -= allowed[i]; });
  if (has_followed) flow.halo().exchange(pressure);
}

template <int Dim>
void add_pressure_of_parts(Flow<Dim>& flow) {
  std::vector<double>& pressure = flow.state.particles.pressure;
  bool some_added = false;
  for (const auto& part : flow.parts) {
    some_added = part->add_pressure(std::span(pressure).first(flow.state.particles.owned)) || some_added;
  }
  if (some_added) flow.halo().exchange(pressure);
}

template <int Dim>
PressureReport solve(Flow<Dim>& flow, const PosedEquation& equation, WallDrive<Dim>& drive) {
  const double tolerance = flow.equation->solver.tolerance();
  std::vector<double>& pressure = flow.state.particles.pressure;
  const std::unique_ptr<CoupledUnknowns> unknowns = couple(flow, equation, drive);
  const std::vector<double> allowed = allowed_tension(flow);
  PressureReport rough;
  pressure = guess(flow);
  if (flow.setup.has_air()) {
    // Only to find tension of water near the surface; the result is also the guess of the second solve.
    rough = report_of(unknowns->solve_roughly(rough_tolerance(tolerance)));
    shift_minimum_to_zero<Dim>(flow, equation.fullness, {}, pressure);
    for (const auto& part : flow.parts) part->see_tension(flow, pressure, allowed);
    pressure = limit_tension(flow, allowed, std::move(pressure));
  }
  PressureReport report = report_of(unknowns->solve(tolerance));
  if (flow.setup.has_air()) shift_minimum_to_zero<Dim>(flow, equation.fullness, {}, pressure);
  report.iterations += rough.iterations + equation.iterations;
  report.interventions += rough.interventions;
  report.interventions.fallback_rows = equation.fallback_rows;
  flow.equation->forget_matrix();
  finish_pressure(flow, drive, allowed);
  for (const auto& part : flow.parts) part->finish_solve(flow, equation.dt);
  add_pressure_of_parts(flow);
  unknowns->finish();
  return report;
}

TAILWATER_IN_2D_AND_3D(finish_pressure);
TAILWATER_IN_2D_AND_3D(add_pressure_of_parts);
TAILWATER_IN_2D_AND_3D(solve);

}  // namespace tailwater
