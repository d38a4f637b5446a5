#include "closures/air.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tailwater {
namespace {

/// Quadrature points along the support radius; with these the factors are accurate to 1e-3.
constexpr int points = 256;

/// Integral of -dW/dr / r over the plane at distance `z` from the particle.
template <int Dim>
double plane_weight(const Kernel<Dim>& kernel, double z) {
  const double step = kernel_radius(kernel) / points;
  double sum = 0.0;
  for (int k = 0; k < points; ++k) {
    const double s = (k + 0.5) * step;
    const double r = std::hypot(s, z);
    sum += (Dim == 2 ? 2.0 : 2.0 * std::numbers::pi * s) * kernel_steepness(kernel, r) * step;
  }
  return sum;
}

}  // namespace

template <int Dim>
AirLaw::AirLaw(const Kernel<Dim>& kernel, double spacing) {
  const double radius = kernel_radius(kernel);
  const double step = radius / points;
  std::array<double, points> weight;
  double half = 0.0;
  for (int k = 0; k < points; ++k) {
    weight[k] = plane_weight<Dim>(kernel, (k + 0.5) * step);
    half += weight[k];
  }
  for (int n = 0; n < depths; ++n) {
    const double depth = radius - (radius - 0.5 * spacing) * n / (depths - 1);
    double missing = 0.0;
    double beyond = 0.0;
    for (int k = 0; k < points; ++k) {
      const double height = (k + 0.5) * step - depth;
      if (height <= 0.0) continue;
      missing += weight[k];
      beyond += weight[k] * height;
    }
    missing_[n] = missing / (2.0 * half);
    factor_[n] = missing > 0.0 ? 1.0 + beyond / (depth * missing) : 1.0;
  }
}

double AirLaw::weight(double sum, double full) const {
  const double missing = full - sum;
  if (missing <= 0.0) return 0.0;
  const double share = missing / full;
  const auto above = std::upper_bound(missing_.begin(), missing_.end(), share);
  if (above == missing_.end()) return missing * factor_.back();
  const auto n = static_cast<std::size_t>(above - missing_.begin());
  const double fraction = (share - missing_[n - 1]) / (missing_[n] - missing_[n - 1]);
  return missing * std::lerp(factor_[n - 1], factor_[n], fraction);
}

template AirLaw::AirLaw(const Kernel<2>&, double);
template AirLaw::AirLaw(const Kernel<3>&, double);

}  // namespace tailwater
