// The matrix of the pressure equation. For fluid particle i
//
//   sum_j c_ij (p_i - p_j) + a_i p_i = source_i        (source.cpp)
//
// c_ij   weights of the two-point Laplacian, all of one sign: an M-matrix
// a_i    closes the row. It blends two values by `interior`:
//        - Near the surface, the weight of the air (closures/air.h). The weight missing from A_0, the sum_j c_ij of a
//          full lattice, counts as p = 0 on the surface (the idea of Nair & Tomar 2014). The equation needs no surface
//          detection.
//        - Inside, 4 |sum_j w_j a_ij|^2 and a little softness. The force of a uniform pressure p is
//          -2 p sum_j w_j a_ij, so div grad p contains the negative of that square times p. Without this term in the
//          matrix, pressures of deep disordered water overshoot from step to step with the kernel's own gradients as
//          pair vectors (docs/theory/robustness.md), and with corrected ones a collision of drops gains energy.
#include <cmath>

#include "base/for_each.h"
#include "flow/pressure_equation.h"
#include "neighbours/pair_lanes.h"
#include "operators/laplacian_morris.h"
#include "robust/discretisation.h"

namespace tailwater {
namespace {

/// [1/dx^2]; weight in every row inside, as if sound travelled 100 dx per step. Nothing else fixes the mean pressure of
/// ordered water that fills its box. Under a surface it compresses the bottom by 0.055 % at the default step.
constexpr double softness = 1e-4;

/// Sets the weights of row i and returns their sum. `volume_taking_part` is 0 for particles that do not.
template <int Dim>
double set_weights(const Flow<Dim>& flow, std::span<const float> volume_taking_part, std::size_t i,
                   LinearSystem::Row& row) {
  const Pairs<Dim>& pairs = flow.pairs();
  const double spacing = flow.setup.scale.spacing;
  return row.write_weights([&](float* weights) {
    LaneSum sums;
    for_each_pair(pairs, i, [&](const auto& batch) {
      const VecLanes<Dim> d = batch.place().d;
      const Lanes share = share_of_morris_weight(batch.squared_over_spacing(d.dot(d)), spacing);
      sums += batch.store(2.0F * share * batch.of(volume_taking_part) * batch.F(d), weights);
    });
    return sums.total();
  });
}

/// Sets the weights c_ij/rho_ij of liquids of several densities. Returns the sum of c_ij, which gives the weight of
/// air.
template <int Dim>
double set_weights_of_liquids(const Flow<Dim>& flow, std::span<const float> volume_taking_part, std::size_t i,
                              LinearSystem::Row& row) {
  const Pairs<Dim>& pairs = flow.pairs();
  const double spacing = flow.setup.scale.spacing;
  LaneSum of_lattice;
  row.write_weights([&](float* weights) {
    LaneSum sums;
    for_each_pair(pairs, i, [&](const auto& batch) {
      const VecLanes<Dim> d = batch.place().d;
      const Lanes share = share_of_morris_weight(batch.squared_over_spacing(d.dot(d)), spacing);
      const Lanes weight = 2.0F * share * batch.of(volume_taking_part) * batch.F(d);
      of_lattice += weight;
      sums += batch.store(weight / flow.surroundings.interfaces.density_of(batch), weights);
    });
    return sums.total();
  });
  return of_lattice.total();
}

}  // namespace

/// a_i of a row whose weights sum to `sum`: air near the surface and on walls, open faces and softness inside.
template <int Dim>
double RobustDiscretisation<Dim>::closing_weight(const Flow<Dim>& flow, std::size_t i, double sum) const {
  const double interior = flow.surroundings.interior[i];
  const auto air = [&] { return laws_.air.weight(sum, flow.lattice_of(i).morris); };
  if (interior == 0.0) return air();
  const double spacing = flow.setup.scale.spacing * flow.pairs().relative_spacing_of(i);
  const double inside = 4.0 * flow.surroundings.open_faces[i].squaredNorm() + softness / (spacing * spacing);
  return interior == 1.0 ? inside : std::lerp(air(), inside, interior);
}

template <int Dim>
void RobustDiscretisation<Dim>::find_air_weights(const Flow<Dim>& flow, std::span<const std::size_t> particles,
                                                 std::span<double> weights) const {
  for_each(particles.size(), [&](std::size_t n) {
    const std::size_t i = particles[n];
    const Interfaces& interfaces = flow.surroundings.interfaces;
    const double density = interfaces.are_any() ? interfaces.density[i] : 1.0;  // of all neighbours
    weights[n] = closing_weight(flow, i, density * flow.equation->rows.sum_of_weights(i)) / density;
  });
}

template <int Dim>
std::size_t RobustDiscretisation<Dim>::write_rows(Flow<Dim>& flow) const {
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<float> volume(particles.size());
  for_each(volume.size(), [&](std::size_t j) {
    volume[j] = flow.surroundings.takes_part[j] ? static_cast<float>(particles.volume[j]) : 0.0F;
  });
  const bool has_air = flow.setup.has_air();
  const bool has_liquids = flow.surroundings.interfaces.are_any();
  for_each(particles.owned, [&](std::size_t i) {
    if (flow.role[i] != Role::water) return;
    LinearSystem::Row row = flow.equation->rows.row(i);
    double sum = 0.0;
    double own = 0.0;
    if (has_liquids) {
      const double of_lattice = set_weights_of_liquids(flow, volume, i, row);
      sum = flow.equation->rows.sum_of_weights(i);
      own = has_air ? closing_weight(flow, i, of_lattice) / flow.surroundings.interfaces.density[i] : 0.0;
    } else {
      sum = set_weights(flow, volume, i, row);
      own = has_air ? closing_weight(flow, i, sum) : 0.0;
    }
    if (sum + own > 0.0) {
      row.finish(sum + own, 0.0);
    } else {
      row.finish_as_zero();  // a lone particle has no pressure
    }
  });
  return 0;
}

#define TAILWATER_INSTANTIATE(Dim)                                                                          \
  template void RobustDiscretisation<Dim>::find_air_weights(const Flow<Dim>&, std::span<const std::size_t>, \
                                                            std::span<double>) const;                       \
  template double RobustDiscretisation<Dim>::closing_weight(const Flow<Dim>&, std::size_t, double) const;   \
  template std::size_t RobustDiscretisation<Dim>::write_rows(Flow<Dim>&) const;
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
