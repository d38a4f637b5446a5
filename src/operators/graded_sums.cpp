#include "operators/graded_sums.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tailwater {
namespace {

/// Points of the quadrature along the radius of a support.
constexpr int points_along_radius = 8;

/// Entries of a face's table per dx.
constexpr int entries_per_spacing = 16;

/// Lattice spacings over dx at a support of the case's, of which the sums are tabulated. Volumes keep within half and
/// 1.34 of the wanted ones, those of walls within a third and 2.
constexpr double least_ratio = 0.3;
constexpr double largest_ratio = 2.0;
constexpr int ratios = 171;

/// Sums on a lattice of points around `x`, over the same of a uniform field.
template <int Dim, class Spacing>
ContinuumSums<Dim> integrate(const Kernel<Dim>& kernel, const Vec<Dim>& x, const Spacing& spacing) {
  const double radius = kernel_radius(kernel);
  const double own = spacing(x);
  const double reach = 0.5 * radius * (own + 1.0);
  const double step = reach / points_along_radius;
  double sum = 0.0;
  double of_uniform = 0.0;
  Vec<Dim> gradient = Vec<Dim>::Zero();
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
        const double mean = 0.5 * (own + spacing(Vec<Dim>(x + s)));
        sum += kernel_value(kernel, r / mean) / power<Dim>(mean);
        of_uniform += kernel_value(kernel, r / own) / power<Dim>(own);
        if (r > 0.0) gradient += kernel_steepness(kernel, r / mean) / (power<Dim>(mean) * mean * mean) * s;
      }
    }
  }
  return {sum / of_uniform, gradient / of_uniform};
}

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
  for (const auto& zone : field_.zones()) {
    if (!of_level_.contains(zone.level)) of_level_.emplace(zone.level, tabulate(zone.level));
  }
}

template <int Dim>
typename GradedSums<Dim>::FaceTable GradedSums<Dim>::tabulate(int level) const {
  const double radius = kernel_radius(kernel_);
  const double border = border_per_level * level * spacing_;
  FaceTable table{-radius, spacing_ / entries_per_spacing, {}, {}};
  const int entries = static_cast<int>(std::ceil((border + 2.0 * radius) / table.step)) + 1;
  for (int n = 0; n < entries; ++n) {
    const Vec<Dim> x = (table.first + n * table.step) * Vec<Dim>::Unit(0);
    const ContinuumSums<Dim> sums =
        integrate<Dim>(kernel_, x, [&](const Vec<Dim>& y) { return spacing_behind_face(level, y[0] / border); });
    table.concentration.push_back(sums.concentration);
    table.gradient.push_back(sums.gradient[0]);
  }
  return table;
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
ContinuumSums<Dim> GradedSums<Dim>::continuum(const Vec<Dim>& x) const {
  using Kind = typename SpacingNearby<Dim>::Kind;
  const SpacingNearby<Dim> nearby = field_.nearby(x, kernel_radius(kernel_));
  if (nearby.kind == Kind::uniform) return {};
  if (nearby.kind == Kind::any) {
    return integrate<Dim>(kernel_, x, [this](const Vec<Dim>& y) { return field_.at(y); });
  }
  const FaceTable& table = of_level_.at(nearby.level);
  const auto [n, share] = interpolate(table.concentration, (nearby.depth - table.first) / table.step);
  return {std::lerp(table.concentration[n], table.concentration[n + 1], share),
          std::lerp(table.gradient[n], table.gradient[n + 1], share) * nearby.inwards};
}

template class GradedSums<2>;
template class GradedSums<3>;

}  // namespace tailwater
