// Missing neighbours as air at p = 0 in the pressure equation. What is missing of a full row of Laplacian weights,
// max(0, A_0 - sum_j c_ij), would be exact if the missing neighbours stood where p = 0, on the surface. They stand
// above it, where a pressure that is linear in depth goes on below 0: for a particle at depth d the missing weights
// c_ij (p_i - p_j) are larger by the factor
//
//   1 + int_{z > d} (z - d) c dV / (d int_{z > d} c dV),
//
// which belongs to one share missing, as both follow from d. So the factor is a function of that share: 1 where nothing
// is missing, 2 for the outermost row of a lattice, nearly the same in 2D and 3D (docs/theory/closures.md).
#pragma once

#include <array>

#include "kernel/kernel.h"

namespace tailwater {

class AirLaw {
 public:
  AirLaw() = default;
  /// For weights -dW/dr / r (Morris), under flat surfaces from half of `spacing` deep on: nothing lies less deep.
  template <int Dim>
  AirLaw(const Kernel<Dim>& kernel, double spacing);

  /// Weight of the air [that of `full`] in a row whose weights sum to `sum` and on a full lattice to `full`. 0 for a
  /// row with nothing missing.
  double weight(double sum, double full) const;

 private:
  static constexpr int depths = 32;
  std::array<double, depths> missing_{};  ///< share of the weights that is missing, rising
  std::array<double, depths> factor_{};
};

}  // namespace tailwater
