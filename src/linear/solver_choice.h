// Which Krylov method and preconditioner solve a system: the case's own choice, or a rule. There is no PETSc here, so
// the rule can be read and tested by itself. A preconditioner of another library needs an enumerator and a line in the
// rule.
#pragma once

#include <cstdint>

#include "case/spec.h"

namespace tailwater {

/// What the rule knows about a system.
struct SystemTraits {
  std::int64_t unknowns = 0;      ///< rows of all ranks
  bool constant_is_free = false;  ///< only differences are determined
};

/// Neither is `automatic`.
struct SolverChoice {
  KrylovMethod method;
  PreconditionerName preconditioner;
};

SolverChoice choose_solver(const PressureSolverTable& settings, const SystemTraits& system);

/// Numbers of unknowns for which the rule makes its two different choices.
inline constexpr std::int64_t small_system = 1;
inline constexpr std::int64_t large_system = 1'000'000'000;

}  // namespace tailwater
