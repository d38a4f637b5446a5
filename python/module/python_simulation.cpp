#include "python_simulation.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "geometry/wall_label.h"
#include "io/messages.h"
#include "linear/session.h"
#include "motion/wall_motion.h"
#include "open_ends/open_ends.h"
#include "parts/script_loads.h"
#include "run/estimate.h"
#include "run/run_case.h"

namespace tailwater {
namespace {

/// [dx]; largest distance between a wall and the start of a script's path: only round-off is allowed.
constexpr double largest_jump = 1e-6;

/// Throws InputError if `given` is not a position of a wall.
template <int Dim>
Placement<Dim> placement_of(const std::vector<double>& given, const std::string& label, double time) {
  const bool is_finite = std::ranges::all_of(given, [](double value) { return std::isfinite(value); });
  if ((given.size() != Dim && given.size() != Dim + 1) || !is_finite) {
    throw InputError(
        fmt::format("{}: the path of a script gives [{:.6g}] at t = {:.6f} s, not {} components of a "
                    "displacement in m, and an angle in rad if it turns",
                    label, fmt::join(given, ", "), time, Dim));
  }
  Placement<Dim> placement;
  for (int axis = 0; axis < Dim; ++axis) placement.displacement[axis] = given[static_cast<std::size_t>(axis)];
  if (given.size() > Dim) placement.angle = given.back();
  return placement;
}

/// Throws InputError, on all ranks, if a script has set a force that is not finite. Collective.
template <int Dim>
void require_finite_loads(Flow<Dim>& flow) {
  const ScriptLoads<Dim>& loads = script_loads(flow);
  const auto is_finite = [](const auto& load) { return load.allFinite(); };
  const Communicator& everyone = flow.setup.ranks;
  const char* what = nullptr;
  if (everyone.any(!std::ranges::all_of(loads.acceleration, is_finite))) what = "body_force";
  if (everyone.any(!std::ranges::all_of(loads.on_bodies, is_finite))) what = "force or moment on a body";
  if (what == nullptr) return;
  throw InputError(
      "the script has given at t = {:.6g} s a {} that is not finite; remedy: look for a division by 0 or the root of a "
      "negative number in the script",
      flow.state.time, what);
}

}  // namespace

template <int Dim>
PythonSimulation<Dim>::Lenders::Lenders(Flow<Dim>& flow)
    : position(flow.state.particles.position),
      velocity(flow.state.particles.velocity),
      pressure(flow.state.particles.pressure),
      volume(flow.state.particles.volume),
      id(flow.state.particles.id),
      kind(flow.state.particles.kind),
      acceleration(script_loads(flow).acceleration) {}

template <int Dim>
void PythonSimulation<Dim>::Lenders::settle() {
  position.settle();
  velocity.settle();
  pressure.settle();
  volume.settle();
  id.settle();
  kind.settle();
  acceleration.settle();
}

template <int Dim>
PythonSimulation<Dim>::PythonSimulation(CaseSpec spec, std::optional<RunOptions> options)
    : spec_(std::move(spec)), options_(std::move(options)) {
  require_sound_geometry(spec_, ranks_of_process());
  simulation_.emplace(spec_, ranks_of_process());
  if (options_) {
    output_ = std::make_unique<FolderOutput<Dim>>(spec_, *options_, *simulation_);
    output_->begin();
  } else {
    require_reachable_end(spec_, flow().setup.time_step_rule);
  }
  lend_.emplace(simulation_->flow());
}

template <int Dim>
void PythonSimulation<Dim>::start() {
  lend().settle();
  require_finite_loads(simulation().flow());
  const pybind11::gil_scoped_release others_go_on;
  simulation().start();
  script_loads(simulation().flow()).clear();
}

template <int Dim>
Simulation<Dim>& PythonSimulation<Dim>::simulation() {
  if (!simulation_) throw std::logic_error("the simulation is closed");
  return *simulation_;
}

template <int Dim>
typename PythonSimulation<Dim>::Lenders& PythonSimulation<Dim>::lend() {
  simulation();  // for its error
  return *lend_;
}

template <int Dim>
const Flow<Dim>& PythonSimulation<Dim>::flow() const {
  if (!simulation_) throw std::logic_error("the simulation is closed");
  return simulation_->flow();
}

template <int Dim>
bool PythonSimulation<Dim>::prepare() {
  if (simulation().is_prepared()) return true;
  lend().settle();
  if (simulation().has_ended()) return false;
  const pybind11::gil_scoped_release others_go_on;
  dt_ = simulation().prepare();
  return true;
}

template <int Dim>
void PythonSimulation<Dim>::step() {
  lend().settle();
  require_finite_loads(simulation().flow());
  const pybind11::gil_scoped_release others_go_on;
  report_ = simulation().step();
}

template <int Dim>
void PythonSimulation<Dim>::finish(const std::string& failure) {
  lend_.reset();
  if (output_ && !failure.empty()) {
    output_->finish_failed(ExitCode::solver_failed, failure);
  } else if (output_) {
    output_->write_checkpoint();
    output_->finish(simulation().has_ended() ? ExitCode::done : ExitCode::interrupted);
  }
  output_.reset();
  simulation_.reset();
}

template <int Dim>
pybind11::array PythonSimulation<Dim>::acceleration() {
  tell_of_script();
  std::vector<Vec<Dim>>& acceleration = script_loads(simulation().flow()).acceleration;
  if (acceleration.empty()) acceleration.assign(owned(), Vec<Dim>::Zero());
  return lend().acceleration.template view<double>(acceleration.size(), Dim, true);
}

template <int Dim>
void PythonSimulation<Dim>::push(std::size_t b, const Twist<Dim>& push) {
  tell_of_script();
  std::vector<Twist<Dim>>& pushes = script_loads(simulation().flow()).on_bodies;
  if (pushes.empty()) pushes.assign(bodies().size(), Twist<Dim>::Zero());
  pushes.at(b) += push;
}

template <int Dim>
void PythonSimulation<Dim>::set_discharge(const std::string& inlet, double discharge) {
  if (!std::isfinite(discharge)) {
    throw InputError("inlet '{}': the script gives a discharge that is not finite; remedy: give a number in m^3/s",
                     inlet);
  }
  simulation().flow().template part<OpenEnds<Dim>>().set_discharge(inlet, state().time, discharge);
  tell_of_script();
}

template <int Dim>
void PythonSimulation<Dim>::steer(const std::string& name, std::function<std::vector<double>(double)> path) {
  Flow<Dim>& flow = simulation().flow();
  WallMotion<Dim>& motion = *flow.setup.wall_motion;
  const auto wall = std::ranges::find_if(motion.moving(), [&](const auto& moving) {
    return moving.body < 0 && spec_.walls[static_cast<std::size_t>(moving.wall)].name == name;
  });
  if (wall == motion.moving().end()) {
    throw InputError(fmt::format(
        "there is no wall '{}' that a script can move; remedy: the name of a wave maker or a gate, or of a wall that "
        "moves in the case, as with displacement = [{}\"0*t\"]",
        name, Dim == 2 ? "0, " : "0, 0, "));
  }
  const std::string label = wall_label(flow.walls.boundary, wall->wall).text();
  if (wall->maker >= 0 && spec_.wave_makers[static_cast<std::size_t>(wall->maker)].absorption == Absorption::active) {
    throw InputError(fmt::format("{}: the water moves it too; remedy: absorption = \"none\"", label));
  }
  GivenMotion<Dim> given{
      [label, path = std::move(path)](double time) { return placement_of<Dim>(path(time), label, time); }};
  const State<Dim>& state = flow.state;
  motion.steer(static_cast<std::size_t>(wall - motion.moving().begin()), std::move(given), state.time, state.motion,
               largest_jump * flow.setup.scale.spacing, label);
  tell_of_script();
  if (simulation().is_prepared()) {
    dt_ = simulation().shorten();
  } else if (state.step == 0) {
    motion.get_velocity(state.time, state.motion, flow.state.wall_velocity);
  }
}

/// Warns that the results depend on a script, so that they are not taken for results of the case file alone.
template <int Dim>
void PythonSimulation<Dim>::tell_of_script() {
  if (script_is_told_) return;
  script_is_told_ = true;
  log_line(fmt::format("a script acts on the flow from t = {:.4f} s on", state().time));
  if (!output_) return;
  warn("script-acts-on-flow",
       "a script acts on the flow from t = {:.4f} s on: the case file alone does not give these results, and tailwater "
       "resume continues without the script",
       state().time);
}

template class PythonSimulation<2>;
template class PythonSimulation<3>;

}  // namespace tailwater
