// What a velocity that swings about 0 tells: the period, and how much of it is kept.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace tailwater {

class Oscillation {
 public:
  explicit Oscillation(double velocity) : before_(velocity), most_(std::abs(velocity)) {}

  /// Takes the velocity [m/s] at `time` [s], dt after the last.
  void add(double time, double dt, double velocity) {
    if (before_ < 0.0 && velocity >= 0.0) {
      turns_.push_back(time - dt * velocity / (velocity - before_));
      largest_.push_back(most_);
      most_ = 0.0;
    }
    most_ = std::max(most_, std::abs(velocity));
    before_ = velocity;
  }

  /// How often it has turned upwards.
  std::size_t turns() const { return turns_.size(); }

  /// s; mean, after two turns or more.
  double period() const { return (turns_.back() - turns_.front()) / rounds(); }

  /// Of the largest velocity, per period; after three turns or more.
  double kept() const { return std::pow(largest_.back() / largest_[1], 1.0 / (rounds() - 1.0)); }

 private:
  double rounds() const { return static_cast<double>(turns_.size() - 1); }

  std::vector<double> turns_;    ///< s
  std::vector<double> largest_;  ///< m/s; before each
  double before_;
  double most_;
};

}  // namespace tailwater
