#include "base/for_each.h"
#include "pressure/operators.h"
#include "pressure/verbs.h"

namespace tailwater {

template <int Dim>
void correct(Flow<Dim>& flow, const Prediction<Dim>& predicted, const WallDrive<Dim>& drive, double dt) {
  const Setup<Dim>& setup = flow.setup;
  Particles<Dim>& particles = flow.state.particles;
  const Vec<Dim> gravity = setup.wall_traits.gravity_in_prediction ? Vec<Dim>(Vec<Dim>::Zero()) : setup.gravity;
  for_each(particles.owned, [&](std::size_t i) {
    if (flow.role[i] != Role::water) return;
    particles.velocity[i] =
        predicted.velocity[i] + dt * (gravity - gradient_at(flow, i, particles.pressure) / setup.density);
  });
  flow.state.wall_velocity = drive.velocity;
  add_wall_forces(flow, particles.pressure);
}

template <int Dim>
void add_wall_forces(Flow<Dim>& flow, const std::vector<double>& pressure) {
  if (!flow.setup.finds_wall_forces) return;
  const Particles<Dim>& particles = flow.state.particles;
  for_each(particles.owned, [&](std::size_t i) {
    if (particles.is_fluid(i)) return;
    flow.wall_forces.pressure[i] -= particles.volume[i] * push_of_wall_particle(flow, i, pressure);
  });
}

template void correct<2>(Flow<2>&, const Prediction<2>&, const WallDrive<2>&, double);
template void correct<3>(Flow<3>&, const Prediction<3>&, const WallDrive<3>&, double);
template void add_wall_forces<2>(Flow<2>&, const std::vector<double>&);
template void add_wall_forces<3>(Flow<3>&, const std::vector<double>&);

}  // namespace tailwater
