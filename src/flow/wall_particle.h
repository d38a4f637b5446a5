// The particle of a row of walls.
#pragma once

#include "flow/setup.h"
#include "particles/particles.h"
#include "sampling/wall_table.h"

namespace tailwater {

/// Where the row stands now.
template <int Dim>
NewParticle<Dim> wall_particle(const Setup<Dim>& setup, const WallParticles<Dim>& rows, std::size_t row) {
  return {.position = rows.position[row],
          .volume = rows.share[row] * power<Dim>(setup.scale.spacing),
          .id = setup.first_wall_id + rows.number[row],
          .wall_row = static_cast<std::int32_t>(row)};
}

}  // namespace tailwater
