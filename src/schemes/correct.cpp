#include "base/for_each.h"
#include "operators/gradient_conservative.h"
#include "operators/gradient_consistent.h"
#include "operators/gradient_density_weighted.h"
#include "schemes/verbs.h"

namespace tailwater {
/// By the scheme's choice of operator. Where the consistent gradient does not exist there is none: spray falls freely.
template <int Dim>
Vec<Dim> gradient_at(const Flow<Dim>& flow, std::size_t i, const std::vector<double>& pressure) {
  if (flow.scheme.gradient == GradientKind::conservative) {
    return conservative_gradient<Dim>(flow.pairs(), i, flow.particles.volume, pressure);
  }
  if (flow.scheme.gradient == GradientKind::density_weighted) {
    return density_weighted_gradient<Dim>(flow.pairs(), i, flow.particles.volume, flow.concentration, pressure);
  }
  if (!flow.tensors[i].gradient_is_sound()) return Vec<Dim>::Zero();
  return consistent_gradient<Dim>(flow.pairs(), i, flow.tensors[i].B1, flow.particles.volume, flow.takes_part,
                                  std::span<const double>(pressure));
}

template <int Dim>
void correct(Flow<Dim>& flow, double dt) {
  const Vec<Dim> gravity = flow.predicts_gravity() ? Vec<Dim>(Vec<Dim>::Zero()) : flow.gravity;
  for_each(flow.particles.owned, [&](std::size_t i) {
    if (!flow.is_solved_for(i)) return;
    flow.particles.velocity[i] =
        flow.u_star[i] + dt * (gravity - gradient_at(flow, i, flow.particles.pressure) / flow.density);
  });
  flow.walls.velocity = flow.wall_velocity_next;
}

template Vec<2> gradient_at<2>(const Flow<2>&, std::size_t, const std::vector<double>&);
template Vec<3> gradient_at<3>(const Flow<3>&, std::size_t, const std::vector<double>&);
template void correct<2>(Flow<2>&, double);
template void correct<3>(Flow<3>&, double);

}  // namespace tailwater
