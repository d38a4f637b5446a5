// The choice of the Krylov method and the preconditioner for a system: that of the case, or by a rule. This file does
// not use PETSc, so the rule can be read and tested by itself. A preconditioner of another library needs an enumerator
// and a line in the rule.
#pragma once

#include "case/spec.h"
#include "linear/linear_system.h"

namespace tailwater {

/// The properties of a system that the rule uses.
struct SystemTraits {
  double rows_deep = 0.0;  ///< number of particles between the surface and the bottom
  int dimension = 2;
  int solves = 2;                 ///< solves with one matrix
  bool constant_is_free = false;  ///< only differences are determined
  bool has_cells = false;         ///< whether the cells for the multigrid are set
};

/// Neither member is `automatic`.
struct SolverChoice {
  KrylovMethod method;
  PreconditionerName preconditioner;
};

/// The properties of one system: those of all systems, `water`, completed by its own.
SystemTraits traits_of(const LinearSystem& system, SystemTraits water);

SolverChoice choose_solver(const PressureSolverTable& settings, const SystemTraits& system);

/// Depths [rows] for which the rule makes its two different choices.
inline constexpr double shallow = 1.0;
inline constexpr double deep = 1e9;

}  // namespace tailwater
