#include "flow/verbs.h"

namespace tailwater {

template <int Dim>
Sharing share_out(Flow<Dim>& flow) {
  flow.neighbourhood.wrap(flow.state.particles);
  const Sharing sharing =
      flow.decomposition.share_out(flow.state.particles, flow.neighbourhood.work(flow.state.particles));
  if (sharing.moved > 0) flow.shared_rows.find_rows(flow.walls, flow.state.particles, 0, flow.setup.first_wall_id);
  regather_walls(flow);
  flow.neighbourhood.reorder(flow.state.particles);
  return sharing;
}

template Sharing share_out<2>(Flow<2>&);
template Sharing share_out<3>(Flow<3>&);

}  // namespace tailwater
