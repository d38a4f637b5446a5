#include "base/for_each.h"
#include "closures/free_surface.h"
#include "operators/concentration.h"
#include "schemes/verbs.h"

namespace tailwater {
namespace {

template <int Dim>
void resize_geometry(Flow<Dim>& flow) {
  const std::size_t count = flow.particles.size();
  flow.concentration.resize(count);
  flow.concentration_gradient.resize(count);
  flow.wall_fluid_weight.resize(count);
  flow.is_wet.resize(count);
  flow.takes_part.resize(count);
  if (flow.uses_tensors()) flow.tensors.resize(count);
  flow.is_surface.resize(count);
  flow.interior.resize(count);
  flow.wall_mean.resize(count, Vec<Dim>::Zero());
  flow.u_star.resize(count, Vec<Dim>::Zero());
}

}  // namespace

template <int Dim>
void locate(Flow<Dim>& flow, bool keep_marks) {
  Particles<Dim>& particles = flow.particles;
  flow.neighbourhood.update(particles);
  resize_geometry(flow);
  const Pairs<Dim>& pairs = flow.pairs();
  const Halo<Dim>& halo = flow.neighbourhood.halo();

  find_wet_walls<Dim>(pairs, particles, flow.W_0, flow.wall_fluid_weight, flow.is_wet);
  for_each(particles.owned, [&](std::size_t i) {
    const bool is_fluid = particles.is_fluid(i);
    flow.takes_part[i] = is_fluid || flow.is_wet[i];
    flow.concentration[i] = 1.0;
    flow.concentration_gradient[i].setZero();
    if (!flow.has_equation(i)) return;
    const auto [sum, gradient] = concentration_with_gradient<Dim>(pairs, i, particles.volume, flow.W_0);
    flow.concentration[i] = sum / flow.lattice.concentration;
    if (is_fluid) flow.concentration_gradient[i] = gradient;
  });
  halo.exchange(flow.is_wet, flow.takes_part, flow.concentration);
  if (flow.uses_tensors()) {
    compute_renormalisation<Dim>(pairs, particles.volume, flow.takes_part, flow.tensors);
  }
  if (flow.scheme.surface == SurfaceTreatment::air) {
    find_interior<Dim>(pairs, particles, flow.concentration, flow.W_0, flow.interior);
  }
  if (keep_marks) return;
  find_free_surface<Dim>(flow.scheme.surface,
                         {pairs, particles, flow.concentration, flow.concentration_gradient, flow.tensors, flow.spacing,
                          flow.lattice.concentration, flow.W_0, flow.scheme.surface_density},
                         flow.is_surface);
  halo.exchange(flow.is_surface);
  if (flow.scheme.surface != SurfaceTreatment::air) {
    find_interior_by_marks<Dim>(pairs, particles, flow.spacing, flow.is_surface, flow.interior);
  }
}

template void locate<2>(Flow<2>&, bool);
template void locate<3>(Flow<3>&, bool);

}  // namespace tailwater
