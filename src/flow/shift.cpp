#include "base/for_each.h"
#include "flow/stages.h"

namespace tailwater {

template <int Dim>
Interventions shift(Flow<Dim>& flow, double dt) {
  const Setup<Dim>& setup = flow.setup;
  Interventions interventions;
  if (!setup.formulation.shifts_particles) return interventions;
  Particles<Dim>& particles = flow.state.particles;
  std::vector<Vec<Dim>> shift(particles.owned);
  interventions.capped_shifts = flow.discretisation().find_shifts(flow, dt, shift);
  const std::vector<Vec<Dim>> before(particles.position.begin(),
                                     particles.position.begin() + static_cast<std::ptrdiff_t>(particles.owned));
  for_each(particles.owned, [&](std::size_t i) { particles.position[i] += shift[i]; });
  interventions.stopped_at_walls =
      keep_off_walls<Dim>(flow.pairs(), flow.walls.boundary, setup.scale.spacing, {}, before, particles, {});
  flow.surroundings.are_current = false;
  return interventions;
}

TAILWATER_IN_2D_AND_3D(shift);

}  // namespace tailwater
