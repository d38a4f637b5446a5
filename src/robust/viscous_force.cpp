#include "flow/measure.h"
#include "robust/discretisation.h"

namespace tailwater {

template <int Dim>
void RobustDiscretisation<Dim>::add_viscous_force(const Flow<Dim>& flow, std::span<const Mat<Dim>> velocity_gradient,
                                                  std::vector<Vec<Dim>>& acceleration) const {
  const Setup<Dim>& setup = flow.setup;
  if (setup.has_implicit_viscosity) return;
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<double> viscosity(particles.size());
  const bool damps_noise = setup.formulation.noise_viscosity > 0.0;
  const double noise_viscosity = damps_noise ? setup.noise_viscosity(largest_speed(flow)) : 0.0;
  effective_viscosity<Dim>(setup.liquid.viscosity, particles.velocity, viscosity);
  for (const auto& part : flow.parts) part->add_viscosity(flow, viscosity);
  add_newtonian_viscosity<Dim>(flow.pairs(), particles, setup.scale.spacing, flow.surroundings.pair_vectors, viscosity,
                               noise_viscosity, particles.velocity, velocity_gradient, acceleration);
}

#define TAILWATER_INSTANTIATE(Dim)                                                                        \
  template void RobustDiscretisation<Dim>::add_viscous_force(const Flow<Dim>&, std::span<const Mat<Dim>>, \
                                                             std::vector<Vec<Dim>>&) const;
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
