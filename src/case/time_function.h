// Quantities that vary with time: a number, an expression of t, or a time series.
#pragma once

#include <memory>
#include <vector>

#include "case/expression.h"
#include "case/spec.h"

namespace tailwater {

/// A smooth curve through the points of a series: cubic between two of them, with a continuous slope, and nowhere
/// beyond its neighbours (Fritsch & Butland 1984). Before the first and after the last point it keeps their values.
class SmoothCurve {
 public:
  /// `times` ascend; as many `values`, at least one.
  SmoothCurve(std::vector<double> times, std::vector<double> values);

  double at(double time) const;
  const std::vector<double>& times() const { return times_; }

 private:
  std::vector<double> times_;
  std::vector<double> values_;
  std::vector<double> slopes_;  ///< at the points
};

/// A quantity of the case as a function of the time. Copies share what they are made of.
class TimeFunction {
 public:
  TimeFunction() = default;  ///< 0
  explicit TimeFunction(SmoothCurve series);
  TimeFunction(const Varying& value, const NamedNumbers& numbers);

  /// It may be infinite or not a number if it is an expression.
  double at(double time) const;
  /// The series; null if it is none.
  const SmoothCurve* series() const { return series_.get(); }

 private:
  double number_ = 0.0;
  std::shared_ptr<Formula> formula_;  ///< not const: evaluating writes the time into it
  std::shared_ptr<const SmoothCurve> series_;
};

}  // namespace tailwater
