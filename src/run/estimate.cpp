#include "run/estimate.h"

#include <chrono>

#include "geometry/check.h"
#include "schemes/projection.h"
#include "schemes/verbs.h"

namespace tailwater {
namespace {

/// The first step is not counted: it builds lists and patterns and has no pressure to start from.
constexpr int trial_steps = 3;

}  // namespace

template <int Dim>
RunEstimate estimate_run(const CaseSpec& spec, Flow<Dim>& flow) {
  RunEstimate estimate;
  for (std::size_t i = 0; i < flow.particles.owned; ++i) {
    ++(flow.particles.is_fluid(i) ? estimate.fluid_particles : estimate.wall_particles);
  }
  estimate.memory = memory_estimate<Dim>(estimate.fluid_particles, estimate.wall_particles,
                                         neighbours_in_support<Dim>(spec.scheme.support));

  flow.neighbourhood.reorder(flow.particles);
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
