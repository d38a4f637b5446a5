#include "flow/distribution.h"
#include "flow/pressure_equation.h"
#include "flow/stages.h"
#include "neighbours/neighbourhood.h"

namespace tailwater {

template <int Dim>
void sort_particles(Flow<Dim>& flow) {
  flow.neighbourhood->reorder(flow.state.particles,
                              flow.equation->solver.needs_cells() ? ParticleOrder::z_curve : ParticleOrder::slabs);
  for (const auto& part : flow.parts) part->reordered(Reordering::sorted);
}

template <int Dim>
Repartition repartition(Flow<Dim>& flow) {
  flow.neighbourhood->wrap(flow.state.particles);
  const Repartition repartition = flow.distribution->decomposition.repartition(
      flow.state.particles, flow.neighbourhood->work(flow.state.particles));
  if (repartition.moved > 0)
    flow.distribution->shared_rows.find_rows(flow.walls, flow.state.particles, 0, flow.setup.first_wall_id);
  regather_walls(flow);
  sort_particles(flow);
  return repartition;
}

TAILWATER_IN_2D_AND_3D(sort_particles);
TAILWATER_IN_2D_AND_3D(repartition);

}  // namespace tailwater
