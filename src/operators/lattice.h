// Sums over a full cubic lattice of spacing dx: the sums of an interior particle on a perfect set. They are the
// reference for how much of a neighbourhood is missing.
#pragma once

#include <cmath>

#include "kernel/kernel.h"

namespace tailwater {

struct LatticeSums {
  double concentration = 0.0;  ///< w W(0) + sum w W, close to 1
  double morris = 0.0;         ///< 1/m^2; sum of the Morris Laplacian weights
  double across_plane = 0.0;   ///< 1/m; dx times the Morris weights from a column on one side of a plane to the other
};

/// Values of the kernel [1/m^Dim] for particles with the case's spacing.
struct KernelValues {
  double W_0;        ///< W(0)
  double W_spacing;  ///< W(dx)
  double close;      ///< (W(0.8 dx)/W(dx))^4, no unit: the weight against pairing acts between closer particles
};

template <int Dim>
KernelValues kernel_values_of(const Kernel<Dim>& kernel, double spacing) {
  const double W_spacing = kernel_value(kernel, spacing);
  const double ratio = kernel_value(kernel, 0.8 * spacing) / W_spacing;
  return {kernel_value(kernel, 0.0), W_spacing, ratio * ratio * ratio * ratio};
}

/// Calls visit(rows, r) for all nodes in a cube around a node, itself included, that contains the support of the
/// kernel: the number of rows from the node in the middle up to this one, and the distance from it [m].
template <int Dim, class Visit>
void visit_lattice(const Kernel<Dim>& kernel, double spacing, Visit&& visit) {
  const int reach = static_cast<int>(std::ceil(kernel_radius(kernel) / spacing));
  const int reach_z = Dim == 3 ? reach : 0;
  for (int z = -reach_z; z <= reach_z; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        visit(y, spacing * std::sqrt(static_cast<double>(x * x + y * y + z * z)));
      }
    }
  }
}

template <int Dim>
LatticeSums lattice_sums(const Kernel<Dim>& kernel, double spacing);

}  // namespace tailwater
