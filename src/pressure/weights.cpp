// The matrix of the pressure equation: rows of walls by their model (walls/wall_model.h), of end stretches here, and of
// the water by the formulation (robust/rows.cpp, published).
#include "base/for_each.h"
#include "linear/find_cells.h"
#include "pressure/stages.h"

namespace tailwater {
namespace {

/// [dx] of the cells of a multigrid (linear/cell_multigrid.h).
constexpr double cell_edge = 2.0;

/// Row of a particle in an end stretch. Where the velocity is prescribed, the pressure is that of the water inside, as
/// behind a wall; elsewhere, and as long as there is no water inside, it is hydrostatic.
template <int Dim>
void assemble_end_row(Flow<Dim>& flow, std::size_t i) {
  const Setup<Dim>& setup = flow.setup;
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  const OpenEnd<Dim>& end = setup.open_ends[flow.end_of[i]];
  const auto weight = [&](std::size_t k) {
    const auto j = pairs.j[k];
    return particles.is_fluid(j) && !end.holds(particles.position[j]) ? particles.volume[j] * pairs.value(i, k) : 0.0;
  };
  double total = 0.0;
  for (std::size_t k = pairs.begin(i); flow.role[i] == Role::inflow_end && k < pairs.end(i); ++k) total += weight(k);
  LinearSystem::Row row = flow.pressure_rows.row(i);
  if (total == 0.0) {
    row.set_weights([](std::size_t) { return 0.0; });
    row.finish(1.0, end.pressure_at(flow.state.open_ends[flow.end_of[i]], particles.position[i], setup.density));
    return;
  }
  double hydrostatic = 0.0;
  const double sum = row.set_weights([&](std::size_t k) {
    const double share = weight(k) / total;
    hydrostatic += share * setup.density * setup.gravity.dot(pairs.d(i, k));
    return share;
  });
  row.finish(sum, hydrostatic);
}

}  // namespace

template <int Dim>
std::size_t assemble_weights(Flow<Dim>& flow, const WallDrive<Dim>& drive) {
  if (flow.has_matrix) {  // no row of it fell back (Setup::keeps_matrix)
    flow.wall_model().set_sources(flow.wall_scene(), flow.wall_force(drive.acceleration), flow.pressure_rows);
    return 0;
  }
  flow.pressure_rows.set_pattern(flow.pairs().row_begin, flow.pairs().j, flow.halo().plan);
  if (flow.pressure_solver.needs_cells()) {
    const std::span positions(flow.state.particles.position);
    flow.pressure_rows.set_cells(
        find_cells<Dim>(positions.first(flow.state.particles.owned), cell_edge * flow.setup.spacing,
                        [&](std::size_t i) { return has_equation(flow.role[i]) && flow.role[i] != Role::inflow_end; }));
  }
  flow.wall_model().assemble_rows(flow.wall_scene(), flow.wall_force(drive.acceleration), flow.pressure_rows);
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (is_in_end_stretch(flow.role[i])) assemble_end_row(flow, i);
  });
  for (const auto& part : flow.parts) part->write_rows(flow);
  return flow.discretisation().write_rows(flow);
}

TAILWATER_IN_2D_AND_3D(assemble_weights);

}  // namespace tailwater
