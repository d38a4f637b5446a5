// Rows of the pressure equation where the surface is marked: p = 0 on marked particles and on dry walls.
#pragma once

#include "base/for_each.h"
#include "flow/flow.h"
#include "flow/pressure_equation.h"

namespace tailwater {

/// Writes the rows of the fluid's equation that are solved for. `set_weights(i, row)` sets the weights of a row and
/// returns their sum.
template <int Dim, class SetWeights>
void write_rows_of_marked_water(Flow<Dim>& flow, SetWeights&& set_weights) {
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (!is_solved_for(flow.role[i])) return;
    LinearSystem::Row row = flow.equation->rows.row(i);
    if (!flow.surroundings.takes_part[i] || (flow.surroundings.is_surface[i] && !flow.setup.is_closed)) {
      row.finish_as_zero();
      return;
    }
    const double sum = set_weights(i, row);
    if (sum > 0.0) {
      row.finish(sum, 0.0);
    } else {
      row.finish_as_zero();  // a lone particle has no pressure
    }
  });
}

}  // namespace tailwater
