// Period and decay of a velocity that oscillates about 0.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace tailwater {

class Oscillation {
 public:
  explicit Oscillation(double velocity) : before_(velocity), most_(std::abs(velocity)) {}

  /// Adds the velocity [m/s] at `time` [s], dt after the previous one.
  void add(double time, double dt, double velocity) {
    if (before_ < 0.0 && velocity >= 0.0) {
      turns_.push_back(time - dt * velocity / (velocity - before_));
      largest_.push_back(most_);
      most_ = 0.0;
    }
    most_ = std::max(most_, std::abs(velocity));
    before_ = velocity;
  }

  /// Number of upward zero crossings.
  std::size_t turns() const { return turns_.size(); }

  /// Mean period, s; after two crossings or more.
  double period() const { return (turns_.back() - turns_.front()) / rounds(); }

  /// Ratio of successive largest velocities, per period; after three crossings or more.
  double kept() const { return std::pow(largest_.back() / largest_[1], 1.0 / (rounds() - 1.0)); }

 private:
  double rounds() const { return static_cast<double>(turns_.size() - 1); }

  std::vector<double> turns_;    ///< s; times of the upward crossings
  std::vector<double> largest_;  ///< m/s; before each crossing
  double before_;
  double most_;
};

}  // namespace tailwater
