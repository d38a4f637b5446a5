// The triangular sweeps of SSOR over the rows of a LinearSystem, A = L + I + U - G: L and U hold the unknowns of this
// rank before and behind the diagonal, G ghosts, which the preconditioner leaves out.
#pragma once

#include <span>
#include <vector>

#include "linear/linear_system.h"

namespace tailwater {

/// Borrows the system. All vectors have one entry per row.
class TriangularSweeps {
 public:
  explicit TriangularSweeps(const LinearSystem& system) : system_(system) {}

  /// x = (D + L)^-1 b with D = I/omega.
  void forward(double omega, std::span<const double> b, std::span<double> x) const;
  /// x = (D + U)^-1 b.
  void backward(double omega, std::span<const double> b, std::span<double> x) const;
  /// x = (D + U) b.
  void times_upper(double omega, std::span<const double> b, std::span<double> x) const;
  /// x = (D + L)^-1 A (D + U)^-1 b, in Eisenstat's form (docs/theory/linear.md). Collective.
  void eisenstat(double omega, std::span<const double> b, std::span<double> x);

 private:
  const LinearSystem& system_;
  std::vector<double> scratch_;
  std::vector<double> with_ghosts_;
};

}  // namespace tailwater
