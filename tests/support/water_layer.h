// A layer of water between two flat free surfaces, periodic along them: rows are known by their height.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "operators/concentration.h"
#include "operators/lattice.h"
#include "support/particle_set.h"

namespace tailwater {

inline constexpr double layer_dx = 0.1;
inline constexpr int rows = 12;
inline constexpr int columns = 8;

template <int Dim>
PeriodicDomain<Dim> along_the_layer() {
  PeriodicDomain<Dim> domain;
  for (int d = 0; d < Dim; ++d) {
    if (d != 1) domain[d] = std::pair{0.0, columns * layer_dx};
  }
  return domain;
}

template <int Dim>
std::vector<Vec<Dim>> layer() {
  std::array<int, Dim> count;
  count.fill(columns);
  count[1] = rows;
  return lattice_points<Dim>(Vec<Dim>::Constant(0.5 * layer_dx), count, layer_dx);
}

inline int row_of(double y) { return static_cast<int>(std::floor(y / layer_dx)); }

/// The kernel's sums of a set.
template <int Dim>
struct KernelSumsOfSet {
  explicit KernelSumsOfSet(const ParticleSet<Dim>& set) : W_0(kernel_value(set.neighbourhood.kernel(), 0.0)) {
    const double C_0 = lattice_sums<Dim>(set.neighbourhood.kernel(), layer_dx).concentration;
    concentration.resize(set.size());
    gradient.resize(set.size());
    for (std::size_t i = 0; i < set.pairs().owned(); ++i) {
      const KernelSums<Dim> sums = kernel_sums<Dim>(set.pairs(), i, {W_0, 1.0, 1.0});
      concentration[i] = sums.concentration / C_0;
      gradient[i] = sums.gradient;
    }
  }

  double W_0;
  std::vector<double> concentration;  ///< C/C_0
  std::vector<Vec<Dim>> gradient;
};

}  // namespace tailwater
