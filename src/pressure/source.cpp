// The source of the pressure equation. For fluid particle i, with `source = "mixed"`,
//
//   -(rho/dt) (div u_star - target) + gamma rho (s_i (C/C_0 - 1) + o_i)/dt^2
//
// The first term alone is (F15); `source = "density"` is (B17), rho (C/C_0 - 1)/dt^2.
//
// o_i    share of the particle behind a wall (wall_contact.h): films on a wall, where C/C_0 < 1, are held off it
// gamma  share of the density error that a step corrects; s_i is what the energy leaves of it for particles too close
//        (`balance_energy`), and `pull` times `interior` for particles too far apart: at the surface nothing pulls
#include "base/for_each.h"
#include "pressure/full_water.h"
#include "pressure/operators.h"
#include "pressure/verbs.h"

namespace tailwater {
namespace {

/// Water too far apart answers by so many times what water too close does: shifts only ever expand, and pulling
/// together costs no energy. With 1 the dam break is 0.2 to 0.4 % too light, with 2 at fine spacing 0.1 % too dense.
constexpr double pull = 1.5;

/// (B17), or the share of the density error that a step corrects beside the divergence; owned, Pa/m^2.
template <int Dim>
std::vector<double> find_density_source(const Flow<Dim>& flow, double dt) {
  const Setup<Dim>& setup = flow.setup;
  const std::size_t owned = flow.state.particles.owned;
  const std::vector<double>& concentration = flow.here.concentration;
  std::vector<double> source(owned, 0.0);
  const double unit = setup.density / (dt * dt);
  if (setup.scheme.source == SourceKind::density) {
    for_each(owned, [&](std::size_t i) { source[i] = unit * (concentration[i] - 1.0); });
  } else if (setup.scheme.source == SourceKind::mixed) {
    std::vector<double> overlap(owned);
    find_wall_overlap<Dim>(flow.pairs(), flow.walls.boundary, setup.spacing, flow.state.particles, overlap);
    const double lift = flow.state.density_share;
    const double ways = setup.time_step_rule.limiting_speed(largest_speed(flow)) * dt / setup.spacing;
    const double share = setup.scheme.density_relaxation * ways;
    for_each(owned, [&](std::size_t i) {
      const double error = concentration[i] - 1.0;
      const double answered = (error < 0.0 ? pull * flow.here.interior[i] : lift) * error + overlap[i];
      source[i] = share * unit * answered;
    });
  }
  return source;
}

}  // namespace

template <int Dim>
std::vector<double> aim(const Flow<Dim>& flow, std::vector<Mat<Dim>> velocity_gradient, double dt) {
  std::vector<double> target(flow.state.particles.owned, 0.0);
  if (flow.setup.scheme.divergence_free != DivergenceFree::midway) return target;
  for_each(target.size(), [&](std::size_t i) {
    const Mat<Dim>& gradient = velocity_gradient[i];
    target[i] = 0.5 * dt * (gradient * gradient).trace();
  });
  return target;
}

template <int Dim>
PosedEquation assemble(Flow<Dim>& flow, const Prediction<Dim>& predicted, std::span<const double> target,
                       const WallDrive<Dim>& drive, double dt) {
  PosedEquation equation;
  equation.density_source = find_density_source(flow, dt);
  const double unit = flow.setup.density / dt;
  const bool with_divergence = flow.setup.scheme.source != SourceKind::density;
  std::vector<double> source(flow.state.particles.owned, 0.0);
  const auto is_sought = [&flow](std::size_t i) { return is_solved_for(flow.role[i]); };
  if (with_divergence) {
    const Divergence<Dim> divergence(flow, predicted.velocity);
    for_each(flow.state.particles.owned, [&](std::size_t i) {
      if (is_sought(i)) source[i] -= unit * (divergence(i) - target[i]);
    });
  }
  equation.fullness = find_fullness(flow);
  take_out_mean(flow, equation.fullness, source);
  take_out_mean(flow, equation.fullness, equation.density_source);
  equation.fallback_rows = assemble_weights(flow, drive);
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (is_sought(i)) flow.pressure_rows.set_rhs(i, source[i] + equation.density_source[i]);
  });
  return equation;
}

#define TAILWATER_INSTANTIATE(Dim)                                                                  \
  template std::vector<double> aim<Dim>(const Flow<Dim>&, std::vector<Mat<Dim>>, double);           \
  template PosedEquation assemble<Dim>(Flow<Dim>&, const Prediction<Dim>&, std::span<const double>, \
                                       const WallDrive<Dim>&, double);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
