#include <cmath>

#include "schemes/projection.h"
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
  predict(flow, dt);
  aim(flow, dt);
  assemble(flow, dt, ignored);
  solve(flow, ignored);
}

template void start<2>(Flow<2>&);
template void start<3>(Flow<3>&);

}  // namespace tailwater
