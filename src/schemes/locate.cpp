#include "base/for_each.h"
#include "closures/free_surface.h"
#include "closures/wall_contact.h"
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
  flow.wall_overlap.resize(count);
  flow.is_wet.resize(count);
  flow.takes_part.resize(count);
  flow.is_held.resize(count);
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
  find_wall_overlap<Dim>(pairs, flow.boundary, flow.spacing, particles, flow.wall_overlap);
  for_each(particles.owned, [&](std::size_t i) {
    const bool is_fluid = particles.is_fluid(i);
    flow.takes_part[i] = is_fluid || flow.is_wet[i];
    flow.concentration[i] = flow.has_equation(i)
                                ? concentration<Dim>(pairs, i, particles.volume, flow.W_0) / flow.lattice.concentration
                                : 1.0;
    flow.concentration_gradient[i] =
        is_fluid ? concentration_gradient<Dim>(pairs, i, particles.volume) : Vec<Dim>(Vec<Dim>::Zero());
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
