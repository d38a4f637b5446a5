#include "operators/graded_sums.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tailwater {
namespace {

/// Points of the quadrature along the radius of a support.
constexpr int points_along_radius = 8;

/// Lattice spacings over dx at a support of the case's, of which the sums are tabulated. Volumes keep within half and
/// 1.34 of the wanted ones, those of walls within a third and 2.
constexpr double least_ratio = 0.3;
constexpr double largest_ratio = 2.0;
constexpr int ratios = 171;

/// Between two entries; outside those of the ends.
template <class Entries>
auto interpolate(const Entries& entries, double at) {
  const double place = std::clamp(at, 0.0, static_cast<double>(entries.size() - 1));
  const auto n = std::min(static_cast<std::size_t>(place), entries.size() - 2);
  return std::pair(n, place - static_cast<double>(n));
}

}  // namespace

template <int Dim>
GradedSums<Dim>::GradedSums(const Kernel<Dim>& kernel, double spacing, SpacingField<Dim> field)
    : kernel_(kernel), spacing_(spacing), field_(std::move(field)), lattices_(ratios) {
  for (int n = 0; n < ratios; ++n) {
    const double ratio = least_ratio + (largest_ratio - least_ratio) * n / (ratios - 1);
    lattices_[n] = lattice_sums<Dim>(kernel, ratio * spacing);
  }
}

template <int Dim>
LatticeSums GradedSums<Dim>::lattice(double relative_spacing, double volume) const {
  const double ratio = edge_of<Dim>(volume) / (relative_spacing * spacing_);
  const auto [n, share] = interpolate(lattices_, (ratio - least_ratio) / (largest_ratio - least_ratio) * (ratios - 1));
  const LatticeSums& low = lattices_[n];
  const LatticeSums& high = lattices_[n + 1];
  return {std::lerp(low.concentration, high.concentration, share),
          std::lerp(low.morris, high.morris, share) / (relative_spacing * relative_spacing),
          std::lerp(low.across_plane, high.across_plane, share) / relative_spacing};
}

template <int Dim>
double GradedSums<Dim>::lattice_slope(double relative_spacing, double volume) const {
  const double ratio = edge_of<Dim>(volume) / (relative_spacing * spacing_);
  const double entries_per_ratio = (ratios - 1) / (largest_ratio - least_ratio);
  const auto [n, share] = interpolate(lattices_, (ratio - least_ratio) * entries_per_ratio);
  const double low = lattices_[n].concentration;
  const double high = lattices_[n + 1].concentration;
  return -ratio * (high - low) * entries_per_ratio / std::lerp(low, high, share);
}

template <int Dim>
ContinuumSums<Dim> GradedSums<Dim>::continuum(const Vec<Dim>& x) const {
  const double own = field_.at(x);
  const double reach = 0.5 * kernel_radius(kernel_) * (own + 1.0);
  const double step = reach / points_along_radius;
  double sum = 0.0;
  double of_uniform = 0.0;
  double moment_of_uniform = 0.0;
  Vec<Dim> gradient = Vec<Dim>::Zero();
  Packed<Dim> moment = Packed<Dim>::Zero();
  const int last_z = Dim == 3 ? points_along_radius : 0;
  for (int c = -last_z; c <= last_z; ++c) {
    for (int b = -points_along_radius; b <= points_along_radius; ++b) {
      for (int a = -points_along_radius; a <= points_along_radius; ++a) {
        Vec<Dim> s;
        s[0] = step * a;
        s[1] = step * b;
        if constexpr (Dim == 3) s[2] = step * c;
        const double r = s.norm();
        if (r >= reach) continue;
        const double mean = 0.5 * (own + field_.at(Vec<Dim>(x + s)));
        sum += kernel_value(kernel_, r / mean) / power<Dim>(mean);
        of_uniform += kernel_value(kernel_, r / own) / power<Dim>(own);
        if (r == 0.0) continue;
        const double F = kernel_steepness(kernel_, r / mean) / (power<Dim>(mean) * mean * mean);
        gradient += F * s;
        moment += F * packed_dyad<Dim>(s);
        moment_of_uniform += kernel_steepness(kernel_, r / own) / (power<Dim>(own) * own * own) * r * r / Dim;
      }
    }
  }
  return {sum / of_uniform, gradient / of_uniform, moment / moment_of_uniform};
}

template class GradedSums<2>;
template class GradedSums<3>;

}  // namespace tailwater
