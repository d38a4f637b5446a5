// Watches over the steps of a run: the solution must stay finite, and the time step must not collapse. Puts the last
// good state back when a step fails, and reports it. Functions are collective.
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

  /// Fails the run if the next step `dt` [s] is below the limit: an error now is better than a run that never ends. The
  /// message names the term of the time-step rule, and the particle or the wall behind it.
  void require_sound_step(double dt);

  /// s; the step at the start, with which later ones are compared; for a checkpoint, and from one.
  double reference_step() const { return reference_step_; }
  void restore_reference_step(double step) { reference_step_ = step; }

  /// Does a part of the solution, which goes on from the present state. Fails the run if `work` throws a SolverError or
  /// leaves a value that is not finite. If both happen it reports the particle with that value, because the error
  /// follows from it. `start` has the positions and velocities of the present state, and is borrowed, as a copy of them
  /// would be large; `work` may fill it, as long as no particle has moved. Indices must keep their particles.
  void attempt(const StepStart<Dim>& start, const std::function<void()>& work);

 private:
  template <class Describe>
  [[noreturn]] void blame(std::optional<std::size_t> culprit, const Describe& describe);
  [[noreturn]] void fail(const std::string& reason, std::optional<std::size_t> culprit);
  /// The particles as they were before what is attempted, or as they are.
  Particles<Dim> last_good() const;

  Flow<Dim>& flow_;
  const RunFolder* folder_ = nullptr;
  double reference_step_ = 0.0;  ///< s; 0 before the first step

  /// What a step changes of particles; empty where it cannot.
  struct Good {
    const StepStart<Dim>& start;
    double time;        ///< s
    std::size_t count;  ///< owned
    std::vector<double> pressure = {};
    std::vector<double> second_pressure = {};
    std::vector<double> layer_viscosity = {};
    std::vector<double> wall_distance = {};
  };
  std::optional<Good> good_;  ///< while something is attempted
};

}  // namespace tailwater
