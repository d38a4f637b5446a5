// The matrix of the pressure equation. For fluid particle i
//
//   sum_j c_ij (p_i - p_j) + a_i p_i = source_i        (source.cpp)
//
// c_ij   weights of the Laplacian: Morris, consistent (F23), or (B8)
// a_i    closes the row. It blends two values by `interior`:
//        - Near the surface, the weight of the air (air.h). The weight missing from A_0, the sum_j c_ij of a full
//          lattice, counts as p = 0 on the surface (the idea of Nair & Tomar 2014). The equation needs no surface
//          detection.
//        - Inside, 4 |sum_j w_j a_ij|^2 and a little softness. The force of a uniform pressure p is
//          -2 p sum_j w_j a_ij, so div grad p contains the negative of that square times p. Without this term in the
//          matrix, pressures of deep disordered water overshoot from step to step with the kernel's own gradients as
//          pair vectors (docs/theory/robustness.md), and with corrected ones a collision of drops gains energy.
//        Where the scheme marks the surface instead, a_i = 0 and rows of marked particles are p = 0.
//
// The wall model writes the rows of wall particles (walls/wall_model.h). Dry walls: p = 0.
#include <cmath>

#include "base/for_each.h"
#include "linear/find_cells.h"
#include "neighbours/pair_lanes.h"
#include "operators/laplacian_consistent.h"
#include "operators/laplacian_morris.h"
#include "operators/laplacian_shao_lo.h"
#include "pressure/verbs.h"

