// A simulation that Python controls: python/tailwater/simulation.py.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bodies/floating_bodies.h"
#include "lender.h"
#include "run/folder_output.h"
#include "run/simulation.h"

namespace tailwater {

/// All ranks of the program. The first call starts MPI and PETSc.
const Communicator& ranks_of_process();

/// All functions are collective. `finish` destroys the flow, even if Python still holds this object: every later access
/// to the flow throws a std::logic_error.
template <int Dim>
class PythonSimulation {
 public:
  /// Checks the case as `run` does. Writes a run folder only if `options` are given.
  PythonSimulation(CaseSpec spec, std::optional<RunOptions> options);

  /// Computes the initial pressure, with the loads that the script has set for the start.
  void start();
  /// Prepares the next step; returns false at the end of the case.
  bool prepare();
  void step();
  /// Ends the output, if there is any. The status is "done" at the end of the case, otherwise "interrupted" with a
  /// checkpoint. If a step failed, `failure` is its message, and the status is "failed".
  void finish(const std::string& failure);

  const CaseSpec& spec() const { return spec_; }
  const State<Dim>& state() const { return flow().state; }
  double dt() const { return dt_; }
  const StepReport& report() const { return report_; }

  pybind11::array position() { return lend().position.template view<double>(owned(), Dim); }
  pybind11::array velocity() { return lend().velocity.template view<double>(owned(), Dim); }
  pybind11::array pressure() { return lend().pressure.template view<double>(owned(), 1); }
  pybind11::array volume() { return lend().volume.template view<double>(owned(), 1); }
  pybind11::array id() { return lend().id.template view<std::int64_t>(owned(), 1); }
  pybind11::array kind() { return lend().kind.template view<std::uint8_t>(owned(), 1); }

  /// Acceleration [m/s^2] of each particle in the next step, writable; initially zero.
  pybind11::array acceleration();

  const std::vector<FloatingBody<Dim>>& bodies() const { return bodies_of(flow()).bodies; }
  const BodyState<Dim>& body(std::size_t b) const { return state().motion.bodies.each.at(b); }
  /// Adds a force, and a moment about the centre of mass, for the next step.
  void push(std::size_t b, const Twist<Dim>& push);

  /// Replaces the discharge of the case from now on. Throws InputError for an inlet without a discharge.
  void set_discharge(const std::string& inlet, double discharge);
  /// Replaces the motion of a moving wall from now on. `path` maps a time [s] to the displacement [m] of the wall from
  /// its position in the case, followed by its angle [rad] if it rotates. Throws InputError for a wall that does not
  /// move or that also reacts to the water, and for a path that begins away from the present position of the wall.
  /// Collective.
  void steer(const std::string& wall, std::function<std::vector<double>(double)> path);

 private:
  struct Lenders {
    explicit Lenders(Flow<Dim>& flow);
    void settle();

    Lender<Vec<Dim>> position;
    Lender<Vec<Dim>> velocity;
    Lender<double> pressure;
    Lender<double> volume;
    Lender<std::int64_t> id;
    Lender<ParticleKind> kind;
    Lender<Vec<Dim>> acceleration;
  };

  Simulation<Dim>& simulation();
  Lenders& lend();
  const Flow<Dim>& flow() const;
  std::size_t owned() const { return state().particles.owned; }
  void tell_of_script();

  CaseSpec spec_;
  std::optional<RunOptions> options_;
  std::optional<Simulation<Dim>> simulation_;
  std::unique_ptr<FolderOutput<Dim>> output_;
  double dt_ = 0.0;
  StepReport report_;
  bool script_is_told_ = false;
  std::optional<Lenders> lend_;  ///< destroyed before the simulation, whose memory it lends
};

}  // namespace tailwater
