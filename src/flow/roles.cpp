#include "base/for_each.h"
#include "flow/stages.h"

namespace tailwater {
namespace {

template <int Dim>
Role role_of_wall(const Flow<Dim>& flow, std::int32_t row) {
  const bool is_solved = flow.setup.wall_traits.solves_on_wall && flow.walls.particles.is_on_wall(row);
  return is_solved ? Role::solved_on_wall : Role::wall;
}

}  // namespace

template <int Dim>
void assign_roles(Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  flow.role.resize(particles.owned);
  for_each(particles.owned, [&](std::size_t i) {
    flow.role[i] = particles.is_fluid(i) ? Role::water : role_of_wall(flow, particles.wall_row[i]);
  });
  for (const auto& part : flow.parts) part->claim(flow, flow.role);
}

TAILWATER_IN_2D_AND_3D(assign_roles);

}  // namespace tailwater
