// The viscous terms of the papers.
#pragma once

#include <cstdint>
#include <span>

#include "particles/particles.h"
#include "published/renormalisation.h"

namespace tailwater {

/// Two-point viscous acceleration with the weights of (B8), as in (B9): sum_j c_ij (nu_i + nu_j)/2 (u_j - u_i).
/// Conserves momentum and never adds energy. `density` is each particle's density over the water's.
template <int Dim>
void add_shao_lo_viscosity(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double eta_squared,
                           std::span<const double> density, std::span<const double> viscosity,
                           std::span<const Vec<Dim>> velocity, std::span<Vec<Dim>> acceleration);

/// nu_i lap u by the consistent operator (F12), or by its two-point fallback where that operator is unsound.
template <int Dim>
void add_consistent_viscosity(const Pairs<Dim>& pairs, const Particles<Dim>& particles,
                              std::span<const Renormalisation<Dim>> tensors, std::span<const std::uint8_t> takes_part,
                              double spacing, std::span<const double> viscosity, std::span<const Vec<Dim>> velocity,
                              std::span<Vec<Dim>> acceleration);

}  // namespace tailwater
