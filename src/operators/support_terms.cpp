#include "operators/support_operators.h"

#include <algorithm>

#include "base/for_each.h"
#include "operators/continuum_table.h"

namespace tailwater {
namespace {

template <int Dim>
Vec<Dim> slope_of(const SupportEnd& end) {
  return Vec<Dim>::NullaryExpr([&end](int n) { return static_cast<double>(end.slope[n]); });
}

/// Applied fraction of the correction B of pair vectors by <M>: 0 in a border, where with B they would be no derivative
/// of C, and 1 from a spacing away on. `distance` is over the spacing of the place.
double kept_correction(double distance) {
  const double step = std::min(distance, 1.0);
  return step * step * (3.0 - 2.0 * step);
}

}  // namespace

template <int Dim>
void find_references(const Pairs<Dim>& pairs, const GradedSums<Dim>& sums, std::span<const double> volume,
                     std::span<const std::uint8_t> takes_part, double case_reference, SupportTerms<Dim>& terms) {
  const std::size_t size = pairs.position.size();
  const std::size_t owned = pairs.owned();
  const double radius = kernel_radius(pairs.kernel);
  terms.ends.assign(size, {});
  terms.reference.assign(size, case_reference);
  terms.first_moment.assign(size, packed_identity<Dim>());
  terms.border.assign(size, -1);
  terms.log_slope.assign(owned, Vec<Dim>::Zero());
  terms.crowding.assign(owned, Vec<Dim>::Zero());
  terms.kept_correction.assign(owned, 1.0);
  const auto counts = [&](std::size_t i) { return i >= owned || takes_part[i] != 0; };
  for_each(size, [&](std::size_t i) {
    if (counts(i)) terms.reference[i] = sums.lattice_concentration(pairs.relative_spacing_of(i), volume[i]);
  });
  if (terms.continuum == nullptr) terms.continuum = std::make_shared<ContinuumTable<Dim>>();
  for (std::size_t i = 0; i < size; ++i) {  // in order: fills the table
    if (!counts(i)) continue;
    const Vec<Dim>& x = pairs.position[i];
    const auto border = sums.field().nearest_border(x);
    if (border.distance >= radius) continue;
    const auto continuum = terms.continuum->at(sums, x);
    terms.border[i] = border.zone;
    terms.reference[i] *= continuum.sums.concentration;
    terms.first_moment[i] = continuum.sums.first_moment;
    const Vec<Dim> slope = sums.field().slope(x);
    for (int d = 0; d < Dim; ++d) terms.ends[i].slope[d] = static_cast<float>(slope[d]);
    if (i >= owned) continue;
    const double relative = pairs.relative_spacing_of(i);
    terms.kept_correction[i] = kept_correction(border.distance / (relative * sums.spacing()));
    terms.crowding[i] = continuum.sums.gradient;
    terms.log_slope[i] =
        continuum.slope / continuum.sums.concentration + sums.lattice_slope(relative, volume[i]) / relative * slope;
  }
  for_each(size, [&](std::size_t i) {
    terms.ends[i].inverse_reference = static_cast<float>(case_reference / terms.reference[i]);
  });
}

template <int Dim>
Vec<Dim> find_delta(const Pairs<Dim>& pairs, std::size_t i, double concentration, double W_0,
                    const SupportTerms<Dim>& terms) {
  VecSum<Dim> sum;
  for_each_pair(pairs, i, [&](const auto& batch) {
    const auto other = batch.j.numbers(terms.ends.data());
    const PlaceLanes<Dim> place = batch.place();
    const Lanes weight = place.volume() * support_change(batch, place);
    VecLanes<Dim> change;
    for (int d = 0; d < Dim; ++d) change.at[d] = weight * (in_all_lanes(terms.ends[i].slope[d]) + other[d]);
    sum += change;
  });
  const double relative = pairs.relative_spacing_of(i);
  const double volume = std::abs(static_cast<double>(pairs.place[i].signed_volume));
  const double own_change = -Dim * volume * W_0 / (power<Dim>(relative) * relative);
  return sum.total() + own_change * slope_of<Dim>(terms.ends[i]) -
         concentration * terms.reference[i] * terms.log_slope[i];
}

TAILWATER_IN_2D_AND_3D(find_references);
TAILWATER_IN_2D_AND_3D(find_delta);

}  // namespace tailwater
