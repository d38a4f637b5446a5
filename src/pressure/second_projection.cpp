// Minimal-residual iteration (Orthomin(1): Vinsome 1976) for D G dp = rho/dt D u. D and G are the scheme's divergence
// and pressure gradient; the pressure equation's matrix is the preconditioner. Steps of length 1, as if the Laplacian
// were D G, diverge: D G exceeds twice the Laplacian in places.
#include <cmath>

#include "base/for_each.h"
#include "pressure/floating_bodies.h"
#include "pressure/operators.h"
#include "pressure/suction.h"
#include "pressure/verbs.h"

namespace tailwater {
namespace {

/// Tolerance of the first correction, which finds the large-scale change due to the move. The later corrections act at
/// the scale of single particles.
constexpr double coarse_tolerance = 0.03;

/// Share of a direction's square that must be left when it has been made orthogonal to the last one. Less is rounding,
/// which the length that suits it would multiply by more than a million: momentum would no longer be kept.
constexpr double least_new_share = 1e-12;

/// One correction of the pressure and its effect. Only owned entries count.
template <int Dim>
struct Correction {
  std::vector<double> pressure;    ///< dp, Pa
  std::vector<Vec<Dim>> velocity;  ///< -dt/rho grad dp, m/s
  std::vector<double> source;      ///< rho/dt div of that velocity, Pa/m^2

  void resize(std::size_t count) {
    pressure.resize(count, 0.0);
    velocity.resize(count, Vec<Dim>::Zero());
    source.resize(count, 0.0);
  }
};

/// Dot product of two sources over all ranks. Ghosts add nothing: their entries are 0.
double dot(const Communicator& ranks, const std::vector<double>& a, const std::vector<double>& b) {
  return ranks.sum(sum_over(a.size(), 0.0, [&](std::size_t i) { return a[i] * b[i]; }));
}

/// Sets velocity and source of `correction` from its pressure.
template <int Dim>
void follow(const Flow<Dim>& flow, double dt, const std::vector<Vec<Dim>>& walls_at_rest, Correction<Dim>& correction) {
  const Particles<Dim>& particles = flow.state.particles;
  flow.halo().exchange(correction.pressure);
  for_each(particles.owned, [&](std::size_t i) {
    if (flow.is_solved_for(i)) {
      correction.velocity[i] = -dt / flow.setup.density * gradient_at(flow, i, correction.pressure);
    }
  });
  show_walls<Dim>(flow, walls_at_rest, correction.velocity);
  for_each(particles.owned, [&](std::size_t i) {
    if (flow.is_solved_for(i)) {
      correction.source[i] = flow.setup.density / dt * divergence_at(flow, i, correction.velocity);
    }
  });
}

/// Limits `correction` so that the corrected pressure keeps only the share of a suction that suction.h allows. Near the
/// surface nothing holds the particles together, and suction would do work (docs/theory/robustness.md).
template <int Dim>
void admit(const Flow<Dim>& flow, std::vector<double>& correction) {
  if (!flow.setup.has_air()) return;
  const std::vector<double>& pressure = flow.state.particles.pressure;
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    const double sum = pressure[i] + correction[i];
    const double share = suction_share(flow, i);
    if (sum < 0.0 && share < 1.0) correction[i] = share * sum - pressure[i];
  });
}

/// y <- y + factor x
template <int Dim>
void add(double factor, const Correction<Dim>& x, Correction<Dim>& y) {
  for_each(y.source.size(), [&](std::size_t i) {
    y.pressure[i] += factor * x.pressure[i];
    y.velocity[i] += factor * x.velocity[i];
    y.source[i] += factor * x.source[i];
  });
}

}  // namespace

template <int Dim>
PressureReport reproject(Flow<Dim>& flow, const WallDrive<Dim>& drive, double dt) {
  const Communicator& ranks = flow.setup.ranks;
  const double density = flow.setup.density;
  Particles<Dim>& particles = flow.state.particles;
  PressureReport report;
  report.interventions.fallback_rows = assemble_weights(flow, drive);
  show_walls<Dim>(flow, flow.state.wall_velocity, particles.velocity);
  std::vector<double> source(particles.size(), 0.0);
  for_each(particles.owned, [&](std::size_t i) {
    if (flow.is_solved_for(i)) source[i] = -density / dt * divergence_at(flow, i, particles.velocity);
  });

  // A correction changes the fluid's velocity only.
  const std::vector<Vec<Dim>> walls_at_rest(flow.state.wall_velocity.size(), Vec<Dim>::Zero());
  Correction<Dim> next;
  Correction<Dim> last;
  next.resize(particles.size());
  last.resize(particles.size());
  // What accelerates the water, on wall particles too; these then get their pressure from the fluid's.
  std::vector<double> added(flow.setup.finds_wall_forces ? particles.size() : 0, 0.0);
  for (int n = 0; n < flow.setup.scheme.corrections; ++n) {
    for_each(particles.owned, [&](std::size_t i) { flow.pressure_rows.set_rhs(i, source[i]); });
    const std::span<double> guess = std::span(next.pressure).first(particles.owned);
    if (n == 0) {
      const SolveReport solved = flow.pressure_solver.solve(flow.pressure_rows, guess, coarse_tolerance);
      report.iterations = solved.iterations;
      report.residual = solved.residual;
      report.interventions.restarted_solves = solved.restarts;
      flow.pressure_solver.forget();
    } else {
      flow.pressure_rows.sweep(guess);
    }
    admit(flow, next.pressure);
    follow(flow, dt, walls_at_rest, next);
    const double whole = dot(ranks, next.source, next.source);
    const double last_square = dot(ranks, last.source, last.source);
    if (last_square > 0.0) add(-dot(ranks, next.source, last.source) / last_square, last, next);
    const double square = dot(ranks, next.source, next.source);
    if (square <= least_new_share * whole) break;  // nothing left to correct, or no new way to
    const double length = dot(ranks, source, next.source) / square;
    for_each(particles.owned, [&](std::size_t i) {
      source[i] -= length * next.source[i];
      if (!particles.is_fluid(i)) return;
      particles.velocity[i] += length * next.velocity[i];
      particles.pressure[i] += length * next.pressure[i];
    });
    for_each(added.size(), [&](std::size_t i) { added[i] += length * next.pressure[i]; });
    std::swap(next, last);
  }
  flow.pressure_rows.forget_weights();
  if (flow.setup.finds_wall_forces) {
    flow.halo().exchange(added);
    add_wall_forces(flow, added);
    owe_to_bodies(flow, forces_on_bodies(flow, added, flow.state.time + dt), dt);
  }
  finish_pressure(flow, drive);
  return report;
}

template PressureReport reproject<2>(Flow<2>&, const WallDrive<2>&, double);
template PressureReport reproject<3>(Flow<3>&, const WallDrive<3>&, double);

}  // namespace tailwater
