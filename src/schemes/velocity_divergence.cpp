#include "schemes/velocity_divergence.h"

#include <cmath>

#include "base/for_each.h"
#include "operators/divergence.h"
#include "operators/gradient_consistent.h"
#include "schemes/verbs.h"
#include "schemes/wall_state.h"

namespace tailwater {

namespace {

/// rms over bulk fluid particles of all ranks.
template <int Dim>
double bulk_rms(const Flow<Dim>& flow, const std::vector<double>& field) {
  double squares = 0.0;
  std::int64_t count = 0;
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (!flow.is_inside(i)) continue;
    squares += field[i] * field[i];
    ++count;
  }
  flow.ranks.sum_each(squares, count);
  return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0.0;
}

}  // namespace

template <int Dim>
double divergence_at(const Flow<Dim>& flow, std::size_t i, const std::vector<Vec<Dim>>& velocity) {
  if (flow.scheme.divergence == DivergenceKind::standard) {
    return standard_divergence<Dim>(flow.pairs(), i, flow.particles.volume, velocity);
  }
  const Renormalisation<Dim>& tensors = flow.tensors[i];
  if (!tensors.gradient_is_sound()) return 0.0;
  return consistent_gradient<Dim>(flow.pairs(), i, tensors.B1, flow.particles.volume, flow.takes_part,
                                  std::span<const Vec<Dim>>(velocity))
      .trace();
}

template <int Dim>
double bulk_divergence(Flow<Dim>& flow) {
  update_wall_velocity(flow, flow.walls.velocity, flow.particles.velocity);
  flow.divergence.assign(flow.particles.owned, 0.0);
  for_each(flow.particles.owned, [&](std::size_t i) {
    if (flow.particles.is_fluid(i)) flow.divergence[i] = divergence_at(flow, i, flow.particles.velocity);
  });
  return bulk_rms(flow, flow.divergence);
}

template <int Dim>
void measure_after_move(Flow<Dim>& flow, StepReport& report) {
  std::vector<double> change = flow.divergence;
  report.divergence_new = bulk_divergence(flow);
  for_each(change.size(), [&](std::size_t i) { change[i] -= flow.divergence[i]; });
  report.divergence_moved = bulk_rms(flow, change);
}

template double divergence_at<2>(const Flow<2>&, std::size_t, const std::vector<Vec<2>>&);
template double divergence_at<3>(const Flow<3>&, std::size_t, const std::vector<Vec<3>>&);
template double bulk_divergence<2>(Flow<2>&);
template double bulk_divergence<3>(Flow<3>&);
template void measure_after_move<2>(Flow<2>&, StepReport&);
template void measure_after_move<3>(Flow<3>&, StepReport&);

}  // namespace tailwater
