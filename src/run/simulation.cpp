#include "run/simulation.h"

#include <algorithm>
#include <utility>

#include "base/for_each.h"
#include "bodies/floating_bodies.h"
#include "flow/distribution.h"
#include "flow/saved_flow.h"
#include "flow/stages.h"
#include "parts/rest_watch.h"
#include "published/make_flow.h"
#include "schemes/advance.h"

namespace tailwater {
namespace {

/// Steps between sorts. Particles drift slowly out of cache order and out of their rank's part of space. Sort and
/// repartition at this interval cost almost nothing.
constexpr std::int64_t steps_between_sorts = 10;

}  // namespace

template <int Dim>
Simulation<Dim>::Simulation(const CaseSpec& spec, const Communicator& ranks)
    : end_(spec.time.end), flow_(make_flow<Dim>(spec, ranks)) {}

template <int Dim>
void Simulation<Dim>::observe(RunObserver<Dim>& observer, const RunFolder& folder) {
  observer_ = &observer;
  guard_.report_to(folder);
}

template <int Dim>
void Simulation<Dim>::start() {
  locate(flow_);
  guard_.require_sound_step(next_time_step(flow_));
  guard_.attempt(save_step_start(flow_), [&] { tailwater::start(flow_); });
  if (observer_ != nullptr) observer_->started(flow_);
}

template <int Dim>
bool Simulation<Dim>::has_ended() const {
  return flow_.state.time >= end_ || flow_.template part<RestWatch<Dim>>().is_at_rest();
}

template <int Dim>
double Simulation<Dim>::prepare() {
  if (is_prepared()) return dt_;
  if (observer_ != nullptr) observer_->before_step(flow_);
  const double dt = next_time_step(flow_);
  guard_.require_sound_step(dt);
  rearrange();
  // The last step is not shortened to the end time: the density source is proportional to 1/dt^2, and a tiny step would
  // accelerate the water.
  dt_ = std::min(dt, end_);
  return dt_;
}

template <int Dim>
double Simulation<Dim>::shorten() {
  const double dt = next_time_step(flow_);
  guard_.require_sound_step(dt);
  return dt_ = std::min(dt_, dt);
}

template <int Dim>
StepReport Simulation<Dim>::step() {
  prepare();
  StepReport report;
  StepStart<Dim> start;
  guard_.attempt(start, [&] {
    start = begin_step(flow_, dt_);
    report = advance(flow_, start, dt_);
  });
  dt_ = 0.0;
  if (observer_ != nullptr) observer_->stepped(flow_, report);
  return report;
}

/// Makes all changes to the indices of particles. Every few steps all particles are repartitioned and sorted; at the
/// other steps parts may replace particles. Then particles that have passed an open end are removed, and new ones come
/// in. A checkpoint has the state in between: before water that may have limited the time step has left.
template <int Dim>
void Simulation<Dim>::rearrange() {
  const bool is_repartitioned = flow_.state.step % steps_between_sorts == 0;
  if (is_repartitioned) {
    if (flow_.state.step != repartition_step_) {
      const Repartition result = repartition(flow_);
      if (observer_ != nullptr) observer_->repartitioned(flow_, result);
    }
    if (observer_ != nullptr) observer_->can_go_on(flow_, guard_.reference_step());
  }
  if (!is_repartitioned) adapt(flow_);
  remove_outflow(flow_);
  add_inflow(flow_);
}

template <int Dim>
bool Simulation<Dim>::fits(State<Dim>& state) {
  const std::size_t misplaced = count_each(state.particles.owned, [&](std::size_t i) {
    const std::int64_t number = state.particles.id[i] - flow_.setup.first_wall_id;
    return !state.particles.is_fluid(i) && (number < 0 || number >= flow_.walls.particles.numbers);
  });
  const FloatingBodies<Dim>& bodies = bodies_of(flow_);
  const std::size_t degrees = bodies.freedom_count();
  const MotionState<Dim>& motion = state.motion;
  const bool moves_alike = motion.wave_makers.size() == flow_.state.motion.wave_makers.size() &&
                           motion.bodies.each.size() == bodies.bodies.size() &&
                           (motion.bodies.inertia.empty() || motion.bodies.inertia.size() == degrees * degrees);
  const bool is_alike = misplaced == 0 && moves_alike && state.wall_velocity.size() == flow_.state.wall_velocity.size();
  return !flow_.setup.ranks.any(!is_alike) &&
         flow_.distribution->shared_rows.find_rows(flow_.walls, state.particles, 0, flow_.setup.first_wall_id);
}

template <int Dim>
bool Simulation<Dim>::go_on_from(SavedFlow<Dim> saved, double reference_step, std::optional<std::string> cuts) {
  if (!fits(saved.state) || !flow_.restore(std::move(saved))) return false;
  guard_.restore_reference_step(reference_step);
  if (!cuts) return true;
  if (!flow_.setup.ranks.is_alone()) flow_.distribution->decomposition.cuts().restore(std::move(*cuts));
  repartition_step_ = flow_.state.step;
  return true;
}

template class Simulation<2>;
template class Simulation<3>;

}  // namespace tailwater
