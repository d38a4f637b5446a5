#include "operators/pressure_ramp.h"

#include <cmath>
#include <cstddef>

#include "operators/laplacian_morris.h"
#include "operators/lattice.h"

namespace tailwater {
namespace {

/// dx; over which the gradient grows from 0.
constexpr double rows_of_ramp = 3.0;

/// Entries of the tables per dx.
constexpr int entries_per_spacing = 32;

}  // namespace

template <int Dim>
PressureRamp::PressureRamp(const Kernel<Dim>& kernel, double spacing)
    : length_(rows_of_ramp * spacing), first_(-kernel_radius(kernel)), step_(spacing / entries_per_spacing) {
  const double volume = power<Dim>(spacing);
  for (double depth = first_; depth <= length_ - first_; depth += step_) {
    double difference = 0.0;
    double of_linear = 0.0;
    double morris_sum = 0.0;
    visit_lattice(kernel, spacing, [&](int rows, double r) {
      if (r == 0.0) return;
      const double steepness = kernel_steepness(kernel, r);
      const double down = spacing * rows;
      const double change = at(depth + down) - at(depth);
      difference += steepness * down * change;
      of_linear += steepness * down * down;
      morris_sum -= morris_laplacian_weight(volume, steepness, r * r, spacing) * change;
    });
    const double gradient = difference / of_linear;
    const double above = gradient_.empty() ? 0.0 : on_level_wall_.back() + 0.5 * step_ * (gradient_.back() + gradient);
    gradient_.push_back(gradient);
    on_level_wall_.push_back(above);
    morris_sum_.push_back(morris_sum);
  }
}

/// The gradient grows as t^2 (3 - 2 t) over the length of the ramp.
double PressureRamp::at(double depth) const {
  const double t = depth / length_;
  if (t <= 0.0) return 0.0;
  return length_ * (t < 1.0 ? t * t * t * (1.0 - 0.5 * t) : t - 0.5);
}

double PressureRamp::entry_of(const std::vector<double>& table, double depth, double beyond) const {
  const double place = (depth - first_) / step_;
  if (place <= 0.0) return 0.0;
  const auto n = static_cast<std::size_t>(place);
  if (n + 1 >= table.size()) return beyond;
  return std::lerp(table[n], table[n + 1], place - static_cast<double>(n));
}

double PressureRamp::gradient_at(double depth) const { return entry_of(gradient_, depth, 1.0); }

double PressureRamp::on_level_wall(double depth) const { return entry_of(on_level_wall_, depth, at(depth)); }

double PressureRamp::morris_sum_at(double depth) const { return entry_of(morris_sum_, depth, 0.0); }

template PressureRamp::PressureRamp(const Kernel<2>&, double);
template PressureRamp::PressureRamp(const Kernel<3>&, double);

}  // namespace tailwater
