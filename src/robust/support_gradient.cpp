#include "robust/support_gradient.h"

#include "base/for_each.h"
#include "operators/graded_sums.h"
#include "operators/support_operators.h"

namespace tailwater {
namespace {

template <int Dim>
bool is_in_border(const Flow<Dim>& flow, std::size_t i) {
  return flow.role[i] == Role::water && flow.surroundings.support_terms.is_near_border(i);
}

/// 1/m; delta of a continuum with a plane surface in the place of particle i, of which the support is filled alike. The
/// fraction that is inside has none.
template <int Dim>
Vec<Dim> delta_at_surface(const Flow<Dim>& flow, std::size_t i) {
  const double outside = 1.0 - flow.surroundings.interior[i];
  if (outside == 0.0) return Vec<Dim>::Zero();
  const SupportTerms<Dim>& terms = flow.surroundings.support_terms;
  const double change = outside * flow.setup.graded->change_at_surface(flow.surroundings.concentration[i]);
  const double scale = -terms.reference[i] * change / flow.pairs().relative_spacing_of(i);
  return Vec<Dim>::NullaryExpr([&](int d) { return scale * static_cast<double>(terms.ends[i].slope[d]); });
}

/// Means by volume over the water in the border of each zone of value(i), a vector. Collective.
template <int Dim, class Value>
std::vector<Vec<Dim>> means_over_borders(const Flow<Dim>& flow, Value&& value) {
  const SupportTerms<Dim>& terms = flow.surroundings.support_terms;
  const Particles<Dim>& particles = flow.state.particles;
  const std::size_t borders = flow.setup.graded->field().zones().size();
  constexpr int stride = Dim + 1;
  std::vector<double> sums(borders * stride, 0.0);     // of each border: volume times value, volume
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: adds
    if (!is_in_border(flow, i)) continue;
    double* const sum = &sums[terms.border[i] * stride];
    Vec<Dim>(particles.volume[i] * value(i)).add_to(sum);
    sum[Dim] += particles.volume[i];
  }
  flow.setup.ranks.sum_of_each(sums);
  std::vector<Vec<Dim>> means(borders, Vec<Dim>::Zero());
  for (std::size_t n = 0; n < borders; ++n) {
    const double* const sum = &sums[n * stride];
    if (sum[Dim] > 0.0) means[n] = Vec<Dim>::Map(sum) / sum[Dim];
  }
  return means;
}

}  // namespace

template <int Dim>
std::vector<double> over_references(const Flow<Dim>& flow, const std::vector<double>& pressure) {
  std::vector<double> result(pressure.size());
  for_each(result.size(),
           [&](std::size_t i) { result[i] = pressure[i] * flow.surroundings.support_terms.ends[i].inverse_reference; });
  return result;
}

template <int Dim>
void add_support_gradient(const Flow<Dim>& flow, const std::vector<double>& over_reference,
                          std::span<Vec<Dim>> gradient) {
  const SupportTerms<Dim>& terms = flow.surroundings.support_terms;
  const std::vector<double>& volume = flow.state.particles.volume;
  const std::vector<Vec<Dim>> means = means_over_borders(
      flow, [&](std::size_t i) { return Vec<Dim>(over_reference[i] * (terms.delta[i] - delta_at_surface(flow, i))); });
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (!is_in_border(flow, i)) return;
    gradient[i] += support_gradient<Dim>(flow.pairs(), i, volume[i], terms, over_reference,
                                         [](const auto& /*batch*/, const auto& place) { return place.volume(); });
    gradient[i] += over_reference[i] * terms.delta[i] - means[terms.border[i]];
  });
}

template <int Dim>
void add_support_divergence(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                            std::span<const Float4> in_single, std::span<double> divergence) {
  const SupportTerms<Dim>& terms = flow.surroundings.support_terms;
  const std::vector<Vec<Dim>> means = means_over_borders(flow, [&](std::size_t i) { return velocity[i]; });
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (flow.role[i] != Role::water) return;
    if (terms.is_near_border(i)) {
      const Vec<Dim>& mean = means[terms.border[i]];
      divergence[i] -= support_divergence<Dim>(flow.pairs(), i, terms, in_single) +
                       terms.delta[i].dot(velocity[i] - mean) + delta_at_surface(flow, i).dot(mean);
    }
    divergence[i] *= terms.ends[i].inverse_reference;
  });
}

TAILWATER_IN_2D_AND_3D(over_references);
TAILWATER_IN_2D_AND_3D(add_support_gradient);
TAILWATER_IN_2D_AND_3D(add_support_divergence);

}  // namespace tailwater
