#include "base/for_each.h"
#include "flow/verbs.h"
#include "operators/gradient_consistent.h"

namespace tailwater {
namespace {

/// (F31), (F32): corrects u and p of shifted particles by their gradients, inside the fluid where those are sound.
template <int Dim>
void carry_fields_along(Flow<Dim>& flow, const std::vector<Vec<Dim>>& shift) {
  Particles<Dim>& particles = flow.state.particles;
  const Surroundings<Dim>& here = flow.here;
  show_walls<Dim>(flow, flow.state.wall_velocity, particles.velocity);
  std::vector<Vec<Dim>> velocity_change(particles.owned, Vec<Dim>::Zero());
  std::vector<double> pressure_change(particles.owned, 0.0);
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i) || here.interior[i] < 1.0 || !here.tensors[i].gradient_is_sound()) return;
    const Mat<Dim>& B1 = here.tensors[i].B1;
    velocity_change[i] = consistent_gradient<Dim>(flow.pairs(), i, B1, particles.volume, here.takes_part,
                                                  std::span<const Vec<Dim>>(particles.velocity)) *
                         shift[i];
    pressure_change[i] = consistent_gradient<Dim>(flow.pairs(), i, B1, particles.volume, here.takes_part,
                                                  std::span<const double>(particles.pressure))
                             .dot(shift[i]);
  });
  for_each(particles.owned, [&](std::size_t i) {
    particles.velocity[i] += velocity_change[i];
    particles.pressure[i] += pressure_change[i];
  });
}

}  // namespace

template <int Dim>
Interventions shift(Flow<Dim>& flow, double dt) {
  const Setup<Dim>& setup = flow.setup;
  Interventions interventions;
  if (setup.scheme.shifting == ShiftingKind::none) return interventions;
  Particles<Dim>& particles = flow.state.particles;
  std::vector<Vec<Dim>> shift(particles.owned);
  interventions.capped_shifts =
      compute_shift<Dim>(setup.shifting_law, dt, largest_speed(flow), flow.pairs(), particles, flow.here, shift);
  for_each(particles.owned, [&](std::size_t i) {
    if (is_in_end_stretch(flow.role[i])) shift[i].setZero();
  });
  if (setup.scheme.shifting == ShiftingKind::farzin) carry_fields_along(flow, shift);
  const std::vector<Vec<Dim>> before(particles.position.begin(),
                                     particles.position.begin() + static_cast<std::ptrdiff_t>(particles.owned));
  for_each(particles.owned, [&](std::size_t i) { particles.position[i] += shift[i]; });
  interventions.put_back =
      keep_off_walls<Dim>(flow.pairs(), flow.walls.boundary, setup.spacing, {}, before, particles, {});
  flow.is_located = false;
  return interventions;
}

template Interventions shift<2>(Flow<2>&, double);
template Interventions shift<3>(Flow<3>&, double);

}  // namespace tailwater
