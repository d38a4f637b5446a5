// The triangular sweeps of SSOR over the rows of a LinearSystem, A = L + I + U - G. L and U hold the unknowns of this
// rank before and behind the diagonal; G holds ghosts, which the preconditioner leaves out.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "linear/linear_system.h"

namespace tailwater {

/// Relaxation factor of SSOR; iterations depend on it weakly between 1.2 and 1.5 (docs/theory/linear.md).
inline constexpr double ssor_factor = 1.35;

/// The begin of the unknowns behind the diagonal and of the ghosts in each row. Only sweeps need them.
struct RowParts {
  /// Updates the begins if the system has a new pattern.
  void follow(const LinearSystem& system);

  std::vector<std::uint32_t> behind_begin = {};
  std::vector<std::uint32_t> ghosts_begin = {};
  std::uint64_t pattern_number = 0;
};

/// Borrows the system and its parts. All vectors have one entry per row.
class TriangularSweeps {
 public:
  TriangularSweeps(const LinearSystem& system, const RowParts& parts)
      : system_(system), before_(system.whole()), behind_(before_), ghosts_(before_) {
    before_.end = behind_.begin = parts.behind_begin;
    behind_.end = ghosts_.begin = parts.ghosts_begin;
  }

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
  LinearSystem::Part before_;
  LinearSystem::Part behind_;
  LinearSystem::Part ghosts_;
  std::vector<double> scratch_;
  std::vector<double> with_ghosts_;
};

}  // namespace tailwater
