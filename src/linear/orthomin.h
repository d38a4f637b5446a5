// Orthomin (Vinsome 1976) around the multigrid on cells: the generalised conjugate residuals of Eisenstat, Elman &
// Schultz (1983) that forget all but the last directions. Each iteration makes the residual as small as its direction
// can, and the images of the directions that are kept are orthogonal to each other. It allows for a preconditioner that
// is slightly nonlinear by rounding, as FGMRES does. With a good one it needs hardly more iterations, and at most six
// pairs of vectors instead of one for each iteration (docs/theory/linear.md).
#pragma once

#include "linear/kept_multigrid.h"
#include "linear/method.h"

namespace tailwater {

class Orthomin : public Method {
 public:
  /// Borrows the multigrid, which may be another method's too.
  explicit Orthomin(KeptMultigrid& multigrid) : multigrid_(multigrid) {}

  /// Also where the guess will do: then the next solve with this pattern, of other diagonals, finds the multigrid as it
  /// is here.
  void begin(const LinearSystem& system, double residual) override { multigrid_.take(system, residual); }

  /// Breaks down where the residual goes down no further. Leaves the residual of the new x.
  MethodOutcome improve(const LinearSystem& system, const Goal& goal, Iterate& iterate) override;

 private:
  KeptMultigrid& multigrid_;
};

}  // namespace tailwater
