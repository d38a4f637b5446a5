// Missing neighbours count as air at p = 0 in the pressure equation. Their weight is the deficit of the row's Laplacian
// weights against a full lattice, max(0, A_0 - sum_j c_ij). This deficit would be exact if the missing neighbours stood
// on the surface, where p = 0. They stand above it, where a pressure linear in depth continues below 0. For a particle
// at depth d the missing terms c_ij (p_i - p_j) are therefore larger by the factor
//
//   1 + int_{z > d} (z - d) c dV / (d int_{z > d} c dV),
//
// The missing share also follows from d, so the factor is a function of that share: 1 where nothing is missing, 2 for
// the outermost row of a lattice, nearly the same in 2D and 3D (docs/theory/closures.md).
#pragma once

#include <array>

#include "kernel/kernel.h"

namespace tailwater {

class AirLaw {
 public:
  AirLaw() = default;
  /// Tabulates the factor for weights -dW/dr / r (Morris) under a flat surface. The shallowest depth is half of
  /// `spacing`, that of the outermost particles.
  template <int Dim>
  AirLaw(const Kernel<Dim>& kernel, double spacing);

  /// Weight of the air [unit of `full`] in a row whose weights sum to `sum`; on a full lattice they sum to `full`. 0 if
  /// nothing is missing.
  double weight(double sum, double full) const;

 private:
  static constexpr int depths = 32;
  std::array<double, depths> missing_{};  ///< missing share of the weights, ascending
  std::array<double, depths> factor_{};
};

}  // namespace tailwater
