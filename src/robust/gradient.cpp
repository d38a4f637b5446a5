#include "base/for_each.h"
#include "operators/divergence.h"
#include "operators/gradient_conservative.h"
#include "operators/gradient_of_liquids.h"
#include "operators/support_operators.h"
#include "robust/discretisation.h"
#include "robust/loops.h"
#include "robust/support_gradient.h"

namespace tailwater {
namespace {

/// Among disordered particles a uniform pressure has the gradient 2 p sum_j w_j a_ij, which drives them together where
/// p < 0 (tensile instability). Inside water under tension it is subtracted: pairs then have p_j - p_i for p_j + p_i
/// (Sun et al. 2018).
template <int Dim>
void remove_attraction(const Flow<Dim>& flow, const std::vector<double>& pressure, std::span<Vec<Dim>> gradient) {
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (flow.role[i] != Role::water || pressure[i] >= 0.0) return;
    gradient[i] -= 2.0 * pressure[i] * flow.surroundings.interior[i] * flow.surroundings.open_faces[i];
  });
}

}  // namespace

template <int Dim>
void RobustDiscretisation<Dim>::find_gradient(const Flow<Dim>& flow, const std::vector<double>& pressure,
                                              std::span<Vec<Dim>> gradient) const {
  const std::vector<double>& volume = flow.state.particles.volume;
  const Interfaces& interfaces = flow.surroundings.interfaces;
  const bool is_graded = !flow.surroundings.support_terms.is_empty();
  const std::vector<double> scaled = is_graded ? over_references(flow, pressure) : std::vector<double>();
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (flow.role[i] != Role::water) return;
    const PairVectorField<Dim>& vectors = flow.surroundings.pair_vectors;
    gradient[i] = interfaces.are_any()
                      ? gradient_over_density<Dim>(flow.pairs(), i, volume, interfaces, vectors, pressure)
                      : conservative_gradient<Dim>(flow.pairs(), i, volume, vectors, is_graded ? scaled : pressure);
  });
  if (is_graded) add_support_gradient<Dim>(flow, scaled, gradient);
  if (flow.setup.liquid.tension > 0.0) remove_attraction(flow, pressure, gradient);
}

template <int Dim>
void RobustDiscretisation<Dim>::find_gradient_at(const Flow<Dim>& flow, std::span<const std::size_t> particles,
                                                 const std::vector<double>& pressure,
                                                 std::span<Vec<Dim>> gradient) const {
  const std::vector<double>& volume = flow.state.particles.volume;
  for_each(particles.size(), [&](std::size_t n) {
    gradient[n] =
        conservative_gradient<Dim>(flow.pairs(), particles[n], volume, flow.surroundings.pair_vectors, pressure);
  });
}

template <int Dim>
void RobustDiscretisation<Dim>::find_divergence(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                                                std::span<double> divergence) const {
  find_standard_divergence(flow, velocity, divergence);
}

template <int Dim>
void RobustDiscretisation<Dim>::wall_reactions(const Flow<Dim>& flow, std::span<const std::size_t> walls,
                                               const std::vector<double>& pressure, std::span<Vec<Dim>> pushes) const {
  find_conservative_pushes(flow, walls, pressure, pushes);
}

template <int Dim>
void RobustDiscretisation<Dim>::reactions_seen_by_water(const Flow<Dim>& flow, std::span<const std::size_t> water,
                                                        std::span<const double> share,
                                                        const std::vector<double>& pressure,
                                                        std::span<Vec<Dim>> pushes) const {
  find_conservative_pushes_on_walls(flow, water, share, pressure, pushes);
}

template <int Dim>
void find_standard_divergence(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity, std::span<double> divergence) {
  const std::vector<Float4> in_single = as_float4(velocity);
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (flow.role[i] != Role::water) return;
    divergence[i] = standard_divergence<Dim>(flow.pairs(), i, flow.surroundings.pair_vectors, in_single);
  });
  if (!flow.surroundings.support_terms.is_empty()) {
    add_support_divergence<Dim>(flow, velocity, in_single, divergence);
  }
}

