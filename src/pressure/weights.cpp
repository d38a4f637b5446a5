// The matrix of the pressure equation. Rows of walls come from their model (walls/wall_model.h), rows of claimed water
// from the parts that claim it, and rows of other water from the formulation (robust/rows.cpp, published).
#include "base/for_each.h"
#include "flow/pressure_equation.h"
#include "linear/find_cells.h"
#include "neighbours/halo.h"
#include "pressure/stages.h"
#include "walls/wall_model.h"

namespace tailwater {
template <int Dim>
std::size_t assemble_weights(Flow<Dim>& flow, const WallDrive<Dim>& drive) {
  if (flow.equation->has_matrix) {  // no row of it fell back (Flow::keeps_matrix)
    flow.wall_model().set_sources(flow.wall_scene(), flow.wall_force(drive.acceleration), flow.equation->rows);
    return 0;
  }
  flow.equation->rows.set_pattern(flow.pairs().row_begin, flow.pairs().j, flow.halo().plan);
  if (flow.equation->solver.needs_cells()) {
    const std::span positions(flow.state.particles.position);
    flow.equation->rows.set_cells(
        find_cells<Dim>(positions.first(flow.state.particles.owned), cell_edge * flow.setup.scale.spacing,
                        [&](std::size_t i) { return has_equation(flow.role[i]) && flow.role[i] != Role::following; }));
  }
  flow.wall_model().assemble_rows(flow.wall_scene(), flow.wall_force(drive.acceleration), flow.equation->rows);
  const std::size_t fallback_rows = flow.discretisation().write_rows(flow);
  for (const auto& part : flow.parts) part->write_rows(flow);
  return fallback_rows;
}

TAILWATER_IN_2D_AND_3D(assemble_weights);

}  // namespace tailwater
