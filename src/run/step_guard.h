// Watches over the steps of a run: what it solves for must stay finite, and its time step must not collapse. Keeps the
// last good state for the report of a run that fails. Functions are collective.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "flow/flow.h"
#include "io/run_folder.h"

namespace tailwater {

template <int Dim>
class StepGuard {
 public:
  /// Borrows both.
  StepGuard(Flow<Dim>& flow, const RunFolder& folder) : flow_(flow), folder_(folder) {}

  /// The present state is good. An index must mean the same particle in it and after the step: to be called again where
  /// indices change.
  void remember_good();

  /// Fails the run if the next step of `dt` [s] is so short that some particle must have run away.
  void require_sound_step(double dt);

  /// Does a part of the solution; fails the run if `work` throws a SolverError or leaves a value that is not finite. A
  /// particle that is not finite is told before what followed from it.
  void attempt(const std::function<void()>& work);

 private:
  template <class Describe>
  [[noreturn]] void blame(std::optional<std::size_t> culprit, const Describe& describe);
  [[noreturn]] void fail(const std::string& reason, std::optional<std::size_t> culprit);

  Flow<Dim>& flow_;
  const RunFolder& folder_;
  Particles<Dim> last_good_;
  double last_good_time_ = 0.0;
};

}  // namespace tailwater
