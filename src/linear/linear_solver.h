// Solves a LinearSystem by the method that the case or the rule (solver_choice.h) chooses.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace tailwater {

class LinearSystem;
struct PressureSolverTable;
struct SystemTraits;

struct SolveReport {
  int iterations = 0;
  std::size_t restarts = 0;  ///< after breakdowns of the method
  double residual = 0.0;     ///< |b - A x| / |b|, rows scaled
};

class LinearSolver {
 public:
  /// `water` has the known properties of all systems, by which `auto` chooses. Throws InputError for petsc_options that
  /// do not exist in PETSc, or that would change the criterion by which a solve ends.
  LinearSolver(const PressureSolverTable& settings, const SystemTraits& water);
  ~LinearSolver();
  LinearSolver(const LinearSolver&) = delete;
  LinearSolver& operator=(const LinearSolver&) = delete;

  /// On entry `solution` is the starting guess; a guess with a huge residual is replaced by 0. If the method breaks
  /// down, the solve restarts once, from 0 with GMRES, which cannot break down. Where a constant is free the solution
  /// gets mean 0. Throws SolverError with the residual history when the tolerance is not reached. Collective.
  SolveReport solve(LinearSystem& system, std::span<double> solution, double tolerance);

  /// Frees the data that belong to the pattern of the last solve. Call when no other solve has the same pattern,
  /// because a new pattern needs new data.
  void forget();

  /// Whether it solves by the multigrid on cells, which needs the cells of each system (LinearSystem::set_cells).
  bool needs_cells() const;

  /// Relative residual at which a solve ends, from the case.
  double tolerance() const;

 private:
  struct Methods;

  std::unique_ptr<Methods> methods_;
};

}  // namespace tailwater
