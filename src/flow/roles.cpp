#include "base/for_each.h"
#include "flow/stages.h"
#include "walls/wall_model.h"

namespace tailwater {

template <int Dim>
void assign_roles(Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  const bool some_are_solved = flow.wall_model().traits().solves_on_wall;
  flow.role.resize(particles.owned);
  for_each(particles.owned, [&](std::size_t i) {
    if (particles.is_fluid(i)) {
      flow.role[i] = Role::water;
    } else {
      const bool is_solved = some_are_solved && flow.walls.particles.is_on_wall(particles.wall_row[i]);
      flow.role[i] = is_solved ? Role::solved_on_wall : Role::wall;
    }
  });
  for (const auto& part : flow.parts) part->claim(flow, flow.role);
}

TAILWATER_IN_2D_AND_3D(assign_roles);

}  // namespace tailwater
