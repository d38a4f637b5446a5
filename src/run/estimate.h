// What a run will take, before it is started: time steps, memory, hours.
#pragma once

#include "case/spec.h"
#include "flow/flow.h"

namespace tailwater {

struct RunEstimate {
  double fluid_particles = 0.0;
  double wall_particles = 0.0;
  double memory = 0.0;   ///< bytes
  double steps = 0.0;    ///< to the end, if speeds stay near those of free fall through the fluid's height
  double seconds = 0.0;  ///< of this machine, from trial steps
};

/// Throws InputError if the end time is one that no run reaches, however quiet its flow.
void require_reachable_end(const CaseSpec& spec, const TimeStepRule& rule);

/// Runs a few trial steps of `flow`, which was made from `spec`.
template <int Dim>
RunEstimate estimate_run(const CaseSpec& spec, Flow<Dim>& flow);

}  // namespace tailwater