namespace {

/// Pressure reaction of all pairs on each of these owned particles, over its volume [Pa/m]. weight(batch, place) gives
/// the volume with which each neighbour counts [m^Dim].
template <int Dim, class Weight>
void find_pushes_of_pairs(const Flow<Dim>& flow, std::span<const std::size_t> particles,
                          const std::vector<double>& pressure, std::span<Vec<Dim>> pushes, Weight&& weight) {
  const std::vector<double>& volume = flow.state.particles.volume;
  const Interfaces& interfaces = flow.surroundings.interfaces;
  const SupportTerms<Dim>& terms = flow.surroundings.support_terms;
  const std::vector<double> scaled = terms.is_empty() ? std::vector<double>() : over_references(flow, pressure);
  const std::vector<double>& field = terms.is_empty() ? pressure : scaled;
  for_each(particles.size(), [&](std::size_t n) {
    const std::size_t i = particles[n];
    VecSum<Dim> sum;
    const Lanes own_volume = in_all_lanes(volume[i]);
    const Lanes own = in_all_lanes(field[i]);
    for_each_pair(flow.pairs(), i, [&](const auto& batch) {
      const PairVectorLanes<Dim> pair = flow.surroundings.pair_vectors(batch);
      const Lanes other = batch.of(field);
      const Lanes twice = interfaces.are_any() ? interfaces.twice_pressure_of(batch, own, other) : own + other;
      sum += own_volume * weight(batch, pair.place) * twice * pair.a;
    });
    pushes[n] = sum.total() / volume[i];
    if (terms.is_near_border(i)) {
      pushes[n] += support_gradient<Dim>(flow.pairs(), i, volume[i], terms, field, weight);
    }
  });
}

}  // namespace

template <int Dim>
void find_conservative_pushes(const Flow<Dim>& flow, std::span<const std::size_t> walls,
                              const std::vector<double>& pressure, std::span<Vec<Dim>> pushes) {
  find_pushes_of_pairs(flow, walls, pressure, pushes,
                       [](const auto& /*batch*/, const auto& place) { return place.volume_of_fluid(); });
}

template <int Dim>
void find_conservative_pushes_on_walls(const Flow<Dim>& flow, std::span<const std::size_t> water,
                                       std::span<const double> share, const std::vector<double>& pressure,
                                       std::span<Vec<Dim>> pushes) {
  find_pushes_of_pairs(flow, water, pressure, pushes,
                       [&](const auto& batch, const auto& place) { return batch.of(share) * place.volume(); });
}

#define TAILWATER_INSTANTIATE(Dim)                                                                                  \
  template void RobustDiscretisation<Dim>::find_gradient(const Flow<Dim>&, const std::vector<double>&,              \
                                                         std::span<Vec<Dim>>) const;                                \
  template void RobustDiscretisation<Dim>::find_gradient_at(const Flow<Dim>&, std::span<const std::size_t>,         \
                                                            const std::vector<double>&, std::span<Vec<Dim>>) const; \
  template void RobustDiscretisation<Dim>::find_divergence(const Flow<Dim>&, std::span<const Vec<Dim>>,             \
                                                           std::span<double>) const;                                \
  template void RobustDiscretisation<Dim>::wall_reactions(const Flow<Dim>&, std::span<const std::size_t>,           \
                                                          const std::vector<double>&, std::span<Vec<Dim>>) const;   \
  template void RobustDiscretisation<Dim>::reactions_seen_by_water(                                                 \
      const Flow<Dim>&, std::span<const std::size_t>, std::span<const double>, const std::vector<double>&,          \
      std::span<Vec<Dim>>) const;
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE
TAILWATER_IN_2D_AND_3D(find_standard_divergence);
TAILWATER_IN_2D_AND_3D(find_conservative_pushes);
TAILWATER_IN_2D_AND_3D(find_conservative_pushes_on_walls);

}  // namespace tailwater
