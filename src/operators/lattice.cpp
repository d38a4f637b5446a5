#include "operators/lattice.h"

#include <algorithm>

#include "operators/laplacian_morris.h"

namespace tailwater {

template <int Dim>
LatticeSums lattice_sums(const Kernel<Dim>& kernel, double spacing) {
  const double volume = power<Dim>(spacing);
  LatticeSums sums;
  visit_lattice(kernel, spacing, [&](int rows, double r) {
    sums.concentration += volume * kernel_value(kernel, r);
    if (r == 0.0) return;
    const double morris = morris_laplacian_weight(volume, kernel_steepness(kernel, r), r * r, spacing);
    sums.morris += morris;
    sums.across_plane += spacing * std::max(0, rows) * morris;  // `rows` pairs of rows are as far apart
  });
  return sums;
}

TAILWATER_IN_2D_AND_3D(lattice_sums);

}  // namespace tailwater
