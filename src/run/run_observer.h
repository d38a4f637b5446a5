// An observer of the steps of a run, such as its output. An observer does not change the flow.
#pragma once

#include "flow/flow.h"
#include "flow/measure.h"
#include "flow/step.h"
#include "neighbours/decomposition.h"

namespace tailwater {

/// The functions are called in the order of the events of a run. All are collective.
template <int Dim>
class RunObserver {
 public:
  virtual ~RunObserver() = default;

  /// The pressure at the start has been computed.
  virtual void started(const Flow<Dim>& flow) = 0;
  /// A step is about to be prepared.
  virtual void before_step(const Flow<Dim>& flow) = 0;
  /// Particles have been moved to the ranks that own their places, and sorted.
  virtual void repartitioned(const Flow<Dim>& flow, const Repartition& repartition) = 0;
  /// The state is complete: a run can resume from it. `reference_step` [s] is that of the guard (step_guard.h).
  virtual void can_go_on(const Flow<Dim>& flow, double reference_step) = 0;
  /// A step was taken.
  virtual void stepped(const Flow<Dim>& flow, const StepReport& report) = 0;
};

}  // namespace tailwater
