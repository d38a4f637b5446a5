// The triangular sweeps of SSOR over the rows of a LinearSystem, A = L + I + U - G: L and U hold the unknowns of this
// rank before and behind the diagonal, G ghosts, which the preconditioner leaves out.
#pragma once

#include <span>
#include <vector>

#include "linear/linear_system.h"

namespace tailwater {

/// Relaxation factor of SSOR; iterations depend on it weakly between 1.2 and 1.5 (docs/theory/linear.md).
inline constexpr double ssor_factor = 1.35;

/// Borrows the system. All vectors have one entry per row.
class TriangularSweeps {
 public:
  explicit TriangularSweeps(const LinearSystem& system) : system_(system) {}

  /// x = (D + L)^-1 b with D = I/omega.
  void forward(double omega, std::span<const double> b, std::span<double> x) const;
  /// x = (D + U)^-1 b.
  void backward(double omega, std::span<const double> b, std::span<double> x) const;
  /// x = (D + L) b.
  void times_lower(double omega, std::span<const double> b, std::span<double> x) const;
  /// x = (D + L)^-1 A (D + U)^-1 b, in Eisenstat's form (docs/theory/linear.md). Collective.
  void eisenstat(double omega, std::span<const double> b, std::span<double> x);

 private:
  const LinearSystem& system_;
  std::vector<double> scratch_;
  std::vector<double> with_ghosts_;
};

}  // namespace tailwater
