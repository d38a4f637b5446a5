#include "base/for_each.h"
#include "closures/free_surface.h"
#include "flow/verbs.h"
#include "operators/concentration.h"
#include "walls/wet_walls.h"

namespace tailwater {
namespace {

/// C/C_0 of owned particles, and for fluid the gradient of C.
template <int Dim>
void find_concentration(const Flow<Dim>& flow, Surroundings<Dim>& here) {
  const Particles<Dim>& particles = flow.state.particles;
  for_each(particles.owned, [&](std::size_t i) {
    here.concentration[i] = 1.0;
    here.concentration_gradient[i].setZero();
    if (!flow.has_equation(i)) return;
    const auto [sum, gradient] = concentration_with_gradient<Dim>(flow.pairs(), i, particles.volume, flow.setup.W_0);
    here.concentration[i] = sum / flow.setup.lattice.concentration;
    if (particles.is_fluid(i)) here.concentration_gradient[i] = gradient;
  });
}

}  // namespace

template <int Dim>
void locate(Flow<Dim>& flow, bool keep_marks) {
  const Setup<Dim>& setup = flow.setup;
  flow.neighbourhood.update(flow.state.particles);
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  Surroundings<Dim>& here = flow.here;
  here.resize(particles.size(), setup.uses_tensors());

  find_wet_walls<Dim>(pairs, particles, setup.W_0, here.wall_fluid_weight, here.is_wet);
  for_each(particles.owned, [&](std::size_t i) { here.takes_part[i] = particles.is_fluid(i) || here.is_wet[i]; });
  find_concentration(flow, here);
  flow.halo().exchange(here.is_wet, here.takes_part, here.concentration);
  if (setup.uses_tensors()) compute_renormalisation<Dim>(pairs, particles.volume, here.takes_part, here.tensors);

  const bool surface_is_air = setup.scheme.surface == SurfaceTreatment::air;
  if (surface_is_air) find_interior<Dim>(pairs, particles, here.concentration, setup.W_0, here.interior);
  if (keep_marks) return;
  find_free_surface<Dim>(setup.scheme.surface,
                         {pairs, particles, here.concentration, here.concentration_gradient, here.tensors,
                          setup.spacing, setup.lattice.concentration, setup.W_0, setup.scheme.surface_density},
                         here.is_surface);
  flow.halo().exchange(here.is_surface);
  if (!surface_is_air) find_interior_by_marks<Dim>(pairs, particles, setup.spacing, here.is_surface, here.interior);
}

template void locate<2>(Flow<2>&, bool);
template void locate<3>(Flow<3>&, bool);

}  // namespace tailwater
