#include "base/for_each.h"
#include "closures/fluid_pairs.h"
#include "closures/free_surface.h"
#include "operators/pair_vectors.h"
#include "robust/discretisation.h"
#include "walls/water_in_front.h"

namespace tailwater {

template <int Dim>
void RobustDiscretisation<Dim>::find_surface(Flow<Dim>& flow, SurfaceMarks /*marks*/) {
  Surroundings<Dim>& here = flow.here;
  const Particles<Dim>& particles = flow.state.particles;
  find_interior<Dim>(flow.pairs(), particles, here.concentration, flow.setup.kernel_values.W_0, here.interior);
  if (flow.walls.is_curved) {
    flow.halo().exchange(here.interior);
    see_water_in_front<Dim>(flow.wall_scene(), flow.setup.spacing, here.interior);
  }
  mark_thin_water<Dim>(particles, here.concentration, here.is_surface);  // for the field files
  flow.halo().exchange(here.interior);
}

template <int Dim>
void RobustDiscretisation<Dim>::find_pair_vectors(Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  Surroundings<Dim>& here = flow.here;
  if (laws_.pair_vectors == PairVectors::kernel) {
    find_kernel_gradients(flow.pairs(), here.pair_vectors);
    here.open_faces = here.concentration_gradient;
    for_each(here.mean_interior.size(), [&](std::size_t i) {  // the corrections below find it on their way
      if (here.interior[i] > 0.0) here.mean_interior[i] = mean_over_fluid<Dim>(flow.pairs(), i, here.interior, 0.0);
    });
    return;
  }
  const CorrectionReach reach =
      laws_.pair_vectors == PairVectors::corrected_to_surface ? CorrectionReach::surface : CorrectionReach::inside;
  find_corrected_pair_vectors<Dim>(
      flow.pairs(), flow.halo(),
      {kernel_radius(flow.setup.kernel), particles.volume, particles.kind, here.interior, here.first_moment}, reach,
      closing_sweeps(reach), flow.pressure_rows.room_of_weights(flow.pairs().j.size()), here.pair_vectors,
      here.open_faces, here.mean_interior);
}

#define TAILWATER_INSTANTIATE(Dim)                                                 \
  template void RobustDiscretisation<Dim>::find_surface(Flow<Dim>&, SurfaceMarks); \
  template void RobustDiscretisation<Dim>::find_pair_vectors(Flow<Dim>&);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
