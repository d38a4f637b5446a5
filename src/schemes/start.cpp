#include <algorithm>
#include <cmath>

#include "schemes/advance.h"
#include "schemes/two_step.h"
#include "schemes/verbs.h"

namespace tailwater {

template <int Dim>
void start(Flow<Dim>& flow) {
  const double dt = next_time_step(flow);
  hold_open_ends(flow, 0.0);
  remember(flow);
  locate(flow);
  if (!std::isfinite(dt)) return;  // nothing moves and nothing pulls: no pressure either
  Interventions ignored;
  drive_walls_to_end(flow, dt);
  if (flow.scheme.name == SchemeName::farmani2020) {
    predict_pressure(flow, dt, ignored);
    std::copy(flow.position_old.begin(), flow.position_old.end(), flow.particles.position.begin());
    place_walls(flow, flow.time);
    locate(flow);
    return;
  }
  predict(flow, dt);
  aim(flow, dt);
  assemble(flow, dt, ignored);
  solve(flow, ignored);
}

template void start<2>(Flow<2>&);
template void start<3>(Flow<3>&);

}  // namespace tailwater
