#include "base/for_each.h"
#include "flow/measure.h"
#include "robust/discretisation.h"

namespace tailwater {

template <int Dim>
std::size_t RobustDiscretisation<Dim>::find_shifts(Flow<Dim>& flow, double dt, std::vector<Vec<Dim>>& shifts) const {
  const Particles<Dim>& particles = flow.state.particles;
  const std::size_t capped =
      compute_shift<Dim>(laws_.shifting, dt, largest_speed(flow), flow.pairs(), particles, flow.surroundings, shifts);
  for_each(particles.owned, [&](std::size_t i) {
    if (is_claimed(flow.role[i])) shifts[i].setZero();
  });
  return capped;
}

template std::size_t RobustDiscretisation<2>::find_shifts(Flow<2>&, double, std::vector<Vec<2>>&) const;
template std::size_t RobustDiscretisation<3>::find_shifts(Flow<3>&, double, std::vector<Vec<3>>&) const;

}  // namespace tailwater
