// Which Krylov method and preconditioner solve a system: the case's own choice, or a rule. There is no PETSc here, so
// the rule can be read and tested by itself. A preconditioner of another library needs an enumerator and a line in the
// rule.
#pragma once

#include "case/spec.h"
#include "linear/linear_system.h"

namespace tailwater {

/// What the rule knows about a system.
struct SystemTraits {
  double rows_deep = 0.0;  ///< how many particles lie between the surface and the bottom
  int dimension = 2;
  int solves = 2;                 ///< with one matrix
  bool constant_is_free = false;  ///< only differences are determined
  bool has_cells = false;         ///< as the multigrid on cells needs
};

/// Neither is `automatic`.
struct SolverChoice {
  KrylovMethod method;
  PreconditionerName preconditioner;
};

/// What is known of every system, `water`, with what this one says of itself.
SystemTraits traits_of(const LinearSystem& system, SystemTraits water);

SolverChoice choose_solver(const PressureSolverTable& settings, const SystemTraits& system);

/// Depths [rows] for which the rule makes its two different choices.
inline constexpr double shallow = 1.0;
inline constexpr double deep = 1e9;

}  // namespace tailwater
