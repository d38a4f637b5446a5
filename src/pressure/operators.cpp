#include "pressure/operators.h"

#include <cmath>

#include "base/for_each.h"
#include "closures/fluid_pairs.h"
#include "flow/verbs.h"
#include "operators/divergence.h"
#include "operators/gradient_conservative.h"
#include "operators/gradient_consistent.h"
#include "operators/gradient_density_weighted.h"

namespace tailwater {

template <int Dim>
Vec<Dim> gradient_at(const Flow<Dim>& flow, std::size_t i, const std::vector<double>& pressure) {
  const std::vector<double>& volume = flow.state.particles.volume;
  if (flow.setup.scheme.gradient == GradientKind::conservative) {
    return conservative_gradient<Dim>(flow.pairs(), i, volume, flow.here.pair_vectors, pressure);
  }
  if (flow.setup.scheme.gradient == GradientKind::density_weighted) {
    return density_weighted_gradient<Dim>(flow.pairs(), i, volume, flow.here.concentration, pressure);
  }
  const Renormalisation<Dim>& tensors = flow.here.tensors[i];
  if (!tensors.gradient_is_sound()) return Vec<Dim>::Zero();
  return consistent_gradient<Dim>(flow.pairs(), i, tensors.B1, volume, flow.here.takes_part,
                                  std::span<const double>(pressure));
}

template <int Dim>
Vec<Dim> push_of_wall_particle(const Flow<Dim>& flow, std::size_t i, const std::vector<double>& pressure) {
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  const std::vector<double>& volume = particles.volume;
  if (flow.setup.scheme.gradient == GradientKind::density_weighted) {
    return sum_over_fluid<Dim>(pairs, particles, i, [&](std::size_t, std::size_t k) {
      return Vec<Dim>(density_weighted_slope<Dim>(pairs, i, k, volume, flow.here.concentration, pressure) *
                      pairs.e(i, k));
    });
  }
  const bool has_pair_vectors = flow.setup.uses_pair_vectors();
  VecSum<Dim> sum;
  const Lanes own_volume = in_all_lanes(volume[i]);
  const Lanes own = in_all_lanes(pressure[i]);
  for_each_pair(pairs, i, [&](const auto& several) {
    PairVectorLanes<Dim> pair;
    if (has_pair_vectors) {
      pair = flow.here.pair_vectors(several);
    } else {
      pair.place = several.place();
      pair.a = -several.F() * pair.place.d;
    }
    sum += own_volume * pair.place.volume_of_fluid() * (own + several.of(pressure)) * pair.a;
  });
  return sum.total() / volume[i];
}

template <int Dim>
Divergence<Dim>::Divergence(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity)
    : flow_(flow), velocity_(velocity) {
  if (flow.setup.scheme.divergence == DivergenceKind::standard) in_fours_ = in_fours(velocity);
}

template <int Dim>
double Divergence<Dim>::operator()(std::size_t i) const {
  const Pairs<Dim>& pairs = flow_.pairs();
  if (flow_.setup.scheme.divergence == DivergenceKind::standard) {
    return standard_divergence<Dim>(pairs, i, flow_.here.pair_vectors, in_fours_);
  }
  const Renormalisation<Dim>& tensors = flow_.here.tensors[i];
  if (!tensors.gradient_is_sound()) return 0.0;
  const std::vector<double>& volume = flow_.state.particles.volume;
  return consistent_gradient<Dim>(pairs, i, tensors.B1, volume, flow_.here.takes_part, velocity_).trace();
}

template <int Dim>
std::vector<double> find_divergence(Flow<Dim>& flow) {
  Particles<Dim>& particles = flow.state.particles;
  show_walls<Dim>(flow, flow.state.wall_velocity, particles.velocity);
  const Divergence<Dim> divergence_at(flow, particles.velocity);
  std::vector<double> divergence(particles.owned, 0.0);
  for_each(particles.owned, [&](std::size_t i) {
    if (particles.is_fluid(i)) divergence[i] = divergence_at(i);
  });
  return divergence;
}

template <int Dim>
double bulk_rms(const Flow<Dim>& flow, const std::vector<double>& field) {
  const Vec<2> nothing = Vec<2>::Zero();
  Vec<2> squares_and_count = sum_over(field.size(), nothing, [&](std::size_t i) {
    return flow.is_inside(i) ? Vec<2>(field[i] * field[i], 1.0) : nothing;
  });
  flow.setup.ranks.sum_each(squares_and_count[0], squares_and_count[1]);
  return squares_and_count[1] > 0.0 ? std::sqrt(squares_and_count[0] / squares_and_count[1]) : 0.0;
}

#define TAILWATER_INSTANTIATE(Dim)                                                                         \
  template Vec<Dim> gradient_at<Dim>(const Flow<Dim>&, std::size_t, const std::vector<double>&);           \
  template Vec<Dim> push_of_wall_particle<Dim>(const Flow<Dim>&, std::size_t, const std::vector<double>&); \
  template class Divergence<Dim>;                                                                          \
  template std::vector<double> find_divergence<Dim>(Flow<Dim>&);                                           \
  template double bulk_rms<Dim>(const Flow<Dim>&, const std::vector<double>&);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
