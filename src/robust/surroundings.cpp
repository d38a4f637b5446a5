#include "base/for_each.h"
#include "closures/fluid_pairs.h"
#include "closures/free_surface.h"
#include "operators/pair_vectors.h"
#include "robust/discretisation.h"
#include "walls/water_in_front.h"

namespace tailwater {

template <int Dim>
void RobustDiscretisation<Dim>::find_surface(Flow<Dim>& flow, SurfaceMarks /*marks*/) {
  Surroundings<Dim>& surroundings = flow.surroundings;
  const Particles<Dim>& particles = flow.state.particles;
  find_interior<Dim>(flow.pairs(), particles, surroundings.concentration, flow.setup.scale.kernel_values.W_0,
                     surroundings.interior);
  if (flow.walls.is_curved) {
    flow.halo().exchange(surroundings.interior);
    see_water_in_front<Dim>(flow.wall_scene(), flow.setup.scale.spacing, surroundings.interior);
  }
  mark_thin_water<Dim>(particles, surroundings.concentration, surroundings.is_surface);  // for the field files
  flow.halo().exchange(surroundings.interior);
}

template <int Dim>
void RobustDiscretisation<Dim>::find_pair_vectors(Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  Surroundings<Dim>& surroundings = flow.surroundings;
  if (laws_.pair_vectors == PairVectors::kernel) {
    find_kernel_gradients(flow.pairs(), surroundings.pair_vectors);
    surroundings.open_faces = surroundings.concentration_gradient;
    for_each(surroundings.mean_interior.size(), [&](std::size_t i) {  // the corrections below find it on their way
      if (surroundings.interior[i] > 0.0)
        surroundings.mean_interior[i] = mean_over_fluid<Dim>(flow.pairs(), i, surroundings.interior, 0.0);
    });
    return;
  }
  const std::size_t pairs = flow.pairs().j.size();  // and a quarter more, as neighbours have (find_pairs.cpp)
  const CorrectionReach reach =
      laws_.pair_vectors == PairVectors::corrected_to_surface ? CorrectionReach::surface : CorrectionReach::inside;
  find_corrected_pair_vectors<Dim>(flow.pairs(), flow.halo(),
                                   {kernel_radius(flow.setup.scale.kernel), particles.volume, particles.kind,
                                    surroundings.interior, surroundings.first_moment},
                                   reach, closing_sweeps(reach), flow.pair_workspace->take(pairs, pairs + pairs / 4),
                                   surroundings.pair_vectors, surroundings.open_faces, surroundings.mean_interior);
}

#define TAILWATER_INSTANTIATE(Dim)                                                 \
  template void RobustDiscretisation<Dim>::find_surface(Flow<Dim>&, SurfaceMarks); \
  template void RobustDiscretisation<Dim>::find_pair_vectors(Flow<Dim>&);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
