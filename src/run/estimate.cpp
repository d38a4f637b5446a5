#include "run/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/error.h"
#include "flow/verbs.h"
#include "geometry/check.h"
#include "schemes/advance.h"

namespace tailwater {
namespace {

/// The first step is not counted: it builds lists and patterns and has no pressure to start from.
constexpr int trial_steps = 3;

/// At a millisecond per step, which is little, this many take twelve days.
constexpr double most_steps = 1e9;

}  // namespace

void require_reachable_end(const CaseSpec& spec, const TimeStepRule& rule) {
  const double largest_step = rule.largest(0.0, 0.0);
  // Not a quotient: for a mistyped end time it may overflow.
  if (spec.time.end > most_steps * largest_step) {
    throw InputError(fmt::format(
        "time.end = {:g} s is out of reach: steps of at most {:.3g} s make more than {:g} of them; give the end in "
        "seconds, at most {:.3g}, or a larger particles.spacing",
        spec.time.end, largest_step, most_steps, most_steps * largest_step));
  }
}

template <int Dim>
RunEstimate estimate_run(const CaseSpec& spec, Flow<Dim>& flow) {
  RunEstimate estimate;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    ++(flow.state.particles.is_fluid(i) ? estimate.fluid_particles : estimate.wall_particles);
  }
  estimate.memory = memory_estimate<Dim>(estimate.fluid_particles, estimate.wall_particles,
                                         neighbours_in_support<Dim>(spec.scheme.support));

  flow.neighbourhood.reorder(flow.state.particles);
  double dt = std::min(next_time_step(flow), spec.time.end);
  advance(flow, dt);
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < trial_steps; ++k) {
    dt = std::min(next_time_step(flow), spec.time.end);
    advance(flow, dt);
  }
  const double per_step = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / trial_steps;
  estimate.steps = spec.time.end / dt;
  estimate.seconds = estimate.steps * per_step;
  return estimate;
}

template RunEstimate estimate_run<2>(const CaseSpec&, Flow<2>&);
template RunEstimate estimate_run<3>(const CaseSpec&, Flow<3>&);

}  // namespace tailwater
