// The resolution of a flow where no zone of refinement is: the particle spacing, and what follows from it and the
// kernel.
#pragma once

#include "kernel/kernel.h"
#include "operators/lattice.h"

namespace tailwater {

template <int Dim>
struct Scale {
  Scale(double dx, const Kernel<Dim>& of_formulation)
      : spacing(dx),
        kernel(of_formulation),
        lattice(lattice_sums(kernel, spacing)),
        kernel_values(kernel_values_of(kernel, spacing)) {}

  double spacing;  ///< m; dx of the case
  Kernel<Dim> kernel;
  LatticeSums lattice;
  KernelValues kernel_values;
};

}  // namespace tailwater
