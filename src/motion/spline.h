// A smooth curve through samples.
#pragma once

#include <vector>

namespace tailwater {

/// The natural cubic spline: piecewise cubic, with continuous first and second derivatives, and no second derivative at
/// its ends (C. de Boor, A Practical Guide to Splines, 1978, ch. IV). It keeps straight lines, and errs by O(h^4) on
/// smooth functions away from its ends, for samples h apart. Beyond the ends it goes on straight.
class Spline {
 public:
  /// At least two samples, with `times` ascending.
  Spline(std::vector<double> times, std::vector<double> values);

  double at(double time) const;

 private:
  std::vector<double> time_;
  std::vector<double> value_;
  std::vector<double> slope_;  ///< at each sample
};

}  // namespace tailwater
