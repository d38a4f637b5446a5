#include "base/for_each.h"
#include "closures/fluid_pairs.h"
#include "closures/free_surface.h"
#include "flow/verbs.h"
#include "operators/concentration.h"
#include "operators/pair_vectors.h"
#include "walls/hidden_pairs.h"
#include "walls/wet_walls.h"

namespace tailwater {
namespace {

/// C/C_0 of owned particles, and for fluid the first moment, the crowding and, where it is asked for, the gradient of
/// C.
template <int Dim>
void sum_kernel(const Flow<Dim>& flow, Surroundings<Dim>& here) {
  const Particles<Dim>& particles = flow.state.particles;
  const bool with_gradient = flow.setup.uses_concentration_gradient();
  here.crowding.resize(particles.owned);
  for_each(particles.owned, [&](std::size_t i) {
    here.concentration[i] = 1.0;
    if (with_gradient) here.concentration_gradient[i].setZero();
    here.first_moment[i].setIdentity();
    if (!has_equation(flow.role[i])) return;
    const KernelSums<Dim> sums = kernel_sums<Dim>(flow.pairs(), i, flow.setup.kernel_values);
    here.concentration[i] = sums.concentration / flow.setup.lattice.concentration;
    if (!particles.is_fluid(i)) return;
    if (with_gradient) here.concentration_gradient[i] = sums.gradient;
    here.first_moment[i] = sums.first_moment;
    here.crowding[i] = sums.crowding;
  });
}

/// Marks the free surface, unless the marks shall stay, and finds how far inside the particles are.
template <int Dim>
void find_surface(Flow<Dim>& flow, bool keep_marks) {
  const Setup<Dim>& setup = flow.setup;
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  Surroundings<Dim>& here = flow.here;
  const bool surface_is_air = setup.scheme.surface == SurfaceTreatment::air;
  if (surface_is_air) find_interior<Dim>(pairs, particles, here.concentration, setup.kernel_values.W_0, here.interior);
  if (!keep_marks) {
    find_free_surface<Dim>(setup.scheme.surface,
                           {pairs, particles, here.concentration, here.concentration_gradient, here.tensors,
                            setup.spacing, setup.scheme.surface_density},
                           here.is_surface);
    flow.halo().exchange(here.is_surface);
    if (!surface_is_air) find_interior_by_marks<Dim>(pairs, particles, setup.spacing, here.is_surface, here.interior);
  }
  flow.halo().exchange(here.interior);
}

/// For shifts, where no correction of pair vectors finds it.
template <int Dim>
void find_mean_interior(const Flow<Dim>& flow, Surroundings<Dim>& here) {
  if (flow.setup.scheme.shifting != ShiftingKind::lind) return;
  for_each(here.mean_interior.size(), [&](std::size_t i) {
    if (here.interior[i] > 0.0) here.mean_interior[i] = mean_over_fluid<Dim>(flow.pairs(), i, here.interior, 0.0);
  });
}

template <int Dim>
void find_pair_vectors(const Flow<Dim>& flow, Surroundings<Dim>& here) {
  const Setup<Dim>& setup = flow.setup;
  if (setup.scheme.pair_vectors == PairVectors::kernel) {
    find_kernel_gradients(flow.pairs(), here.pair_vectors);
    here.open_faces = here.concentration_gradient;
    find_mean_interior(flow, here);
    return;
  }
  const Particles<Dim>& particles = flow.state.particles;
  const CorrectionReach reach = setup.scheme.pair_vectors == PairVectors::corrected_to_surface
                                    ? CorrectionReach::surface
                                    : CorrectionReach::inside;
  find_corrected_pair_vectors<Dim>(
      flow.pairs(), flow.halo(),
      {kernel_radius(setup.kernel), particles.volume, particles.kind, here.interior, here.first_moment}, reach,
      closing_sweeps(reach), here.pair_vectors, here.open_faces, here.mean_interior);
}

}  // namespace

template <int Dim>
void locate(Flow<Dim>& flow, bool keep_marks) {
  const Setup<Dim>& setup = flow.setup;
  if (!setup.ranks.any(!flow.is_located || !flow.neighbourhood.has_pairs())) return;
  flow.forget_matrix();
  const bool ghosts_are_new = flow.neighbourhood.update(flow.state.particles);
  if (ghosts_are_new && !setup.ranks.is_alone()) {
    flow.shared_rows.find_rows(flow.walls, flow.state.particles, flow.state.particles.owned, setup.first_wall_id);
  }
  hide_pairs_behind_plates(flow.walls, flow.state.particles, flow.neighbourhood);
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  Surroundings<Dim>& here = flow.here;
  here.resize(particles.size(), setup.uses_tensors(), setup.uses_concentration_gradient());

  find_wet_walls<Dim>(pairs, particles, setup.kernel_values.W_0, here.wall_fluid_weight, here.is_wet);
  for_each(particles.owned, [&](std::size_t i) { here.takes_part[i] = particles.is_fluid(i) || here.is_wet[i]; });
  sum_kernel(flow, here);
  flow.halo().exchange(here.is_wet, here.takes_part, here.concentration, here.first_moment);
  if (setup.uses_tensors()) compute_renormalisation<Dim>(pairs, particles.volume, here.takes_part, here.tensors);
  find_surface(flow, keep_marks);
  here.mean_interior.assign(particles.owned, 0.0);
  if (setup.uses_pair_vectors()) {
    find_pair_vectors(flow, here);
  } else {
    find_mean_interior(flow, here);
  }
  flow.is_located = true;
}

template void locate<2>(Flow<2>&, bool);
template void locate<3>(Flow<3>&, bool);

}  // namespace tailwater
