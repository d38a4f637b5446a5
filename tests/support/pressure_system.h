// Rows and their solver together.
#pragma once

#include "case/spec.h"
#include "linear/linear_solver.h"
#include "linear/linear_system.h"
#include "linear/solver_choice.h"

namespace tailwater {

class PressureSystem : public LinearSystem {
 public:
  explicit PressureSystem(const PressureSolverTable& settings, const Communicator& ranks = {})
      : LinearSystem(ranks), solver_(settings, {}) {}

  SolveReport solve(std::span<double> solution) { return solver_.solve(*this, solution, solver_.tolerance()); }

 private:
  LinearSolver solver_;
};

}  // namespace tailwater
