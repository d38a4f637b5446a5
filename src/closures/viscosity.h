// Effective viscosity and the viscous acceleration.
//
//   nu_eff = nu_0 + c_a |u| dx    (F3)
//
// (F3) vanishes at rest, and the water in a jittered tank then boils (docs/theory/closures.md). It is no model of wall
// friction: on a smooth wall it gave the stress 0.034 rho u^2, twenty times that of water. wall_law.h and
// spalart_allmaras.h model the friction of walls.
#pragma once

#include <span>

#include "closures/liquid.h"
#include "operators/pair_vectors.h"
#include "particles/particles.h"

namespace tailwater {

/// Effective viscosity [m^2/s] of every particle, ghosts included.
template <int Dim>
void effective_viscosity(const ViscosityLaw& law, std::span<const Vec<Dim>> velocity, std::span<double> viscosity);

/// Viscous acceleration of a Newtonian fluid, div(2 nu S), over fluid neighbours:
///
///   sum_j (nu_i + nu_j)/2 [ c_ij (u_j - u_i) + w_j (grad u_i + grad u_j)^T a_ij ],
///
/// where a_ij is the pair vector and c_ij the Morris weight with a_ij . e_ij for dW_ij. The first term alone is nu lap
/// u, whose natural condition at a free surface is du/dn = 0: waves then decay too slowly, by a third. The second term,
/// the divergence of (grad u)^T, vanishes in the interior and turns that condition into zero stress. Conserves
/// momentum; only the first term is certain never to add energy. `gradient` [1/s] is needed on ghosts.
///
/// A `noise_viscosity` [m^2/s] above 0 dissipates noise. It is one number for the whole flow, proportional to the
/// spacing where that varies. Its two-point viscous force acts on the part of the velocity difference that a linear
/// field does not explain,
///
///   d_ij = u_j - u_i - l_ij,    l_ij = (grad u_i + grad u_j)/2 . (r_j - r_i),
///
/// without its component along u_j - u_i where that component would add energy. Between two particles of a boundary
/// layer, d_ij is also without its component along l_ij, so that the force does not flatten the logarithmic profile.
/// For other pairs with a wall with friction in reach of one particle, gradients are one-sided. There l_ij is the
/// difference nearest to u_j - u_i between those that either gradient alone explains (docs/theory/friction.md).
///
/// The force vanishes for linear fields and is of fourth order in the wave number of a smooth field. Pairs are
/// antisymmetric, so momentum is conserved, and energy never grows. `density` of all particles, over that of the case,
/// is empty for one liquid. Otherwise noise is damped only between particles of the same density, because an interface
/// is a vortex sheet and not noise. 0 is for a liquid without this force. `noise_factor` of all particles
/// multiplies the noise viscosity of a pair with the mean of both; empty: 1.
template <int Dim>
void add_newtonian_viscosity(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double spacing,
                             const PairVectorField<Dim>& pair_vectors, std::span<const double> viscosity,
                             double noise_viscosity, std::span<const Vec<Dim>> velocity,
                             std::span<const Mat<Dim>> gradient, std::span<Vec<Dim>> acceleration,
                             std::span<const float> density = {}, std::span<const float> noise_factor = {});

}  // namespace tailwater
