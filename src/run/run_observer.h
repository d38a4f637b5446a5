// What may follow the steps of a run: its output, or nothing. Whoever observes a flow does not change it.
#pragma once

#include "flow/flow.h"
#include "flow/measure.h"
#include "flow/step.h"

namespace tailwater {

/// Called at the moments of a run, in order. All functions are collective.
template <int Dim>
class RunObserver {
 public:
  virtual ~RunObserver() = default;

  /// The pressure at the start is found.
  virtual void started(const Flow<Dim>& flow) = 0;
  /// A step is about to be made ready.
  virtual void before_step(const Flow<Dim>& flow) = 0;
  /// Particles were handed to the ranks that own their places, and sorted.
  virtual void repartitioned(const Flow<Dim>& flow, const Repartition& repartition) = 0;
  /// The state is complete: a run can go on from it. `reference_step` [s] is that of the guard (step_guard.h).
  virtual void can_go_on(const Flow<Dim>& flow, double reference_step) = 0;
  /// A step was taken.
  virtual void stepped(const Flow<Dim>& flow, const StepReport& report) = 0;
};

}  // namespace tailwater
