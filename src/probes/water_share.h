// How much of the space that walls leave free around a place is water:
//
//   c(x) = S_f / max(1 - S_w, 2^-Dim),    S_f = sum over fluid w W(x - x_j),    S_w = sum over wall particles
//
// Under water c = 1, in air c = 0, and on a flat surface c = 1/2: of a lattice whose top row lies dx/2 below it, the
// surface is the plane of symmetry, so fluid and air halve the sum over the full lattice, which is 1 up to the error of
// kernel quadrature. Where walls cut the surface at a right angle they take the same share of either half, and c stays
// 1/2. Up to a right-angled corner walls leave at least 2^-Dim; behind them the bound lets c fall to 0.
#pragma once

#include "probes/context.h"

namespace tailwater {

/// Water is where c exceeds this.
inline constexpr double surface_share = 0.5;

template <int Dim>
double water_share(const ProbeContext<Dim>& context, const Vec<Dim>& x);

/// c with the wall particles behind the plane through `bed` with normal `bed_normal` taken for water. A layer of water
/// thinner than the support then continues into its bed, and c = 1/2 on its surface too.
template <int Dim>
double water_share_above_wet_bed(const ProbeContext<Dim>& context, const Vec<Dim>& x, const Vec<Dim>& bed,
                                 const Vec<Dim>& bed_normal);

}  // namespace tailwater
