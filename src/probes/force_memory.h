// Largest and mean force that a probe has read so far.
#pragma once

#include <cstddef>
#include <vector>

#include "base/vec.h"

namespace tailwater {

/// As numbers that a checkpoint saves.
template <int Dim>
struct ForceMemory {
  std::vector<double>& numbers;

  static constexpr std::size_t count = 4 + Dim;
  double& last_time() const { return numbers[0]; }        // s
  double& duration() const { return numbers[1]; }         // s; of the impulse
  double& largest() const { return numbers[2]; }          // N
  double& time_of_largest() const { return numbers[3]; }  // s
  Vec<Dim> impulse() const { return Vec<Dim>::Map(numbers.data() + 4); }

  void add(double time, const Vec<Dim>& force) const {
    const double since_last = time - last_time();
    last_time() = time;
    duration() += since_last;
    (since_last * force).add_to(numbers.data() + 4);
    if (force.norm() <= largest()) return;
    largest() = force.norm();
    time_of_largest() = time;
  }

  /// The largest force, its time, and the mean force.
  std::vector<double> totals() const {
    std::vector<double> totals{largest(), time_of_largest()};
    const Vec<Dim> whole = impulse();
    for (const double impulse : whole) totals.push_back(duration() > 0.0 ? impulse / duration() : 0.0);
    return totals;
  }
};

}  // namespace tailwater
