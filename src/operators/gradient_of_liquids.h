// Pressure gradient over the density, times the density rho_0 of the case, where liquids of several densities meet:
//
//   (rho_0/rho_i) grad p_i = (rho_0/rho_i) sum_j w_j 2 p_ij a_ij,   p_ij of interfaces.h
//
// In one liquid it is that of gradient_conservative.h. Antisymmetric pair by pair: linear momentum is conserved.
#pragma once

#include "operators/gradient_conservative.h"
#include "operators/interfaces.h"

namespace tailwater {

template <int Dim>
Vec<Dim> gradient_over_density(const Pairs<Dim>& pairs, std::size_t i, std::span<const double> volume,
                               const Interfaces& interfaces, const PairVectorField<Dim>& pair_vectors,
                               std::span<const double> field) {
  const auto twice_pressure = [&](const auto& batch, const Lanes& own, const Lanes& other) {
    return interfaces.twice_pressure_of(batch, own, other);
  };
  return conservative_gradient<Dim>(pairs, i, volume, pair_vectors, field, twice_pressure) / interfaces.density[i];
}

}  // namespace tailwater