namespace tailwater {
namespace {

/// [1/dx^2]; weight in every row inside, as if sound travelled 100 dx per step. Nothing else fixes the mean pressure of
/// ordered water that fills its box. Under a surface it compresses the bottom by 0.03 % (0.1 % at the implicit step).
constexpr double softness = 1e-4;

/// [dx] of the cells of a multigrid (linear/cell_multigrid.h).
constexpr double cell_edge = 2.0;

/// Sets the weights of row i and returns their sum. `volume_taking_part` is 0 for particles that do not.
template <int Dim>
double set_laplacian_weights(const Flow<Dim>& flow, std::span<const float> volume_taking_part, std::size_t i,
                             LinearSystem::Row& row, bool& fell_back) {
  const Pairs<Dim>& pairs = flow.pairs();
  const Surroundings<Dim>& here = flow.here;
  const std::vector<double>& volume = flow.state.particles.volume;
  const double spacing = flow.setup.spacing;
  if (flow.setup.scheme.laplacian == LaplacianKind::morris) {
    return row.write_weights([&](float* weights) {
      LaneSum sums;
      for_each_pair(pairs, i, [&](const auto& several) {
        const VecLanes<Dim> d = several.place().d;
        const Lanes share = share_of_morris_weight(d.dot(d), spacing);
        sums += several.store(2.0F * share * several.of(volume_taking_part) * several.F(), weights);
      });
      return sums.total();
    });
  }
  if (flow.setup.scheme.laplacian == LaplacianKind::shao_lo) {
    const std::vector<double>& density = here.concentration;
    return row.set_weights([&](std::size_t k) {
      const auto j = pairs.j[k];
      return here.takes_part[j] ? shao_lo_laplacian_weight(volume[j], density[i], density[j], pairs.r(i, k),
                                                           pairs.slope(i, k), flow.setup.eta_squared)
                                : 0.0;
    });
  }
  const Renormalisation<Dim>& tensors = here.tensors[i];
  if (tensors.laplacian_is_sound()) {
    const double sum = row.set_weights([&](std::size_t k) {
      return here.takes_part[pairs.j[k]] ? consistent_laplacian_weight<Dim>(tensors, volume[pairs.j[k]], pairs.e(i, k),
                                                                            pairs.r(i, k), pairs.value(i, k))
                                         : 0.0;
    });
    if (sum > 0.0) return sum;
  }
  fell_back = true;
  return row.set_weights([&](std::size_t k) {
    return here.takes_part[pairs.j[k]]
               ? fallback_laplacian_weight(tensors, volume[pairs.j[k]], pairs.r(i, k), pairs.value(i, k), spacing)
               : 0.0;
  });
}

/// Sum of the weights on a full lattice.
template <int Dim>
double full_sum(const Setup<Dim>& setup) {
  switch (setup.scheme.laplacian) {
    case LaplacianKind::consistent:
      return setup.lattice.consistent;
    case LaplacianKind::shao_lo:
      return setup.lattice.shao_lo;
    case LaplacianKind::morris:
      break;
  }
  return setup.lattice.morris;
}

/// a_i of a row whose weights sum to `sum`: air near the surface and on walls, open faces and softness inside.
template <int Dim>
double closing_weight(const Flow<Dim>& flow, std::size_t i, double sum) {
  const double air = flow.setup.air_law.weight(sum, full_sum(flow.setup));
  const double interior = flow.here.interior[i];
  if (interior == 0.0) return air;
  const double spacing = flow.setup.spacing;
  const double inside = 4.0 * flow.here.open_faces[i].squaredNorm() + softness / (spacing * spacing);
  return std::lerp(air, inside, interior);
}

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
  for (std::size_t k = pairs.begin(i); flow.role[i] == Role::fed_end && k < pairs.end(i); ++k) total += weight(k);
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

/// Writes row i without its source. Returns whether it had to fall back to two-point weights.
template <int Dim>
bool assemble_equation(Flow<Dim>& flow, std::span<const float> volume_taking_part, std::size_t i) {
  const Setup<Dim>& setup = flow.setup;
  if (is_in_end_stretch(flow.role[i])) {
    assemble_end_row(flow, i);
    return false;
  }
  LinearSystem::Row row = flow.pressure_rows.row(i);
  const bool is_dry = !flow.here.takes_part[i];  // a wall
  if (is_dry || (!setup.has_air() && flow.here.is_surface[i] && !setup.is_closed)) {
    row.finish_as_zero();
    return false;
  }
  bool fell_back = false;
  const double sum = set_laplacian_weights(flow, volume_taking_part, i, row, fell_back);
  const double own = setup.has_air() ? closing_weight(flow, i, sum) : 0.0;
  if (sum + own <= 0.0) {
    row.finish_as_zero();  // a lone particle has no pressure
    return fell_back;
  }
  row.finish(sum + own, 0.0);
  return fell_back;
}

}  // namespace

template <int Dim>
std::size_t assemble_weights(Flow<Dim>& flow, const WallDrive<Dim>& drive) {
  if (flow.has_matrix) {  // no row of it fell back (Setup::keeps_matrix)
    flow.setup.wall_model->set_sources(flow.wall_scene(), flow.wall_force(drive.acceleration), flow.pressure_rows);
    return 0;
  }
  flow.pressure_rows.set_pattern(flow.pairs().row_begin, flow.pairs().j, flow.halo().plan);
  if (flow.pressure_solver.needs_cells()) {
    const std::span positions(flow.state.particles.position);
    flow.pressure_rows.set_cells(
        find_cells<Dim>(positions.first(flow.state.particles.owned), cell_edge * flow.setup.spacing,
                        [&](std::size_t i) { return has_equation(flow.role[i]) && flow.role[i] != Role::fed_end; }));
  }
  flow.setup.wall_model->assemble_rows(flow.wall_scene(), flow.wall_force(drive.acceleration), flow.pressure_rows);
  std::vector<float> volume(flow.state.particles.size());
  for_each(volume.size(), [&](std::size_t j) {
    volume[j] = flow.here.takes_part[j] ? static_cast<float>(flow.state.particles.volume[j]) : 0.0F;
  });
  return count_each(flow.state.particles.owned,
                    [&](std::size_t i) { return has_equation(flow.role[i]) && assemble_equation(flow, volume, i); });
}

template std::size_t assemble_weights<2>(Flow<2>&, const WallDrive<2>&);
template std::size_t assemble_weights<3>(Flow<3>&, const WallDrive<3>&);

}  // namespace tailwater
