// What a particle is for the pressure equation and the shifts, in one step. Parts of the flow (flow/part.h) claim the
// particles whose velocity and pressure they give.
#pragma once

#include <cstdint>

namespace tailwater {

enum class Role : std::uint8_t {
  water,          ///< is solved for
  open_end,       ///< water in the end stretch of an outlet, where nothing is solved for: the flow beyond is assumed
  level_end,      ///< the same, where a level is prescribed
  inflow_end,     ///< the same, where a discharge or a velocity is
  stagnant,       ///< water in a gap that is too narrow for it: rests, with a known pressure (bodies/narrow_gaps.h)
  wall,           ///< its row says how its pressure follows from the water's (walls/wall_model.h)
  solved_on_wall  ///< wall particle on the wall, where the water's equation is solved too
};

constexpr bool is_in_end_stretch(Role role) {
  return role == Role::open_end || role == Role::level_end || role == Role::inflow_end;
}

/// Whether a level, a discharge or a velocity is prescribed where the particle is.
constexpr bool is_driven(Role role) { return role == Role::level_end || role == Role::inflow_end; }

/// Whether its pressure is solved for by the water's equation.
constexpr bool is_solved_for(Role role) { return role == Role::water || role == Role::solved_on_wall; }

/// Whether its row of the pressure equation is written by the water's stages, not by the wall model.
constexpr bool has_equation(Role role) { return role != Role::wall; }

}  // namespace tailwater
