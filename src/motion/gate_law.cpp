#include "motion/gate_law.h"

#include <algorithm>

namespace tailwater {

GateLaw::GateLaw(const GateTable& gate, double length, double gravity)
    : start_(gate.start), travel_(gate.travel > 0.0 ? gate.travel : length) {
  switch (gate.motion) {
    case GateMotion::speed:
      speed_ = gate.speed;
      break;
    case GateMotion::acceleration:
      acceleration_ = gate.acceleration;
      break;
    case GateMotion::falling_weight:
      // The weight and the gate hang on one rope over a pulley: G. Atwood (1784).
      acceleration_ = gravity * (gate.weight - gate.gate_mass) / (gate.weight + gate.gate_mass);
      break;
    case GateMotion::file:
      file_.emplace(gate.series.time, gate.series.columns[0]);
      break;
  }
}

double GateLaw::way(double time) const {
  if (file_) return file_->at(std::max(0.0, time - start_));
  const double since = time - start_;
  if (since <= 0.0) return 0.0;
  return std::min(speed_ * since + 0.5 * acceleration_ * since * since, travel_);
}

}  // namespace tailwater
