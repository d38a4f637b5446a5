// The fraction of water in the space around a place that walls leave free:
//
//   c(x) = S_f / max(1 - S_w, 2^-Dim),    S_f = sum over fluid w W(x - x_j),    S_w = sum over wall particles
//
// Under water c = 1, in air c = 0, and on a flat surface c = 1/2: a lattice whose top row is dx/2 below the surface has
// the surface as plane of symmetry. Fluid and air then each have half of the sum over the full lattice, which is 1 up
// to the error of kernel quadrature. Walls that cut the surface at a right angle take equal fractions of both halves,
// and c stays 1/2. Walls leave at least 2^-Dim free, up to a right-angled corner. Behind them the bound lets c fall to
// 0.
#pragma once

#include <algorithm>

#include "probes/context.h"

namespace tailwater {

/// There is water where c exceeds this.
inline constexpr double surface_share = 0.5;

/// c from both sums.
template <int Dim>
double water_share(double water, double wall) {
  return water / std::max(1.0 - wall, power<Dim>(0.5));
}

template <int Dim>
double water_share(const ProbeContext<Dim>& context, const Vec<Dim>& x);

/// c with the wall particles behind the plane through `bed` with normal `bed_normal` counted as water. A layer of water
/// thinner than the support then continues into its bed, and c = 1/2 also on its surface.
template <int Dim>
double water_share_above_wet_bed(const ProbeContext<Dim>& context, const Vec<Dim>& x, const Vec<Dim>& bed,
                                 const Vec<Dim>& bed_normal);

}  // namespace tailwater
