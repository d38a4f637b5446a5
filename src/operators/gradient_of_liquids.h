// Pressure gradient over the density, times the density rho_0 of the case, where liquids of several densities meet:
//
//   (rho_0/rho_i) grad p_i = (rho_0/rho_i) sum_j w_j 2 p_ij a_ij,   p_ij of interfaces.h
//
// In one liquid it is that of gradient_conservative.h. Antisymmetric pair by pair: linear momentum is conserved.
#pragma once

#include "operators/interfaces.h"
#include "operators/pair_vectors.h"

namespace tailwater {

template <int Dim>
Vec<Dim> gradient_over_density(const Pairs<Dim>& pairs, std::size_t i, std::span<const double> volume,
                               const Interfaces& interfaces, const PairVectorField<Dim>& pair_vectors,
                               std::span<const double> field) {
  VecSum<Dim> sum;
  const Lanes own_volume = in_all_lanes(volume[i]);
  const Lanes own = in_all_lanes(field[i]);
  for_each_pair(pairs, i, [&](const auto& batch) {
    const PairVectorLanes<Dim> pair = pair_vectors(batch);
    sum += own_volume * pair.place.volume() * interfaces.twice_pressure_of(batch, own, batch.of(field)) * pair.a;
  });
  return sum.total() / (volume[i] * interfaces.density[i]);
}

}  // namespace tailwater
