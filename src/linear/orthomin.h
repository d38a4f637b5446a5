// Orthomin (Vinsome 1976) around the multigrid on cells: the generalised conjugate residuals of Eisenstat, Elman &
// Schultz (1983), truncated to the last directions. Each iteration minimises the residual along its direction, and the
// images of the stored directions are orthogonal to each other. The method allows for a preconditioner that is slightly
// nonlinear by rounding, as FGMRES does. With a good preconditioner it needs hardly more iterations, and at most six
// pairs of vectors instead of one for each iteration (docs/theory/linear.md).
#pragma once

#include "linear/kept_multigrid.h"
#include "linear/method.h"

namespace tailwater {

class Orthomin : public Method {
 public:
  /// Borrows the multigrid, which other methods may use too.
  explicit Orthomin(KeptMultigrid& multigrid) : multigrid_(multigrid) {}

  /// Prepares the multigrid even if the guess is already good enough: the next solve with this pattern, which has other
  /// diagonals, then uses the multigrid in its present state.
  void begin(const LinearSystem& system, double residual) override { multigrid_.take(system, residual); }

  /// Breaks down where the residual no longer decreases. Leaves the residual of the new x.
  MethodOutcome improve(const LinearSystem& system, const Goal& goal, Iterate& iterate) override;

 private:
  KeptMultigrid& multigrid_;
};

}  // namespace tailwater
