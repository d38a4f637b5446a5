// Particle shifting of Farzin et al. (2014):
//
//   dr_i = eps |u_i| dt R_i,    R_i = sum_j (rbar_i/r_ij)^3 e_ij                (F28)-(F30)
//   u_i <- u_i + grad u_i . dr_i,    p_i <- p_i + grad p_i . dr_i               (F31), (F32)
//
// Only the fraction `interior` of the shift is kept, and it is bounded (closures/shifting.h): the paper has neither
// limit. (F31) and (F32) act inside the fluid where (F9) is sound.
#pragma once

#include "closures/shifting.h"
#include "closures/surroundings.h"
#include "published/renormalisation.h"

namespace tailwater {

/// Shifts [m] of owned particles, with eps = `law.strength`. Returns the number of shifts that the bound has shortened.
template <int Dim>
std::size_t find_published_shifts(const ShiftingLaw& law, double dt, const Pairs<Dim>& pairs,
                                  const Particles<Dim>& particles, const Surroundings<Dim>& surroundings,
                                  std::span<Vec<Dim>> shifts);

/// (F31), (F32); velocity and pressure must be up to date on ghosts and walls.
template <int Dim>
void carry_fields_along(const Pairs<Dim>& pairs, const Tensors<Dim>& tensors, const Surroundings<Dim>& surroundings,
                        std::span<const Vec<Dim>> shifts, Particles<Dim>& particles);

}  // namespace tailwater
