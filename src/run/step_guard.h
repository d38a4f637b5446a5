// Watches over the steps of a run: the solution must stay finite, and the time step must not collapse. Keeps the last
// good state for the report of a failed run. Functions are collective.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "flow/flow.h"
#include "io/run_folder.h"

namespace tailwater {

template <int Dim>
class StepGuard {
 public:
  /// Borrows the flow.
  explicit StepGuard(Flow<Dim>& flow) : flow_(flow) {}

  /// A run that fails leaves a report in this folder, which is borrowed; without it there is only the error.
  void report_to(const RunFolder& folder) { folder_ = &folder; }

  /// Keeps the present state as good. Indices must mean the same particles in it and after the step, so call it again
  /// after indices have changed.
  void remember_good();

  /// Fails the run if the next step `dt` [s] is below the limit: an error now is better than a run that never ends. The
  /// message names the term of the time-step rule, and the particle or the wall behind it.
  void require_sound_step(double dt);

  /// s; the step at the start, with which later ones are compared; for a checkpoint, and from one.
  double reference_step() const { return reference_step_; }
  void restore_reference_step(double step) { reference_step_ = step; }

  /// Does a part of the solution. Fails the run if `work` throws a SolverError or leaves a value that is not finite. If
  /// both happen it reports the particle with that value, because the error follows from it.
  void attempt(const std::function<void()>& work);

 private:
  template <class Describe>
  [[noreturn]] void blame(std::optional<std::size_t> culprit, const Describe& describe);
  [[noreturn]] void fail(const std::string& reason, std::optional<std::size_t> culprit);
  /// The particles as they were when they were good.
  Particles<Dim> last_good() const;

  Flow<Dim>& flow_;
  const RunFolder* folder_ = nullptr;
  double reference_step_ = 0.0;  ///< s; 0 before the first step
  std::size_t good_count_ = 0;   ///< owned
  // What a step changes of them.
  std::vector<Vec<Dim>> good_position_;
  std::vector<Vec<Dim>> good_velocity_;
  std::vector<double> good_pressure_;
  std::vector<double> good_second_pressure_;
  std::vector<double> good_layer_viscosity_;
  std::vector<double> good_wall_distance_;
  double last_good_time_ = 0.0;
};

}  // namespace tailwater
