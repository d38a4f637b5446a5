// BiCGStab (van der Vorst 1992) preconditioned by SSOR in Eisenstat's form: the solver of nearly every run. PETSc also
// has both, but needs two more products for each of the two solves of a step (docs/theory/linear.md#solving).
#pragma once

#include "linear/method.h"
#include "linear/triangular_sweeps.h"

namespace tailwater {

class Bicgstab : public Method {
 public:
  void begin(const LinearSystem& system, double) override { parts_.follow(system); }

  /// Breaks down where it would divide by a number that happens to vanish, or where the residual explodes. Then x keeps
  /// its value.
  MethodOutcome improve(const LinearSystem& system, const Goal& goal, Iterate& iterate) override;

 private:
  RowParts parts_;
};

}  // namespace tailwater
