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

template <int Dim>
LatticeSums lattice_sums(const Kernel<Dim>& kernel, double spacing);

}  // namespace tailwater
