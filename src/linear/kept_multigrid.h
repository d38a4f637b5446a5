// The multigrid of the present pattern. All solves with this pattern use the same one.
#pragma once

#include <cstdint>
#include <optional>

#include "linear/cell_multigrid.h"

namespace tailwater {

class KeptMultigrid {
 public:
  /// Prepares the multigrid for a solve that begins with this relative residual. Sets up a multigrid if the pattern is
  /// new. Otherwise the existing one follows the changed diagonals, unless these have restored most of the residual:
  /// then a new set-up pays. Collective.
  void take(const LinearSystem& system, double residual) {
    const bool is_new = !multigrid_ || pattern_number_ != system.pattern_number();
    if (system.ranks().any(is_new || (multigrid_->follow(system) && residual > max_to_follow))) {
      multigrid_.emplace(system);
      pattern_number_ = system.pattern_number();
    }
  }

  CellMultigrid& get() { return *multigrid_; }

 private:
  /// Relative residual above which a multigrid that has followed its system is set up again. From there it would take
  /// three times as many iterations to 1e-4 as a new one (docs/theory/linear.md#the-multigrid-on-cells).
  static constexpr double max_to_follow = 0.1;

  std::optional<CellMultigrid> multigrid_;
  std::uint64_t pattern_number_ = 0;
};

}  // namespace tailwater
