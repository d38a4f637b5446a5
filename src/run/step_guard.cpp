#include "run/step_guard.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/for_each.h"
#include "flow/verbs.h"
#include "geometry/from_spec.h"
#include "run/failure.h"

namespace tailwater {
namespace {

/// A step below this share of the rule's own reference means that some particle has run away. An error now is better
/// than a run that never ends.
constexpr double collapsed_step = 1e-5;

/// The fastest particle of this rank; none if the rank owns none.
template <int Dim>
std::optional<std::size_t> fastest_particle(const Particles<Dim>& particles) {
  std::optional<std::size_t> fastest;
  for_each(particles.owned, [&](std::size_t i) {
    if (!fastest || particles.velocity[i].squaredNorm() > particles.velocity[*fastest].squaredNorm()) fastest = i;
  });
  return fastest;
}

}  // namespace

template <int Dim>
void StepGuard<Dim>::remember_good() {
  last_good_ = flow_.state.particles;
  last_good_time_ = flow_.state.time;
}

template <int Dim>
void StepGuard<Dim>::require_sound_step(double dt) {
  const double reference_step = flow_.setup.time_step_rule.largest(0.0, 0.0);
  if (!std::isfinite(reference_step) || dt >= collapsed_step * reference_step) return;
  const Particles<Dim>& particles = flow_.state.particles;
  const double speed = largest_speed(flow_);
  std::optional<std::size_t> culprit = fastest_particle(particles);
  if (culprit && particles.velocity[*culprit].norm() < speed) culprit.reset();
  blame(culprit, [&](std::size_t i) {
    return fmt::format("the time step collapsed to {:.3g} s: particle {} at {} moves at {:.4g} m/s", dt,
                       particles.id[i], place<Dim>(particles.position[i]), particles.velocity[i].norm());
  });
}

template <int Dim>
void StepGuard<Dim>::attempt(const std::function<void()>& work) {
  std::string failure;
  try {
    work();
  } catch (const SolverError& error) {
    failure = error.what();  // on all ranks: the functions that throw are collective
  }
  const std::optional<std::size_t> culprit = find_non_finite(flow_);
  if (flow_.setup.ranks.any(culprit.has_value())) {
    blame(culprit, [&](std::size_t i) {
      return fmt::format("particle {}, which was at {}, has a value that is not finite", flow_.state.particles.id[i],
                         place<Dim>(last_good_.position[i]));
    });
  }
  if (!failure.empty()) fail(failure, std::nullopt);
}

/// Fails the run because of a particle that went wrong, on the first rank that has one. `describe` says what went wrong
/// with it. The message names instability as the cause.
template <int Dim>
template <class Describe>
void StepGuard<Dim>::blame(std::optional<std::size_t> culprit, const Describe& describe) {
  const Communicator& ranks = flow_.setup.ranks;
  const int rank = ranks.least(culprit ? ranks.rank() : ranks.size());
  const bool is_here = rank == ranks.rank();
  if (!is_here) culprit.reset();
  const std::string reason = ranks.broadcast(is_here ? describe(*culprit) : std::string(), rank);
  fail(reason +
           ". The run has become unstable; remedy: a smaller scheme.courant, a larger "
           "scheme.noise_viscosity, or scheme.formulation = \"robust\" where it is not chosen",
       culprit);
}

/// `culprit` is set on the rank that has it.
template <int Dim>
void StepGuard<Dim>::fail(const std::string& reason, std::optional<std::size_t> culprit) {
  const std::string message =
      fmt::format("step {} from t = {:.6g} s failed: {}", flow_.state.step, last_good_time_, reason);
  write_failure(folder_, flow_, last_good_, last_good_time_, culprit, message);
  flow_.state.particles = last_good_;
  flow_.state.time = last_good_time_;
  throw SolverError(
      fmt::format("{}. The last good fields and a report are in {}", message, (folder_.path() / "failure").string()));
}

template class StepGuard<2>;
template class StepGuard<3>;

}  // namespace tailwater
