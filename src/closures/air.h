// In the pressure equation, missing neighbours count as air at p = 0. Their weight is the deficit of the row's
// Laplacian weights relative to a full lattice, max(0, A_0 - sum_j c_ij). This deficit would be exact if the missing
// neighbours were on the surface, where p = 0. They are above it, where a pressure linear in depth continues below 0.
// For a particle at depth d the missing terms c_ij (p_i - p_j) are therefore larger by the factor
//
//   1 + int_{z > d} (z - d) c dV / (d int_{z > d} c dV).
//
// The missing fraction of the weights also follows from d. The factor is therefore a function of that fraction: 1 where
// nothing is missing, 2 for the outermost row of a lattice, nearly the same in 2D and 3D (docs/theory/closures.md).
#pragma once

#include <array>

#include "kernel/kernel.h"

namespace tailwater {

class AirLaw {
 public:
  AirLaw() = default;
  /// Tabulates the factor for weights -dW/dr / r (Morris) below a flat surface. The shallowest depth is half of
  /// `spacing` [m], that of the outermost particles.
  template <int Dim>
  AirLaw(const Kernel<Dim>& kernel, double spacing);

  /// Weight of the air in a row whose weights sum to `sum`, where those of a full lattice sum to `full`; same unit as
  /// both. 0 if nothing is missing.
  double weight(double sum, double full) const;

 private:
  static constexpr int depths = 32;
  std::array<double, depths> missing_{};  ///< missing fraction of the weights, ascending
  std::array<double, depths> factor_{};
};

}  // namespace tailwater
