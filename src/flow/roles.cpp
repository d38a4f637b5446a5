#include "base/for_each.h"
#include "flow/stages.h"

namespace tailwater {
namespace {

template <int Dim>
Role role_at(const OpenEnd<Dim>& end) {
  if (end.flow.feeds()) return Role::inflow_end;
  return end.is_driven() ? Role::level_end : Role::open_end;
}

template <int Dim>
Role role_of_wall(const Flow<Dim>& flow, std::int32_t row) {
  const bool is_solved = flow.setup.wall_traits.solves_on_wall && flow.walls.particles.is_on_wall(row);
  return is_solved ? Role::solved_on_wall : Role::wall;
}

}  // namespace

template <int Dim>
void assign_roles(Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  const std::vector<OpenEnd<Dim>>& ends = flow.setup.open_ends;
  flow.role.resize(particles.owned);
  flow.end_of.assign(particles.owned, -1);
  for_each(particles.owned, [&](std::size_t i) {
    flow.role[i] = particles.is_fluid(i) ? Role::water : role_of_wall(flow, particles.wall_row[i]);
    for (std::size_t e = 0; particles.is_fluid(i) && e < ends.size(); ++e) {
      if (!ends[e].holds(particles.position[i])) continue;
      flow.role[i] = role_at(ends[e]);
      flow.end_of[i] = static_cast<std::int16_t>(e);
    }
  });
  for (const auto& part : flow.parts) part->claim(flow, flow.role);
}

TAILWATER_IN_2D_AND_3D(assign_roles);

}  // namespace tailwater
