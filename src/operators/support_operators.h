// Sums over pairs of the terms of support_terms.h.
#pragma once

#include <span>

#include "base/lane_loop.h"
#include "neighbours/pair_lanes.h"
#include "operators/graded_sums.h"
#include "operators/support_terms.h"

namespace tailwater {

/// All terms but delta and the faces. `case_reference` is C_0 of the case's lattice.
template <int Dim>
void find_references(const Pairs<Dim>& pairs, const GradedSums<Dim>& sums, std::span<const double> volume,
                     std::span<const std::uint8_t> takes_part, double case_reference, SupportTerms<Dim>& terms);

/// delta of particle i, of which C is `concentration` times c.
template <int Dim>
Vec<Dim> find_delta(const Pairs<Dim>& pairs, std::size_t i, double concentration, double W_0,
                    const SupportTerms<Dim>& terms);

/// C_0/c of particle i, by which pair forces multiply its pressure; 1 if all particles have one spacing.
template <int Dim>
double inverse_reference(const SupportTerms<Dim>& terms, std::size_t i) {
  return terms.is_empty() ? 1.0 : static_cast<double>(terms.ends[i].inverse_reference);
}

/// Mean of C_0/c over both particles of several pairs.
template <class Batch, int Dim>
Lanes mean_inverse_reference(const Batch& batch, const SupportTerms<Dim>& terms) {
  constexpr std::size_t number = offsetof(SupportEnd, inverse_reference) / sizeof(float);
  const float own = terms.ends[batch.i].inverse_reference;
  return 0.5F * (own + batch.j.numbers(terms.ends.data())[number]);
}

/// 1/m^Dim; Q of several pairs.
template <class Batch, int Dim>
Lanes support_change(const Batch& batch, const PlaceLanes<Dim>& place) {
  const Lanes change = place.d.dot(place.d) * batch.F(place.d) - static_cast<float>(Dim) * batch.kernel_at(place.d);
  return (0.5F / batch.relative_spacing()) * change;
}

/// sum_j w_j Q_ij G_j . (u_j - u_i) [1/s]
template <int Dim>
double support_divergence(const Pairs<Dim>& pairs, std::size_t i, const SupportTerms<Dim>& terms,
                          std::span<const Float4> velocity) {
  LaneSum sum;
  for_each_pair(pairs, i, [&](const auto& batch) {
    const auto other = batch.j.numbers(terms.ends.data());
    const VecLanes<Dim> difference = batch.of(velocity) - velocity[i];
    Lanes along{};
    for (int d = 0; d < Dim; ++d) along += other[d] * difference.at[d];
    const PlaceLanes<Dim> place = batch.place();
    sum += place.volume() * support_change(batch, place) * along;
  });
  return sum.total();
}

/// sum_j w_j Q_ij (m_j G_i - m_i G_j) of a field m; `factor(batch, place)` is w_j. Opposite for the two of a pair
/// to the last bit, when multiplied with their volumes.
template <int Dim, class Factor>
Vec<Dim> support_gradient(const Pairs<Dim>& pairs, std::size_t i, double volume, const SupportTerms<Dim>& terms,
                          std::span<const double> field, Factor&& factor) {
  VecSum<Dim> sum;
  const Lanes own_volume = in_all_lanes(volume);
  const Lanes own = in_all_lanes(field[i]);
  for_each_pair(pairs, i, [&](const auto& batch) {
    const auto other = batch.j.numbers(terms.ends.data());
    const PlaceLanes<Dim> place = batch.place();
    const Lanes weight = own_volume * factor(batch, place) * support_change(batch, place);
    const Lanes field_j = batch.of(field);
    VecLanes<Dim> change;
    for (int d = 0; d < Dim; ++d) {
      const Lanes slope = in_all_lanes(terms.ends[i].slope[d]);
      const Lanes opposite = (field_j - own) * (slope + other[d]);
      change.at[d] = 0.5F * weight * fused(own + field_j, slope - other[d], opposite);
    }
    sum += change;
  });
  return sum.total() / volume;
}

}  // namespace tailwater
