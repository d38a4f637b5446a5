// Monitors the steps of a run: the solution must stay finite, and the time step must not collapse. Restores the last
// good state when a step fails, and reports the failure. Functions are collective.
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

  /// A failed run leaves a report in this folder, which is borrowed; without it there is only the error.
  void report_to(const RunFolder& folder) { folder_ = &folder; }

  /// Fails the run if the next step `dt` [s] is below the limit: an error now is better than a run that never ends. The
  /// message names the term of the time-step rule, and the particle or the wall behind it.
  void require_sound_step(double dt);

  /// s; the step at the start, the reference for later ones; for a checkpoint, and from one.
  double reference_step() const { return reference_step_; }
  void restore_reference_step(double step) { reference_step_ = step; }

  /// Calls `work`, a part of the solution that starts from the present state. Fails the run if `work` throws a
  /// SolverError or leaves a value that is not finite. If both happen, the report names the particle with that value,
  /// because the error follows from it. `start` has the positions and velocities of the present state; it is borrowed,
  /// as a copy would be large. `work` may fill it, as long as no particle has moved. Particles must keep their indices.
  void attempt(const StepStart<Dim>& start, const std::function<void()>& work);

 private:
  template <class Describe>
  [[noreturn]] void blame(std::optional<std::size_t> culprit, const Describe& describe);
  [[noreturn]] void fail(const std::string& reason, std::optional<std::size_t> culprit);
  /// The particles before the present attempt, or the present ones if there is none.
  Particles<Dim> last_good() const;

  Flow<Dim>& flow_;
  const RunFolder* folder_ = nullptr;
  double reference_step_ = 0.0;  ///< s; 0 before the first step

  /// The data of particles that a step changes; empty where it cannot.
  struct Good {
    const StepStart<Dim>& start;
    double time;        ///< s
    std::size_t count;  ///< number of owned particles
    std::vector<double> pressure = {};
    std::vector<double> second_pressure = {};
    std::vector<double> layer_viscosity = {};
    std::vector<double> wall_distance = {};
  };
  std::optional<Good> good_;  ///< set during an attempt
};

}  // namespace tailwater
