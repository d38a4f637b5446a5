#include "base/for_each.h"
#include "flow/verbs.h"
#include "operators/concentration.h"
#include "walls/hidden_pairs.h"
#include "walls/wet_walls.h"

namespace tailwater {
namespace {

/// C/C_0 of owned particles, and for fluid the first moment, the crowding and, where it is asked for, the gradient of
/// C.
template <int Dim>
void sum_kernel(const Flow<Dim>& flow, Surroundings<Dim>& here) {
  const Particles<Dim>& particles = flow.state.particles;
  const bool with_gradient = flow.setup.formulation.needs_concentration_gradient;
  here.crowding.resize(particles.owned);
  for_each(particles.owned, [&](std::size_t i) {
    here.concentration[i] = 1.0;
    if (with_gradient) here.concentration_gradient[i].setZero();
    here.first_moment[i] = packed_identity<Dim>();
    if (!has_equation(flow.role[i])) return;
    const KernelSums<Dim> sums = kernel_sums<Dim>(flow.pairs(), i, flow.setup.kernel_values);
    here.concentration[i] = sums.concentration / flow.setup.lattice.concentration;
    if (!particles.is_fluid(i)) return;
    if (with_gradient) here.concentration_gradient[i] = sums.gradient;
    here.first_moment[i] = packed<Dim>(sums.first_moment);
    here.crowding[i] = sums.crowding;
  });
}

}  // namespace

template <int Dim>
void locate(Flow<Dim>& flow, SurfaceMarks marks) {
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
  here.resize(particles.size(), setup.formulation.needs_concentration_gradient);

  find_wet_walls<Dim>(pairs, particles, setup.kernel_values.W_0, here.wall_fluid_weight, here.is_wet);
  for_each(particles.owned, [&](std::size_t i) { here.takes_part[i] = particles.is_fluid(i) || here.is_wet[i]; });
  sum_kernel(flow, here);
  flow.halo().exchange(here.is_wet, here.takes_part, here.concentration, here.first_moment);
  flow.discretisation().find_surface(flow, marks);
  here.mean_interior.assign(particles.owned, 0.0);
  flow.discretisation().find_pair_vectors(flow);
  flow.is_located = true;
}

TAILWATER_IN_2D_AND_3D(locate);

}  // namespace tailwater
