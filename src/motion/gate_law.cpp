#include "motion/gate_law.h"

#include <algorithm>

namespace tailwater {

GateLaw::GateLaw(const GateTable& gate, double length)
    : start_(gate.start), travel_(gate.travel > 0.0 ? gate.travel : length) {
  switch (gate.motion) {
    case GateMotion::speed:
      speed_ = gate.speed;
      break;
    case GateMotion::acceleration:
      acceleration_ = gate.acceleration;
      break;
    case GateMotion::file:
      file_.emplace(gate.series.time, gate.series.columns[0]);
      break;
  }
}

double GateLaw::displacement(double time) const {
  if (file_) return file_->at(std::max(0.0, time - start_));
  const double since = time - start_;
  if (since <= 0.0) return 0.0;
  return std::min(speed_ * since + 0.5 * acceleration_ * since * since, travel_);
}

}  // namespace tailwater
