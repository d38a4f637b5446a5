#include <algorithm>

#include "base/for_each.h"
#include "closures/fluid_pairs.h"
#include "closures/free_surface.h"
#include "flow/pressure_equation.h"
#include "neighbours/halo.h"
#include "operators/pair_vectors.h"
#include "operators/support_operators.h"
#include "robust/discretisation.h"
#include "robust/support_gradient.h"
#include "walls/water_in_front.h"

namespace tailwater {

namespace {

/// Disorder is not air: water without a surface particle in reach is inside, even where its density is low. Without
/// this rule, water under tension would separate at the first disorder. Collective.
template <int Dim>
void keep_whole(const Flow<Dim>& flow, std::vector<double>& interior) {
  // C/C_0 and its mean over the fluid in reach: 0.75 and 0.83 in the outermost row of a flat surface, 0.98 and 0.93 in
  // the second row. In a siphon that turns sharply single particles have 0.8.
  constexpr double largest_at_surface = 0.8;
  constexpr double largest_mean_at_surface = 0.9;
  const Pairs<Dim>& pairs = flow.pairs();
  const Particles<Dim>& particles = flow.state.particles;
  const std::vector<double>& concentration = flow.surroundings.concentration;
  std::vector<double> is_at_surface(particles.size(), 0.0);
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i) || concentration[i] >= largest_at_surface) return;
    const double mean = mean_over_fluid<Dim>(pairs, i, concentration, flow.setup.scale.kernel_values.W_0);
    is_at_surface[i] = mean < largest_mean_at_surface ? 1.0 : 0.0;
  });
  flow.halo().exchange(is_at_surface);
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i) || interior[i] == 1.0 || is_at_surface[i] != 0.0) return;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      if (is_at_surface[static_cast<std::size_t>(pairs.j[k])] != 0.0) return;
    }
    interior[i] = 1.0;
  });
}

/// Walls hold water only where it is inside, so that no air can come between.
template <int Dim>
void find_wall_tension(const Flow<Dim>& flow, std::vector<double>& tension) {
  constexpr double min_interior = 0.75;  // mean over the water beside a wall particle
  const Particles<Dim>& particles = flow.state.particles;
  tension.assign(particles.owned, 0.0);
  for_each(particles.owned, [&](std::size_t i) {
    if (particles.is_fluid(i) || !flow.surroundings.is_wet[i]) return;
    const double inside = mean_over_fluid<Dim>(flow.pairs(), i, flow.surroundings.interior, 0.0);
    tension[i] = flow.setup.liquid.tension * std::max(0.0, (inside - min_interior) / (1.0 - min_interior));
  });
}

}  // namespace

template <int Dim>
void RobustDiscretisation<Dim>::find_surface(Flow<Dim>& flow, SurfaceMarks /*marks*/) {
  Surroundings<Dim>& surroundings = flow.surroundings;
  const Particles<Dim>& particles = flow.state.particles;
  find_interior<Dim>(flow.pairs(), particles, surroundings.concentration, flow.setup.scale.kernel_values.W_0,
                     surroundings.interior);
  if (flow.setup.liquid.tension > 0.0) keep_whole(flow, surroundings.interior);
  if (flow.walls.is_curved) {
    flow.halo().exchange(surroundings.interior);
    see_water_in_front<Dim>(flow.wall_scene(), flow.setup.scale.spacing, surroundings.interior);
  }
  mark_thin_water<Dim>(particles, surroundings.concentration, surroundings.is_surface);  // for the field files
  flow.halo().exchange(surroundings.interior);
  if (flow.setup.liquid.tension > 0.0) find_wall_tension(flow, surroundings.wall_tension);
}

namespace {

/// delta of the water beside borders, and half of the gradient of a uniform pressure by the terms of supports.
/// Collective.
template <int Dim>
void find_support_faces(const Flow<Dim>& flow, SupportTerms<Dim>& terms) {
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  const auto is_in_border = [&](std::size_t i) { return flow.role[i] == Role::water && terms.is_near_border(i); };
  terms.delta.assign(particles.owned, Vec<Dim>::Zero());
  terms.faces.assign(particles.owned, Vec<Dim>::Zero());
  for_each(particles.owned, [&](std::size_t i) {
    if (!is_in_border(i)) return;
    terms.delta[i] =
        find_delta<Dim>(pairs, i, flow.surroundings.concentration[i], flow.setup.scale.kernel_values.W_0, terms);
  });
  add_support_gradient<Dim>(flow, over_references(flow, std::vector<double>(particles.size(), 1.0)), terms.faces);
  for_each(particles.owned, [&](std::size_t i) { terms.faces[i] *= 0.5; });
}

}  // namespace

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
  SupportTerms<Dim>& support = surroundings.support_terms;
  if (!support.is_empty()) find_support_faces(flow, support);
  const std::size_t pairs = flow.pairs().j.size();  // and a quarter more, as neighbours have (find_pairs.cpp)
  const CorrectionReach reach =
      laws_.pair_vectors == PairVectors::corrected_to_surface ? CorrectionReach::surface : CorrectionReach::inside;
  find_corrected_pair_vectors<Dim>(
      flow.pairs(), flow.halo(),
      {kernel_radius(flow.setup.scale.kernel), particles.volume, particles.kind, surroundings.interior,
       surroundings.first_moment, support.is_empty() ? nullptr : &support},
      reach, closing_sweeps(reach), flow.equation->rows.workspace().take(pairs, pairs + pairs / 4),
      surroundings.pair_vectors, surroundings.open_faces, surroundings.mean_interior);
}

#define TAILWATER_INSTANTIATE(Dim)                                                 \
  template void RobustDiscretisation<Dim>::find_surface(Flow<Dim>&, SurfaceMarks); \
  template void RobustDiscretisation<Dim>::find_pair_vectors(Flow<Dim>&);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
