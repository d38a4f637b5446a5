#include "schemes/velocity_divergence.h"

#include <cmath>

#include "operators/divergence.h"
#include "operators/gradient_consistent.h"
#include "schemes/verbs.h"
#include "schemes/wall_state.h"

namespace tailwater {

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
  update_wall_velocity(flow, flow.particles.velocity);
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < flow.particles.owned; ++i) {
    if (!flow.is_inside(i)) continue;
    const double divergence = divergence_at(flow, i, flow.particles.velocity);
    squares += divergence * divergence;
    ++count;
  }
  return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0.0;
}

template double divergence_at<2>(const Flow<2>&, std::size_t, const std::vector<Vec<2>>&);
template double divergence_at<3>(const Flow<3>&, std::size_t, const std::vector<Vec<3>>&);
template double bulk_divergence<2>(Flow<2>&);
template double bulk_divergence<3>(Flow<3>&);

}  // namespace tailwater
