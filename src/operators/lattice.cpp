#include "operators/lattice.h"

#include <algorithm>
#include <cmath>

#include "operators/laplacian_morris.h"

namespace tailwater {

template <int Dim>
LatticeSums lattice_sums(const Kernel<Dim>& kernel, double spacing) {
  const double volume = power<Dim>(spacing);
  const int reach = static_cast<int>(std::ceil(kernel_radius(kernel) / spacing));
  const int reach_z = Dim == 3 ? reach : 0;
  LatticeSums sums;
  for (int z = -reach_z; z <= reach_z; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const double r = spacing * std::sqrt(static_cast<double>(x * x + y * y + z * z));
        sums.concentration += volume * kernel_value(kernel, r);
        if (r == 0.0) continue;
        const double morris = morris_laplacian_weight(volume, kernel_steepness(kernel, r), r * r, spacing);
        sums.morris += morris;
        sums.across_plane += spacing * std::max(0, y) * morris;  // y pairs of rows are y apart
      }
    }
  }
  return sums;
}

TAILWATER_IN_2D_AND_3D(lattice_sums);

}  // namespace tailwater
