#include "schemes/verbs.h"

namespace tailwater {

template <int Dim>
Sharing share_out(Flow<Dim>& flow) {
  flow.neighbourhood.wrap(flow.particles);
  const Sharing sharing = flow.decomposition.share_out(flow.particles, flow.neighbourhood.work(flow.particles));
  flow.neighbourhood.reorder(flow.particles);
  return sharing;
}

template Sharing share_out<2>(Flow<2>&);
template Sharing share_out<3>(Flow<3>&);

}  // namespace tailwater
