// Quantities that vary with time: a number, an expression of t, or a time series.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "case/expression.h"
#include "case/spec.h"

namespace tailwater {

/// A smooth curve through the points of a series: cubic between two points, with a continuous slope, and always within
/// their values (Fritsch & Butland 1984). Before the first and after the last point it keeps their values.
class SmoothCurve {
 public:
  /// `times` ascend; there are as many `values`, at least one.
  SmoothCurve(std::vector<double> times, std::vector<double> values);

  double at(double time) const;
  const std::vector<double>& times() const { return times_; }

 private:
  std::vector<double> times_;
  std::vector<double> values_;
  std::vector<double> slopes_;  ///< slopes at the points
};

/// The variables of a level's expression (level_names), without the discharge if a parameter has its name.
std::span<const std::string_view> names_of_level(const NamedNumbers& numbers);

/// A quantity of the case as a function of the time; a level may also depend on the discharge. Copies use the same
/// data.
class TimeFunction {
 public:
  TimeFunction() = default;  ///< 0
  explicit TimeFunction(SmoothCurve series);
  TimeFunction(const Varying& value, const NamedNumbers& numbers, std::span<const std::string_view> names = time_name);

  /// May be infinite or not a number for an expression. `discharge` [m^3/s] is for levels that depend on it.
  double at(double time, double discharge = 0.0) const;
  /// The series; null for other quantities.
  const SmoothCurve* series() const { return series_.get(); }

 private:
  double number_ = 0.0;
  std::shared_ptr<Formula> formula_;  ///< not const, because an evaluation writes the variables into it
  std::size_t variables_ = 1;         ///< number of variables of the formula: the time, and the discharge
  std::shared_ptr<const SmoothCurve> series_;
};

}  // namespace tailwater
