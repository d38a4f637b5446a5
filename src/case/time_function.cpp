#include "case/time_function.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/assert.h"

namespace tailwater {
namespace {

/// Slope at a point between two intervals of lengths h and rises d per time: 0 at a peak, else between the two rises.
double slope_between(double h_left, double d_left, double h_right, double d_right) {
  if (d_left * d_right <= 0.0) return 0.0;
  const double share = (h_left + 2.0 * h_right) / (3.0 * (h_left + h_right));
  return d_left * d_right / (share * d_right + (1.0 - share) * d_left);
}

}  // namespace

SmoothCurve::SmoothCurve(std::vector<double> times, std::vector<double> values)
    : times_(std::move(times)), values_(std::move(values)), slopes_(times_.size(), 0.0) {
  TAILWATER_ASSERT(!times_.empty() && times_.size() == values_.size(), "a series has a value for each of its times");
  const auto length = [&](std::size_t k) { return times_[k + 1] - times_[k]; };
  const auto rise = [&](std::size_t k) { return (values_[k + 1] - values_[k]) / length(k); };
  for (std::size_t k = 1; k + 1 < times_.size(); ++k) {
    slopes_[k] = slope_between(length(k - 1), rise(k - 1), length(k), rise(k));
  }
}

double SmoothCurve::at(double time) const {
  if (time <= times_.front()) return values_.front();
  if (time >= times_.back()) return values_.back();
  const auto k = static_cast<std::size_t>(std::upper_bound(times_.begin(), times_.end(), time) - times_.begin()) - 1;
  const double h = times_[k + 1] - times_[k];
  const double s = (time - times_[k]) / h;
  const double smooth = s * s * (3.0 - 2.0 * s);  // the Hermite cubics
  return std::lerp(values_[k], values_[k + 1], smooth) +
         h * s * (1.0 - s) * ((1.0 - s) * slopes_[k] - s * slopes_[k + 1]);
}

std::span<const std::string_view> names_of_level(const NamedNumbers& numbers) {
  return std::span(level_names).first(numbers.contains(level_names[1]) ? 1 : 2);
}

TimeFunction::TimeFunction(SmoothCurve series) : series_(std::make_shared<const SmoothCurve>(std::move(series))) {}

TimeFunction::TimeFunction(const Varying& value, const NamedNumbers& numbers, std::span<const std::string_view> names)
    : variables_(names.size()) {
  if (const auto* number = std::get_if<double>(&value)) {
    number_ = *number;
  } else {
    formula_ = std::make_shared<Formula>(std::get<std::string>(value), numbers, names);
  }
}

double TimeFunction::at(double time, double discharge) const {
  if (series_) return series_->at(time);
  const std::array variables{time, discharge};
  return formula_ ? formula_->at(std::span(variables).first(variables_)) : number_;
}

}  // namespace tailwater
