// Displacement of a gate over time.
#pragma once

#include <optional>

#include "case/spec.h"
#include "motion/spline.h"

namespace tailwater {

class GateLaw {
 public:
  /// `length` [m] is the gate's own in the direction of its motion.
  GateLaw(const GateTable& gate, double length);

  /// Its displacement [m] at `time` [s].
  double displacement(double time) const;

 private:
  double start_;
  double speed_ = 0.0;         ///< m/s
  double acceleration_ = 0.0;  ///< m/s^2
  double travel_;              ///< m; where it stops
  std::optional<Spline> file_;
};

}  // namespace tailwater
