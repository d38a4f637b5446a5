// Solves a LinearSystem by PETSc, whose matrix and vectors share its arrays.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "case/spec.h"
#include "linear/linear_system.h"

namespace tailwater {

struct SolveReport {
  int iterations = 0;
  std::size_t restarts = 0;  ///< after a breakdown of the Krylov method
  double residual = 0.0;     ///< |b - A x| / |b|, rows scaled, computed from x
};

class KrylovSolver {
 public:
  /// For water so many rows of particles deep, by which `auto` chooses. Throws InputError for petsc_options that PETSc
  /// does not know.
  explicit KrylovSolver(const PressureSolverTable& settings, double rows_deep = 0.0);
  ~KrylovSolver();
  KrylovSolver(const KrylovSolver&) = delete;
  KrylovSolver& operator=(const KrylovSolver&) = delete;

  /// Solves; `solution` is the starting guess on entry, unless it is hopelessly far. Where the Krylov method breaks
  /// down it begins again from 0, once, with GMRES, which cannot. Where a constant is free the solution gets mean 0.
  /// Throws SolverError with the residual history when the tolerance is not reached. `tolerance` overrides the
  /// settings' own. Collective.
  SolveReport solve(LinearSystem& system, std::span<double> solution, std::optional<double> tolerance = {});

  /// Relative residual at which a solve ends.
  double tolerance() const { return settings_.tolerance; }

 private:
  struct Petsc;

  PressureSolverTable settings_;
  double rows_deep_;
  std::unique_ptr<Petsc> petsc_;
};

}  // namespace tailwater
