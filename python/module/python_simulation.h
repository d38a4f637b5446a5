// A simulation as Python drives it: python/tailwater/simulation.py.
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

/// All ranks of the program. Starts MPI and PETSc the first time.
const Communicator& ranks_of_process();

/// Functions are collective. After `finish` there is no flow any more, whoever still refers to this object, and what
/// asks for it throws a std::logic_error.
template <int Dim>
class PythonSimulation {
 public:
  /// Checks the case as `run` does. Writes a folder only if there are options.
  PythonSimulation(CaseSpec spec, std::optional<RunOptions> options);

  /// Finds the pressure at the start, with the loads of then.
  void start();
  /// Makes the next step ready; false at the end of the case.
  bool prepare();
  void step();
  /// Ends the output, if there is any: "done" at the end of the case, else "interrupted", with a checkpoint. After an
  /// error in a step its message.
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

  /// m/s^2, of each particle in the coming step; to be written into. Zero at first.
  pybind11::array acceleration();

  const std::vector<FloatingBody<Dim>>& bodies() const { return bodies_of(flow()).bodies; }
  const BodyState<Dim>& body(std::size_t b) const { return state().motion.bodies.each.at(b); }
  /// Adds a force and a moment about the centre of mass in the coming step.
  void push(std::size_t b, const Twist<Dim>& push);

  /// From now on, in place of what the case says. Throws InputError for an inlet without a discharge.
  void set_discharge(const std::string& inlet, double discharge);
  /// From now on a wall that moves is where `path` says at a time [s]: its displacement [m] from where it is drawn, and
  /// after it, if given, its angle [rad]. Throws InputError for a wall that does not move, or that the water moves too,
  /// and for a path that begins elsewhere. Collective.
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
  std::optional<Lenders> lend_;  ///< goes before the simulation, whose memory it lends
};

}  // namespace tailwater
