#include "base/for_each.h"
#include "flow/stages.h"
#include "neighbours/neighbourhood.h"

namespace tailwater {

template <int Dim>
StepStart<Dim> save_step_start(Flow<Dim>& flow) {
  Particles<Dim>& particles = flow.state.particles;
  flow.neighbourhood->wrap(particles);
  const auto owned = static_cast<std::ptrdiff_t>(particles.owned);
  return {{particles.position.begin(), particles.position.begin() + owned},
          {particles.velocity.begin(), particles.velocity.begin() + owned},
          flow.state.wall_velocity,
          fluid_sums_of_rank(flow).energy};
}

template <int Dim>
void drift(Flow<Dim>& flow, const StepStart<Dim>& start, const Prediction<Dim>& predicted, double dt) {
  Particles<Dim>& particles = flow.state.particles;
  for_each(particles.owned, [&](std::size_t i) {
    if (particles.is_fluid(i)) particles.position[i] = start.position[i] + dt * predicted.velocity[i];
  });
  place_walls(flow, flow.state.time + dt);
  flow.surroundings.are_current = false;
}

template <int Dim>
std::size_t move(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  Particles<Dim>& particles = flow.state.particles;
  const bool with_mean = flow.setup.formulation.moves_with_mean_velocity;
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    const Vec<Dim> velocity =
        with_mean ? Vec<Dim>(0.5 * (start.velocity[i] + particles.velocity[i])) : particles.velocity[i];
    particles.position[i] = start.position[i] + dt * velocity;
  });
  place_walls(flow, flow.state.time + dt);
  flow.surroundings.are_current = false;
  const bool finds_forces = flow.walls.forces.are_requested;
  const std::vector<Vec<Dim>> before = finds_forces ? particles.velocity : std::vector<Vec<Dim>>();
  const std::size_t stopped_at_walls =
      keep_off_walls<Dim>(flow.pairs(), flow.walls.boundary, flow.setup.scale.spacing, displacements_of_walls(flow, dt),
                          start.position, particles, particles.velocity);
  for_each(finds_forces ? particles.owned : 0, [&](std::size_t i) {
    const double mass = flow.density_of(i) * flow.water_volume_of(i);
    if (particles.is_fluid(i)) flow.walls.forces.pressure[i] = mass / dt * (before[i] - particles.velocity[i]);
  });
  return stopped_at_walls;
}

TAILWATER_IN_2D_AND_3D(save_step_start);
TAILWATER_IN_2D_AND_3D(drift);
TAILWATER_IN_2D_AND_3D(move);

}  // namespace tailwater
