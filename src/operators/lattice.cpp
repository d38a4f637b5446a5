#include "operators/lattice.h"

#include <algorithm>
#include <cmath>

#include "operators/laplacian_morris.h"
#include "operators/laplacian_shao_lo.h"

namespace tailwater {

template <int Dim>
LatticeSums lattice_sums(const Kernel<Dim>& kernel, double spacing) {
  const double volume = power<Dim>(spacing);
  const int reach = static_cast<int>(std::ceil(kernel_radius(kernel) / spacing));
  const int reach_z = Dim == 3 ? reach : 0;
  const double eta_squared = shao_lo_eta_squared(kernel_radius(kernel));
  LatticeSums sums;
  // By symmetry C and D vanish and B2 is a multiple of I; E : I = A = tr A/Dim I makes it Dim/tr A, so that the weights
  // (F23) are 2 w W/r^2 Dim/tr A.
  double trace_A = 0.0;
  double inverse_squares = 0.0;
  for (int z = -reach_z; z <= reach_z; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const double r = spacing * std::sqrt(static_cast<double>(x * x + y * y + z * z));
        const double wW = volume * kernel_value(kernel, r);
        sums.concentration += wW;
        if (r == 0.0) continue;
        const double morris = morris_laplacian_weight(volume, kernel_steepness(kernel, r), r * r, spacing);
        sums.morris += morris;
        sums.across_plane += spacing * std::max(0, y) * morris;  // y pairs of rows are y apart
        sums.shao_lo += shao_lo_laplacian_weight(volume, 1.0, 1.0, r, kernel_derivative(kernel, r), eta_squared);
        trace_A += wW;
        inverse_squares += wW / (r * r);
      }
    }
  }
  sums.consistent = 2.0 * inverse_squares * Dim / trace_A;
  return sums;
}

template LatticeSums lattice_sums<2>(const Kernel<2>&, double);
template LatticeSums lattice_sums<3>(const Kernel<3>&, double);

}  // namespace tailwater
