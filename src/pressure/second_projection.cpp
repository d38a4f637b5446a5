// A second projection of the present velocity, at the present positions of the particles: no gravity, no target, no
// density source. It is done once. The remaining divergence comes from the errors of the pair of divergence and
// gradient in a disordered set. Removing it too would harm pressure and velocity more than it improves them
// (docs/theory/robustness.md).
#include <cmath>

#include "base/for_each.h"
#include "flow/pressure_equation.h"
#include "neighbours/halo.h"
#include "pressure/full_water.h"
#include "pressure/operators.h"
#include "pressure/solve_rows.h"
#include "pressure/stages.h"
#include "pressure/tension.h"
#include "pressure/tolerance.h"

namespace tailwater {
namespace {

/// Limits `correction` so that the corrected pressure keeps only the tension that tension.h allows. Near the surface
/// nothing holds the particles together, and tension would do work (docs/theory/robustness.md).
template <int Dim>
void limit_correction(const Flow<Dim>& flow, const std::vector<double>& allowed, std::vector<double>& correction) {
  if (!flow.setup.has_air()) return;
  const std::vector<double>& pressure = flow.state.particles.pressure;
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    const double sum = pressure[i] + correction[i];
    const double share = tension_share(flow, i);
    const double least = min_pressure(flow, allowed, i);
    if (sum < least && share < 1.0) correction[i] = std::lerp(least, sum, share) - pressure[i];
  });
}

}  // namespace

template <int Dim>
SecondProjection reproject(Flow<Dim>& flow, const WallDrive<Dim>& drive, double dt) {
  const double density = flow.setup.liquid.density;
  Particles<Dim>& particles = flow.state.particles;
  for (const auto& part : flow.parts) part->begin_projection(flow, Projection::again, dt);
  const std::size_t fallback_rows = assemble_weights(flow, drive);
  set_wall_velocities<Dim>(flow, flow.state.wall_velocity, particles.velocity);
  std::vector<double> source(particles.owned, 0.0);
  flow.discretisation().find_divergence(flow, particles.velocity, source);
  for_each(particles.owned,
           [&](std::size_t i) { source[i] = flow.role[i] == Role::water ? -density / dt * source[i] : 0.0; });
  const double fullness = find_fullness(flow);
  take_out_mean(flow, fullness, source);
  for_each(particles.owned, [&](std::size_t i) { flow.equation->rows.set_rhs(i, source[i]); });
  SecondProjection second;
  second.report =
      report_of(solve_rows(flow, particles.second_pressure, rough_tolerance(flow.equation->solver.tolerance())));
  second.report.interventions.fallback_rows = fallback_rows;
  flow.equation->has_matrix = flow.keeps_matrix();
  if (!flow.equation->has_matrix) flow.equation->forget_matrix();
  std::vector<double>& correction = second.correction;
  correction = particles.second_pressure;
  const std::vector<double> allowed = allowed_tension(flow);
  for (const auto& part : flow.parts) {
    part->subtract_pressure(std::span(particles.pressure).first(particles.owned));
  }
  shift_minimum_to_zero<Dim>(flow, fullness, particles.pressure, correction);
  limit_correction(flow, allowed, correction);
  flow.halo().exchange(correction);
  std::vector<Vec<Dim>> gradient(particles.owned);
  flow.discretisation().find_gradient(flow, correction, gradient);
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    if (flow.role[i] == Role::water) particles.velocity[i] -= dt / density * gradient[i];
    particles.pressure[i] += correction[i];
  });
  add_wall_forces(flow, correction);
  finish_pressure(flow, drive, allowed);
  add_pressure_of_parts(flow);
  return second;
}

TAILWATER_IN_2D_AND_3D(reproject);

}  // namespace tailwater
