#include <cmath>

#include "base/for_each.h"
#include "closures/wall_contact.h"
#include "operators/gradient_conservative.h"
#include "operators/gradient_consistent.h"
#include "schemes/verbs.h"

namespace tailwater {
namespace {

/// By the scheme's choice of operator. Where the consistent gradient does not exist there is none: spray falls freely.
template <int Dim>
Vec<Dim> pressure_gradient(const Flow<Dim>& flow, std::size_t i) {
  const std::vector<double>& pressure = flow.particles.pressure;
  if (flow.scheme.gradient == GradientKind::conservative) {
    return conservative_gradient<Dim>(flow.pairs(), i, flow.particles.volume, pressure);
  }
  if (!flow.tensors[i].gradient_is_sound()) return Vec<Dim>::Zero();
  return consistent_gradient<Dim>(flow.pairs(), i, flow.tensors[i].B1, flow.particles.volume, flow.takes_part,
                                  std::span<const double>(pressure));
}

/// m/s; of the fluid.
template <int Dim>
double largest_speed(const Flow<Dim>& flow) {
  double squared = 0.0;
  for (std::size_t i = 0; i < flow.particles.owned; ++i) {
    if (flow.particles.is_fluid(i)) squared = std::max(squared, flow.particles.velocity[i].squaredNorm());
  }
  return std::sqrt(squared);
}

}  // namespace

template <int Dim>
void correct(Flow<Dim>& flow, double dt) {
  for_each(flow.particles.owned, [&](std::size_t i) {
    if (!flow.particles.is_fluid(i)) return;
    flow.particles.velocity[i] = flow.u_star[i] + dt * (flow.gravity - pressure_gradient(flow, i) / flow.density);
  });
}

template <int Dim>
void move(Flow<Dim>& flow, double dt, Interventions& interventions) {
  Particles<Dim>& particles = flow.particles;
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    particles.position[i] = flow.position_old[i] + 0.5 * dt * (flow.velocity_old[i] + particles.velocity[i]);
  });
  interventions.put_back += keep_off_walls(flow.pairs(), flow.boundary, flow.spacing, particles);
}

template <int Dim>
void shift(Flow<Dim>& flow, double dt, Interventions& interventions) {
  if (flow.scheme.shifting == ShiftingKind::none) return;
  Particles<Dim>& particles = flow.particles;
  flow.shift.resize(particles.owned);
  interventions.capped_shifts += compute_shift<Dim>(flow.shifting_law, dt, largest_speed(flow), flow.pairs(), particles,
                                                    flow.is_near_surface, flow.concentration_gradient, flow.shift);
  if (flow.scheme.shifting == ShiftingKind::farzin) {
    // (F31), (F32): u and p move along with their gradients, where those are sound.
    std::vector<Vec<Dim>>& velocity = particles.velocity;
    flow.shift_velocity.assign(particles.owned, Vec<Dim>::Zero());
    flow.shift_pressure.assign(particles.owned, 0.0);
    for_each(particles.owned, [&](std::size_t i) {
      if (!particles.is_fluid(i) || flow.is_near_surface[i] || !flow.tensors[i].gradient_is_sound()) return;
      const Mat<Dim>& B1 = flow.tensors[i].B1;
      flow.shift_velocity[i] = consistent_gradient<Dim>(flow.pairs(), i, B1, particles.volume, flow.takes_part,
                                                        std::span<const Vec<Dim>>(velocity)) *
                               flow.shift[i];
      flow.shift_pressure[i] = consistent_gradient<Dim>(flow.pairs(), i, B1, particles.volume, flow.takes_part,
                                                        std::span<const double>(particles.pressure))
                                   .dot(flow.shift[i]);
    });
    for_each(particles.owned, [&](std::size_t i) {
      velocity[i] += flow.shift_velocity[i];
      particles.pressure[i] += flow.shift_pressure[i];
    });
  }
  for_each(particles.owned, [&](std::size_t i) { particles.position[i] += flow.shift[i]; });
  interventions.put_back += keep_off_walls(flow.pairs(), flow.boundary, flow.spacing, particles);
  flow.neighbourhood.halo().exchange_positions(particles.position);
}

template <int Dim>
double next_time_step(const Flow<Dim>& flow) {
  const double speed = largest_speed(flow);
  return flow.time_step_rule.largest(speed, flow.viscosity_law.at_speed(speed));
}

#define TAILWATER_INSTANTIATE(Dim)                              \
  template void correct<Dim>(Flow<Dim>&, double);               \
  template void move<Dim>(Flow<Dim>&, double, Interventions&);  \
  template void shift<Dim>(Flow<Dim>&, double, Interventions&); \
  template double next_time_step<Dim>(const Flow<Dim>&);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
