#include "run/step_guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "flow/balanced_pressure.h"
#include "flow/stages.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"
#include "motion/wall_motion.h"
#include "run/failure.h"

namespace tailwater {
namespace {

/// A run fails when a step is below this fraction of the step for the water at the start.
constexpr double smallest_share = 1e-3;

/// The fastest particle of this rank; none if the rank owns none.
template <int Dim>
std::optional<std::size_t> fastest_particle(const Particles<Dim>& particles) {
  if (particles.owned == 0) return std::nullopt;
  const auto first = particles.velocity.begin();
  const auto fastest =
      std::max_element(first, first + static_cast<std::ptrdiff_t>(particles.owned),
                       [](const Vec<Dim>& a, const Vec<Dim>& b) { return a.squaredNorm() < b.squaredNorm(); });
  return static_cast<std::size_t>(fastest - first);
}

/// The moving wall that goes farthest within dt, by a corner of each of its faces.
template <int Dim>
std::string fastest_wall(const Flow<Dim>& flow, double dt) {
  const Boundary<Dim>& boundary = flow.walls.boundary;
  const double time = flow.state.time;
  double farthest = -1.0;
  int wall = 0;
  for (const auto& moving : flow.setup.wall_motion->moving()) {
    const AffineMap<Dim> velocity = moving.mean_velocity(time, time + dt, flow.state.motion);
    for (const WallFace<Dim>& face : boundary.faces) {
      if (face.wall != moving.wall) continue;
      const double speed = velocity(face.corners[0]).norm();
      if (speed > farthest) {
        farthest = speed;
        wall = moving.wall;
      }
    }
  }
  return wall_label(boundary, wall).text();
}

}  // namespace

/// Within a step particles are only added, behind the others.
template <int Dim>
Particles<Dim> StepGuard<Dim>::last_good() const {
  Particles<Dim> particles = flow_.state.particles;
  particles.owned = good_ ? good_->count : particles.owned;
  particles.resize(particles.owned);
  if (!good_) return particles;
  const auto put_back = [&](const auto& kept, auto& field) {
    if (!kept.empty()) field.assign(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(particles.owned));
  };
  put_back(good_->start.position, particles.position);
  put_back(good_->start.velocity, particles.velocity);
  put_back(good_->pressure, particles.pressure);
  put_back(good_->second_pressure, particles.second_pressure);
  put_back(good_->layer_viscosity, particles.layer_viscosity);
  put_back(good_->wall_distance, particles.wall_distance);
  return particles;
}

template <int Dim>
void StepGuard<Dim>::require_sound_step(double dt) {
  const Setup<Dim>& setup = flow_.setup;
  if (reference_step_ == 0.0) {
    // Without gravity a speed can only be judged by comparison with the start.
    const double speed =
        setup.time_step_rule.reference_speed > 0.0 ? 0.0 : std::max(largest_speed(flow_), step_limits(flow_).speed);
    if (setup.time_step_rule.reference_speed == 0.0 && speed == 0.0 &&
        !setup.ranks.any(flow_.state.particles.owned > 0))
      return;
    reference_step_ = setup.time_step_rule.largest(speed, setup.liquid.viscosity.at_speed(speed));
    if (!setup.wall_motion->moving().empty()) reference_step_ = std::min(reference_step_, dt);  // walls limit it too
  }
  if (!std::isfinite(reference_step_) || dt >= smallest_share * reference_step_) return;
  const std::string reason =
      fmt::format("the time step collapsed to {:.3g} s, less than {:g} of {:.3g} s, the step at the start", dt,
                  smallest_share, reference_step_);
  if (dt < step_of_water(flow_, step_limits(flow_))) {
    fail(fmt::format("{}: {} moves too fast or jumps. Remedy: a smoother displacement or rotation of the wall", reason,
                     fastest_wall(flow_, dt)),
         std::nullopt);
  }
  const double speed = largest_speed(flow_);
  const TimeStepRule rule = time_step_rule(flow_);
  const double viscosity = setup.liquid.viscosity.at_speed(speed) + largest_noise_viscosity(flow_, speed);
  const bool is_viscous = rule.largest(speed, viscosity) < rule.largest(speed, 0.0);
  const Particles<Dim>& particles = flow_.state.particles;
  std::optional<std::size_t> culprit = fastest_particle(particles);
  if (culprit && particles.velocity[*culprit].norm() < speed) culprit.reset();
  const std::string limit = fmt::format("{}, by the {} limit", reason, is_viscous ? "viscous" : "advective");
  if (!setup.ranks.any(culprit.has_value())) {
    fail(fmt::format("{}: inflow enters at {:.4g} m/s, and there is no water yet. Remedy: a steadier inflow", limit,
                     step_limits(flow_).speed),
         std::nullopt);
  }
  blame(culprit, [&](std::size_t i) {
    return fmt::format("{}: particle {} at {} moves at {:.4g} m/s", limit, particles.id[i],
                       place<Dim>(particles.position[i]), particles.velocity[i].norm());
  });
}

template <int Dim>
void StepGuard<Dim>::attempt(const StepStart<Dim>& start, const std::function<void()>& work) {
  const Particles<Dim>& particles = flow_.state.particles;
  const auto kept = [&](const std::vector<double>& field) {
    return std::vector<double>(field.begin(), field.begin() + static_cast<std::ptrdiff_t>(particles.owned));
  };
  const struct Forgets {
    std::optional<Good>& good;
    ~Forgets() { good.reset(); }
  } at_the_end{good_};
  good_.emplace(Good{.start = start, .time = flow_.state.time, .count = particles.owned});
  good_->pressure = kept(particles.pressure);
  if (flow_.setup.formulation.has_second_projection) good_->second_pressure = kept(particles.second_pressure);
  good_->layer_viscosity = kept(particles.layer_viscosity);
  good_->wall_distance = kept(particles.wall_distance);
  std::string failure;
  try {
    work();
  } catch (const SolverError& error) {
    failure = error.what();  // on all ranks: the functions that throw are collective
  }
  const std::optional<std::size_t> culprit = find_non_finite(flow_);
  if (flow_.setup.ranks.any(culprit.has_value())) {
    blame(culprit, [&](std::size_t i) {
      const bool has_begun = i < start.position.size();
      return fmt::format("particle {}, which was at {}, has a value that is not finite", particles.id[i],
                         place<Dim>(has_begun ? start.position[i] : particles.position[i]));
    });
  }
  if (!failure.empty()) fail(failure, std::nullopt);
}

/// Fails the run because of a particle with invalid values, on the first rank that has one. `describe` returns the
/// fault of the particle. The message names instability as the cause.
template <int Dim>
template <class Describe>
void StepGuard<Dim>::blame(std::optional<std::size_t> culprit, const Describe& describe) {
  const Communicator& ranks = flow_.setup.ranks;
  const int rank = ranks.least(culprit ? ranks.rank() : ranks.size());
  const bool is_here = rank == ranks.rank();
  if (!is_here) culprit.reset();
  const std::string reason = ranks.broadcast(is_here ? describe(*culprit) : std::string(), rank);
  fail(reason +
           ". The run has become unstable; remedy: a smaller scheme.courant, a larger study.noise_viscosity, or "
           "scheme.formulation = \"robust\" where it is not chosen",
       culprit);
}

/// `culprit` is set on the rank that has it.
template <int Dim>
void StepGuard<Dim>::fail(const std::string& reason, std::optional<std::size_t> culprit) {
  const double time = good_ ? good_->time : flow_.state.time;
  std::string message = fmt::format("step {} from t = {:.6g} s failed: {}", flow_.state.step, time, reason);
  Particles<Dim> particles = last_good();
  if (folder_ != nullptr) {
    write_failure(*folder_, flow_, particles, time, culprit, message);
    message += fmt::format(". The last good fields and a report are in {}", (folder_->path() / "failure").string());
  }
  flow_.state.particles = std::move(particles);
  flow_.state.time = time;
  throw SolverError(message);
}

template class StepGuard<2>;
template class StepGuard<3>;

}  // namespace tailwater
