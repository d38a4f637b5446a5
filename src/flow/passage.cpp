// Particles that are replaced by others between steps, that leave the flow, and that enter it.
#include "base/for_each.h"
#include "flow/stages.h"
#include "neighbours/neighbourhood.h"

namespace tailwater {

template <int Dim>
void adapt(Flow<Dim>& flow) {
  for (const auto& part : flow.parts) part->adapt(flow);
}

template <int Dim>
bool remove_outflow(Flow<Dim>& flow) {
  const std::size_t owned = flow.state.particles.owned;
  std::vector<std::uint8_t> leaves(owned, 0);
  for (const auto& part : flow.parts) part->take_out(flow, leaves);
  const std::vector<std::size_t> kept = indices_where(owned, [&](std::size_t i) { return leaves[i] == 0; });
  const bool some_left = kept.size() != owned;
  if (!flow.setup.ranks.any(some_left)) return false;
  for (const auto& part : flow.parts) part->reordered(Reordering::removed);
  if (some_left) flow.neighbourhood->keep(flow.state.particles, std::vector<std::int32_t>(kept.begin(), kept.end()));
  return some_left;
}

template <int Dim>
bool add_inflow(Flow<Dim>& flow) {
  bool some_came = false;
  for (const auto& part : flow.parts) some_came = part->bring_in(flow) || some_came;
  return some_came;
}

TAILWATER_IN_2D_AND_3D(adapt);
TAILWATER_IN_2D_AND_3D(remove_outflow);
TAILWATER_IN_2D_AND_3D(add_inflow);

}  // namespace tailwater
