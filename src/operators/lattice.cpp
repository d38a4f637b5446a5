#include "operators/lattice.h"

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
        if (r > 0.0) sums.morris += morris_laplacian_weight(volume, r, kernel_derivative(kernel, r), spacing);
      }
    }
  }
  return sums;
}

template LatticeSums lattice_sums<2>(const Kernel<2>&, double);
template LatticeSums lattice_sums<3>(const Kernel<3>&, double);

}  // namespace tailwater
