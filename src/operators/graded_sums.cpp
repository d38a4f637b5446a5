#include "operators/graded_sums.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace tailwater {
namespace {

/// Points of the quadrature along the radius of a support.
constexpr int points_along_radius = 8;

/// Volumes over (h dx)^Dim of which the sums are tabulated: lattice spacings from 0.3 to 2 h dx. Volumes keep within
/// half and 1.34 of the wanted ones, those of walls within a third and 2.
template <int Dim>
constexpr double min_volume = Dim == 2 ? 0.09 : 0.027;
template <int Dim>
constexpr double largest_volume = Dim == 2 ? 4.0 : 8.0;
constexpr double entries_per_volume = 100.0;

/// Depths behind a plane surface, within the radius of a support, and points of the integrals over planes.
constexpr int depths_behind_surface = 100;

/// 1/m; integral of the kernel over the plane at a distance.
template <int Dim>
double integral_over_plane(const Kernel<Dim>& kernel, double distance) {
  const double radius = kernel_radius(kernel);
  const double reach = std::sqrt(std::max(0.0, radius * radius - distance * distance));
  const double step = reach / depths_behind_surface;
  double sum = 0.0;
  for (int n = 0; n < depths_behind_surface; ++n) {
    const double r = (n + 0.5) * step;
    const double ring = Dim == 2 ? 2.0 : 2.0 * std::numbers::pi * r;
    sum += ring * step * kernel_value(kernel, std::hypot(distance, r));
  }
  return sum;
}

}  // namespace

template <int Dim>
GradedSums<Dim>::GradedSums(const Kernel<Dim>& kernel, double spacing, SpacingField<Dim> field)
    : kernel_(kernel), spacing_(spacing), field_(std::move(field)), behind_surface_(sums_behind_surface(kernel)) {
  const int last = static_cast<int>(std::ceil((largest_volume<Dim> - min_volume<Dim>)*entries_per_volume));
  for (int n = 0; n <= last; ++n) {
    const double volume = min_volume<Dim> + n / entries_per_volume;
    lattices_.push_back(lattice_sums<Dim>(kernel, edge_of<Dim>(volume) * spacing));
  }
}

template <int Dim>
typename GradedSums<Dim>::Entry GradedSums<Dim>::entry(double relative_spacing, double volume) const {
  const double relative_volume = volume / power<Dim>(relative_spacing * spacing_);
  const double place = std::clamp((relative_volume - min_volume<Dim>)*entries_per_volume, 0.0,
                                  static_cast<double>(lattices_.size() - 1));
  const auto n = std::min(static_cast<std::size_t>(place), lattices_.size() - 2);
  return {lattices_[n], lattices_[n + 1], place - static_cast<double>(n), relative_volume};
}

template <int Dim>
LatticeSums GradedSums<Dim>::lattice(double relative_spacing, double volume) const {
  const auto [low, high, share, relative_volume] = entry(relative_spacing, volume);
  return {std::lerp(low.concentration, high.concentration, share),
          std::lerp(low.morris, high.morris, share) / (relative_spacing * relative_spacing),
          std::lerp(low.across_plane, high.across_plane, share) / relative_spacing};
}

template <int Dim>
double GradedSums<Dim>::lattice_concentration(double relative_spacing, double volume) const {
  const auto [low, high, share, relative_volume] = entry(relative_spacing, volume);
  return low.concentration + share * (high.concentration - low.concentration);
}

template <int Dim>
double GradedSums<Dim>::lattice_slope(double relative_spacing, double volume) const {
  const auto [low, high, share, relative_volume] = entry(relative_spacing, volume);
  const double difference = high.concentration - low.concentration;
  return -Dim * relative_volume * entries_per_volume * difference / (low.concentration + share * difference);
}

template <int Dim>
std::vector<typename GradedSums<Dim>::BehindSurface> GradedSums<Dim>::sums_behind_surface(const Kernel<Dim>& kernel) {
  const double step = kernel_radius(kernel) / depths_behind_surface;
  double filled = 0.5;
  std::vector<BehindSurface> places{{filled, 0.0}};
  for (int n = 1; n <= depths_behind_surface; ++n) {
    filled += step * integral_over_plane(kernel, (n - 0.5) * step);
    // A larger support acts at a fixed depth as a smaller depth does.
    places.push_back({filled, n * step * integral_over_plane(kernel, n * step)});
  }
  return places;
}

template <int Dim>
double GradedSums<Dim>::change_at_surface(double filled) const {
  const auto above = std::ranges::upper_bound(behind_surface_, filled, {}, &BehindSurface::filled);
  if (above == behind_surface_.begin() || above == behind_surface_.end()) return 0.0;
  const BehindSurface& below = *std::prev(above);
  return std::lerp(below.change, above->change, (filled - below.filled) / (above->filled - below.filled));
}

template <int Dim>
ContinuumSums<Dim> GradedSums<Dim>::continuum(const Vec<Dim>& x) const {
  const double own = field_.at_drawn(x);
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
        const double mean = 0.5 * (own + field_.at_drawn(Vec<Dim>(x + s)));
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
