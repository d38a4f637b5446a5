#include "flow/step.h"

namespace tailwater {

Interventions& Interventions::operator+=(const Interventions& other) {
  stopped_at_walls += other.stopped_at_walls;
  capped_shifts += other.capped_shifts;
  fallback_rows += other.fallback_rows;
  restarted_solves += other.restarted_solves;
  return *this;
}

void StepReport::add(const PressureReport& pressure) {
  ++passes;
  iterations += pressure.iterations;
  residual = pressure.residual;
  interventions += pressure.interventions;
}

}  // namespace tailwater
