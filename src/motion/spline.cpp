#include "motion/spline.h"

#include <algorithm>
#include <utility>

namespace tailwater {

// The second derivative is continuous at sample k where, with the widths h and the secants s of the pieces beside it,
//   h_k m_{k-1} + 2 (h_{k-1} + h_k) m_k + h_{k-1} m_{k+1} = 3 (h_k s_{k-1} + h_{k-1} s_k)
// for the slopes m; it vanishes at the ends where 2 m_0 + m_1 = 3 s_0 and m_{n-1} + 2 m_n = 3 s_{n-1}. The matrix is
// diagonally dominant, so elimination needs no pivots.
Spline::Spline(std::vector<double> times, std::vector<double> values)
    : time_(std::move(times)), value_(std::move(values)), slope_(time_.size()) {
  const std::size_t last = time_.size() - 1;
  const auto width = [&](std::size_t k) { return time_[k + 1] - time_[k]; };
  const auto secant = [&](std::size_t k) { return (value_[k + 1] - value_[k]) / width(k); };
  std::vector<double> above(time_.size());  // of the diagonal, which elimination makes 1
  above[0] = 0.5;
  slope_[0] = 1.5 * secant(0);
  for (std::size_t k = 1; k <= last; ++k) {
    const bool is_end = k == last;
    const double below = is_end ? 1.0 : width(k);
    const double diagonal = (is_end ? 2.0 : 2.0 * (width(k - 1) + width(k))) - below * above[k - 1];
    const double right = 3.0 * (is_end ? secant(k - 1) : width(k) * secant(k - 1) + width(k - 1) * secant(k));
    above[k] = is_end ? 0.0 : width(k - 1) / diagonal;
    slope_[k] = (right - below * slope_[k - 1]) / diagonal;
  }
  for (std::size_t k = last; k-- > 0;) slope_[k] -= above[k] * slope_[k + 1];
}

double Spline::at(double time) const {
  if (time <= time_.front()) return value_.front() + slope_.front() * (time - time_.front());
  if (time >= time_.back()) return value_.back() + slope_.back() * (time - time_.back());
  const auto k = static_cast<std::size_t>(std::upper_bound(time_.begin(), time_.end(), time) - time_.begin()) - 1;
  const double h = time_[k + 1] - time_[k];
  const double s = (time - time_[k]) / h;
  const double r = 1.0 - s;
  // The Hermite form.
  return r * r * ((1.0 + 2.0 * s) * value_[k] + h * s * slope_[k]) +
         s * s * ((1.0 + 2.0 * r) * value_[k + 1] - h * r * slope_[k + 1]);
}

}  // namespace tailwater
