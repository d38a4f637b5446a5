// The tensors that make the first and second derivative exact on any set of neighbours.
// Farzin et al. (2014), (F10) and (F13), with e = e_ij, W = W_ij, w = w_j, r = |r_ij|:
//
//   A  = sum w W e e                      B1 = A^-1
//   C  = sum w (W/r) e e e                D  = sum w W r e e e              E = sum w W e e e e
//   B2 : [ E - C . B1 . D ] = I           (B2 symmetric: 3 unknowns in 2D, 6 in 3D)
//
// B1 makes (F9) exact for linear fields, B2 makes (F12) exact for quadratic fields, at boundaries too, as long as the
// neighbours span enough directions. Where they do not, the tensors blow up; `gradient_is_sound` and
// `laplacian_is_sound` are true where they may be used.
#pragma once

#include <span>
#include <vector>

#include "neighbours/pairs.h"
#include "operators/symmetric.h"

namespace tailwater {

/// Smallest eigenvalue of A below which the neighbours do not span space well enough for a gradient: 0.1 in 2D. In the
/// interior A is about I/Dim, so the bound scales with 1/Dim.
template <int Dim>
inline constexpr double min_sound_eigenvalue = 0.2 / Dim;

/// Largest |B2xx| + |B2yy| + |B2xy| (and so on in 3D) at which a Laplacian row is used: 20 in 2D, where the sum is 4.9
/// in the interior and 215 at a corner. The interior value scales with Dim^2, and so does the bound.
template <int Dim>
inline constexpr double largest_sound_b2_sum = 5.0 * Dim* Dim;

template <int Dim>
struct Renormalisation {
  Mat<Dim> B1 = Mat<Dim>::Zero();
  Packed<Dim> B2 = Packed<Dim>::Zero();
  Vec<Dim> drift = Vec<Dim>::Zero();  ///< 1/m; B1 . (C : B2), the first-derivative part of the row (F23)
  double trace_A = 0.0;
  double min_eigenvalue_A = 0.0;
  double b2_sum = 0.0;       ///< S_B2: sum of |entries|, each off-diagonal entry once
  bool has_inverse = false;  ///< whether A and the system of B2 could be inverted
  bool gradient_is_sound() const { return has_inverse && min_eigenvalue_A > min_sound_eigenvalue<Dim>; }
  bool laplacian_is_sound() const { return gradient_is_sound() && b2_sum < largest_sound_b2_sum<Dim>; }
};

template <int Dim>
using Tensors = std::vector<Renormalisation<Dim>>;

/// The tensors of every owned particle from all its neighbours with `takes_part[j]` (fluid, and walls that carry their
/// own unknowns).
template <int Dim>
void compute_renormalisation(const Pairs<Dim>& pairs, std::span<const double> volume,
                             std::span<const std::uint8_t> takes_part, std::span<Renormalisation<Dim>> result);

}  // namespace tailwater
