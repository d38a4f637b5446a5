#include "base/for_each.h"
#include "flow/distribution.h"
#include "flow/pressure_equation.h"
#include "flow/stages.h"
#include "operators/concentration.h"
#include "operators/support_operators.h"
#include "walls/hidden_pairs.h"
#include "walls/wet_walls.h"

namespace tailwater {
namespace {

/// Computes C/C_0 of owned particles, and for fluid the first moment, the crowding and, where needed, the gradient of
/// C.
template <int Dim>
void sum_kernel(const Flow<Dim>& flow, Surroundings<Dim>& surroundings) {
  const Particles<Dim>& particles = flow.state.particles;
  const bool with_gradient = flow.setup.formulation.needs_concentration_gradient;
  SupportTerms<Dim>& terms = surroundings.support_terms;
  if (flow.setup.graded != nullptr) {
    find_references<Dim>(flow.pairs(), *flow.setup.graded, particles.volume, surroundings.takes_part,
                         flow.setup.scale.lattice.concentration, terms);
  }
  surroundings.crowding.resize(particles.owned);
  for_each(particles.owned, [&](std::size_t i) {
    surroundings.concentration[i] = 1.0;
    if (with_gradient) surroundings.concentration_gradient[i].setZero();
    surroundings.first_moment[i] = packed_identity<Dim>();
    if (!has_equation(flow.role[i])) return;
    const KernelSums<Dim> sums = kernel_sums<Dim>(flow.pairs(), i, flow.setup.scale.kernel_values);
    surroundings.concentration[i] =
        sums.concentration / (terms.is_empty() ? flow.lattice_of(i).concentration : terms.reference[i]);
    if (!particles.is_fluid(i)) return;
    if (with_gradient) surroundings.concentration_gradient[i] = sums.gradient;
    surroundings.first_moment[i] = packed<Dim>(sums.first_moment);
    surroundings.crowding[i] = sums.crowding;
    if (!terms.is_empty()) surroundings.crowding[i] -= terms.crowding[i];
  });
}

}  // namespace

template <int Dim>
void locate(Flow<Dim>& flow, SurfaceMarks marks) {
  const Setup<Dim>& setup = flow.setup;
  if (!setup.ranks.any(!flow.surroundings.are_current || !flow.neighbourhood->has_pairs())) return;
  flow.equation->forget_matrix();
  for (const auto& part : flow.parts) part->arrive(flow);
  const bool ghosts_are_new = flow.neighbourhood->update(flow.state.particles);
  if (ghosts_are_new && !setup.ranks.is_alone()) {
    flow.distribution->shared_rows.find_rows(flow.walls, flow.state.particles, flow.state.particles.owned,
                                             setup.first_wall_id);
  }
  hide_pairs_behind_screens(flow.walls, flow.state.particles, *flow.neighbourhood);
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  Surroundings<Dim>& surroundings = flow.surroundings;
  surroundings.resize(particles.size(), setup.formulation.needs_concentration_gradient);

  find_wet_walls<Dim>(pairs, particles, setup.scale.kernel_values.W_0, surroundings.wall_fluid_weight,
                      surroundings.is_wet);
  if (setup.liquids.are_several()) {
    surroundings.interfaces = find_interfaces<Dim>(pairs, particles, setup.liquids, flow.halo(), setup.liquid.density);
  }
  for_each(particles.owned,
           [&](std::size_t i) { surroundings.takes_part[i] = particles.is_fluid(i) || surroundings.is_wet[i]; });
  sum_kernel(flow, surroundings);
  flow.halo().exchange(surroundings.is_wet, surroundings.takes_part, surroundings.concentration,
                       surroundings.first_moment);
  flow.discretisation().find_surface(flow, marks);
  surroundings.mean_interior.assign(particles.owned, 0.0);
  flow.discretisation().find_pair_vectors(flow);
  flow.surroundings.are_current = true;
}

TAILWATER_IN_2D_AND_3D(locate);

}  // namespace tailwater
