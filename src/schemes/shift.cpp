#include "base/for_each.h"
#include "closures/wall_contact.h"
#include "operators/gradient_consistent.h"
#include "schemes/verbs.h"

namespace tailwater {
namespace {

/// (F31), (F32): u and p move along with their gradients, where those are sound.
template <int Dim>
void carry_fields_along(Flow<Dim>& flow) {
  Particles<Dim>& particles = flow.particles;
  std::vector<Vec<Dim>>& velocity = particles.velocity;
  flow.shift_velocity.assign(particles.owned, Vec<Dim>::Zero());
  flow.shift_pressure.assign(particles.owned, 0.0);
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i) || flow.interior[i] < 1.0 || !flow.tensors[i].gradient_is_sound()) return;
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

}  // namespace

template <int Dim>
void shift(Flow<Dim>& flow, double dt, Interventions& interventions) {
  if (flow.scheme.shifting == ShiftingKind::none) return;
  Particles<Dim>& particles = flow.particles;
  flow.shift.resize(particles.owned);
  flow.neighbourhood.halo().exchange(flow.interior);
  interventions.capped_shifts += compute_shift<Dim>(flow.shifting_law, dt, largest_speed(flow), flow.pairs(), particles,
                                                    flow.interior, flow.concentration_gradient, flow.shift);
  for_each(particles.owned, [&](std::size_t i) {
    if (flow.is_leaving(i)) flow.shift[i].setZero();
  });
  if (flow.scheme.shifting == ShiftingKind::farzin) carry_fields_along(flow);
  for_each(particles.owned, [&](std::size_t i) {
    flow.position_old[i] = particles.position[i];  // r^n has served
    particles.position[i] += flow.shift[i];
  });
  interventions.put_back +=
      keep_off_walls<Dim>(flow.pairs(), flow.boundary, flow.spacing, {}, flow.position_old, particles, {});
  flow.neighbourhood.halo().exchange_positions(particles.position);
}

template void shift<2>(Flow<2>&, double, Interventions&);
template void shift<3>(Flow<3>&, double, Interventions&);

}  // namespace tailwater
