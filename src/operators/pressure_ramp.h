// A pressure that begins below a level and, some spacings further down, grows in proportion to the depth, with its sums
// over the pairs of a full lattice.
#pragma once

#include <vector>

#include "kernel/kernel.h"

namespace tailwater {

/// Depths count from the level, downwards [m]. The pressure is given over its largest gradient.
class PressureRamp {
 public:
  template <int Dim>
  PressureRamp(const Kernel<Dim>& kernel, double spacing);

  double at(double depth) const;  ///< m
  /// 1; the gradient by the pairs of a lattice, which is exact for a linear pressure.
  double gradient_at(double depth) const;
  /// m; the pressure on a level wall that carries the water above it: the integral of `gradient_at` over the depth.
  double on_level_wall(double depth) const;
  /// 1/m; the sum of Morris weights c_ij (q_i - q_j) over a lattice.
  double morris_sum_at(double depth) const;

 private:
  double entry_of(const std::vector<double>& table, double depth, double beyond) const;

  double length_;  ///< m; over which the gradient grows
  double first_;   ///< m; depth of the first entry of the tables
  double step_;    ///< m; between entries
  std::vector<double> gradient_;
  std::vector<double> on_level_wall_;
  std::vector<double> morris_sum_;
};

}  // namespace tailwater
