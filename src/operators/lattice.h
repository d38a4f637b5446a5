// Sums over a full cubic lattice of spacing dx: the sums of an interior particle on a perfect set. They are the
// reference for how much of a neighbourhood is missing.
#pragma once

#include "kernel/kernel.h"

namespace tailwater {

struct LatticeSums {
  double concentration = 0.0;  ///< w W(0) + sum w W, close to 1
  double morris = 0.0;         ///< 1/m^2; sum of the Morris Laplacian weights
  double across_plane = 0.0;   ///< 1/m; dx times the Morris weights from a column on one side of a plane to the other
};

template <int Dim>
LatticeSums lattice_sums(const Kernel<Dim>& kernel, double spacing);

}  // namespace tailwater
