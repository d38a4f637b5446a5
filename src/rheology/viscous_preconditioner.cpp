#include "rheology/viscous_preconditioner.h"

#include "base/for_each.h"
#include "linear/find_cells.h"
#include "neighbours/halo.h"

namespace tailwater {

template <int Dim>
ViscousPreconditioner<Dim>::ViscousPreconditioner(const Flow<Dim>& flow, const ViscousOperator<Dim>& forces,
                                                  std::span<const double> inertia)
    : component_(inertia.size()), correction_(inertia.size()) {
  const int count = forces.slips() || forces.coulomb().slides_anywhere(flow) ? Dim : 1;
  for (int a = 0; a < count; ++a) {
    matrices_.push_back(std::make_unique<Matrix>(flow.setup.ranks));
    fill(flow, forces, inertia, a, *matrices_.back());
  }
}

template <int Dim>
void ViscousPreconditioner<Dim>::fill(const Flow<Dim>& flow, const ViscousOperator<Dim>& forces,
                                      std::span<const double> inertia, int a, Matrix& matrix) const {
  const Particles<Dim>& particles = flow.state.particles;
  const std::size_t owned = particles.owned;
  LinearSystem& rows = matrix.rows;
  rows.set_pattern(flow.pairs().row_begin, flow.pairs().j, flow.halo().plan);
  rows.set_cells(find_cells<Dim>(std::span(particles.position).first(owned), cell_edge * flow.setup.scale.spacing,
                                 [&](std::size_t i) { return flow.role[i] == Role::water; }));
  matrix.scale.assign(owned, 0.0);
  for_each(owned, [&](std::size_t i) {
    LinearSystem::Row row = rows.row(i);
    if (flow.role[i] != Role::water) return row.finish_as_zero();
    const double own = inertia[i] + forces.friction_of_walls(flow, i, a);
    const double diagonal =
        own + row.write_weights([&](float* weights) { return forces.write_weights(flow, i, weights); });
    row.finish(diagonal, 0.0);
    matrix.scale[i] = 1.0 / diagonal;
  });
  matrix.multigrid = std::make_unique<CellMultigrid>(rows);
}

template <int Dim>
void ViscousPreconditioner<Dim>::apply(std::span<const Vec<Dim>> force, std::span<Vec<Dim>> velocity) {
  for (int a = 0; a < Dim; ++a) {
    const Matrix& matrix = *matrices_[matrices_.size() > 1 ? a : 0];
    for_each(force.size(), [&](std::size_t i) { component_[i] = matrix.scale[i] * force[i][a]; });
    matrix.multigrid->apply(component_, correction_);
    for_each(force.size(), [&](std::size_t i) { velocity[i][a] = correction_[i]; });
  }
}

template class ViscousPreconditioner<2>;
template class ViscousPreconditioner<3>;

}  // namespace tailwater
