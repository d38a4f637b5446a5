// Role of a particle in the pressure equation and the shifts, in one step. Parts of the flow (flow/part.h) claim the
// particles whose velocity they prescribe.
#pragma once

#include <cstdint>

namespace tailwater {

enum class Role : std::uint8_t {
  water,          ///< is solved for
  prescribed,     ///< water whose velocity and pressure a part prescribes
  following,      ///< water whose velocity a part prescribes; its pressure follows that of the water around it
  stagnant,       ///< water at rest in a gap too narrow to be resolved; a part prescribes its pressure
  wall,           ///< its row relates its pressure to that of the water (walls/wall_model.h)
  solved_on_wall  ///< wall particle on the wall, where the water's equation is solved too
};

/// Whether a part has claimed the particle.
constexpr bool is_claimed(Role role) {
  return role == Role::prescribed || role == Role::following || role == Role::stagnant;
}

/// Whether the particle's pressure is solved for by the water's equation.
constexpr bool is_solved_for(Role role) { return role == Role::water || role == Role::solved_on_wall; }

/// Whether the water's stages or a part write the particle's row of the pressure equation, and not the wall model.
constexpr bool has_equation(Role role) { return role != Role::wall; }

}  // namespace tailwater
