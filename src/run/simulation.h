// A run as an object that steps: the flow of a case, in memory. It writes nothing itself; an observer may do that
// (folder_output.h). `run_case` is this loop with a folder:
//
//   Simulation<2> simulation(spec);
//   for (simulation.start(); !simulation.has_ended(); simulation.step()) {
//     // read simulation.flow()
//   }
//
// A program that adds forces (parts/script_loads.h) does so between `prepare` and `step`, when particles have the
// indices of the coming step.
#pragma once

#include "case/spec.h"
#include "flow/flow.h"
#include "parallel/communicator.h"
#include "run/run_observer.h"
#include "run/step_guard.h"

namespace tailwater {

/// Functions are collective. MPI and PETSc must run (linear/session.h).
template <int Dim>
class Simulation {
 public:
  /// Builds the flow of a case, whose geometry is sound (require_sound_geometry). Throws InputError.
  explicit Simulation(const CaseSpec& spec, const Communicator& ranks = {});
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  const Flow<Dim>& flow() const { return flow_; }
  Flow<Dim>& flow() { return flow_; }

  /// Borrows the observer, and the folder, where a failed step leaves the last good fields and a report.
  void observe(RunObserver<Dim>& observer, const RunFolder& folder);

  /// Computes the pressure at the start. Throws SolverError.
  void start();

  /// Whether the time has reached the end of the case, or its liquid is at rest where that ends the case.
  bool has_ended() const;

  /// Prepares the next step: particles are repartitioned, water leaves and enters at open ends. Returns its size [s].
  /// Throws SolverError when the size has collapsed. Does nothing if a step is prepared already.
  double prepare();
  bool is_prepared() const { return dt_ > 0.0; }
  /// Call after the motion of walls was set again: shortens the prepared step if walls go too far in it. Returns its
  /// size.
  double shorten();

  /// Takes a step, with the loads of a script, which are then discarded. Prepares it first if needed. Throws
  /// SolverError when the step fails; the flow then has the state before the step.
  StepReport step();

  /// Resumes from a saved flow, with its `reference_step` [s]. `cuts` are those of its space, if particles are
  /// distributed by them. Returns false if its walls, their motion or its parts are not those of the case.
  bool go_on_from(SavedFlow<Dim> saved, double reference_step, std::optional<std::string> cuts);

 private:
  void rearrange();
  bool fits(State<Dim>& state);

  double end_;  ///< s
  Flow<Dim> flow_;
  StepGuard<Dim> guard_{flow_};
  RunObserver<Dim>* observer_ = nullptr;
  double dt_ = 0.0;                     ///< s; size of the prepared step, or 0
  std::int64_t repartition_step_ = -1;  ///< step at which particles are as in a checkpoint
};

}  // namespace tailwater
