// The methods and preconditioners of PETSc. They work on a shell around the system, whose arrays PETSc's vectors share;
// preconditioners that need more get a copy of its rows.
#pragma once

#include <cstdint>
#include <optional>

#include "linear/kept_multigrid.h"
#include "linear/method.h"
#include "linear/petsc_options.h"
#include "linear/petsc_rows.h"
#include "linear/shell_solver.h"

namespace tailwater {

class PetscMethod : public Method {
 public:
  /// Borrows the multigrid, which is its preconditioner if the choice is cell-multigrid.
  PetscMethod(const PressureSolverTable& settings, const SystemTraits& water, KeptMultigrid& multigrid)
      : settings_(settings), water_(water), multigrid_(multigrid) {}

  /// Does nothing yet: a guess that is already good enough needs no PETSc.
  void begin(const LinearSystem&, double) override { is_set_up_ = false; }

  /// Ends where the preconditioned residual, which PETSc measures, reaches the tolerance times the preconditioned b.
  MethodOutcome improve(const LinearSystem& system, const Goal& goal, Iterate& iterate) override;

  /// The rest of this solve, also of a solve that another method began, uses GMRES; the next solve uses the settings
  /// again.
  void change_to_gmres(const LinearSystem& system);

 private:
  /// The rows of the present system and the multigrid, as PETSc calls them.
  struct Shell final : ShellSystem {
    const LinearSystem* system = nullptr;
    CellMultigrid* multigrid = nullptr;

    void multiply(std::span<const double> x, std::span<double> y) override;
    void precondition(std::span<const double> residual, std::span<double> correction) override;
  };

  void set_up(const LinearSystem& system);
  bool take_matrix(const LinearSystem& system);
  bool works_on_shell() const;
  void wrap_multigrid(const LinearSystem& system);

  PressureSolverTable settings_;
  SystemTraits water_;
  KeptMultigrid& multigrid_;
  Shell shell_;
  PetscMatrix matrix_;  ///< of the shell
  PetscRows rows_;      ///< only for preconditioners that need them
  PetscVector rhs_;
  PetscVector solution_;
  PetscKrylovSolver solver_;
  PetscNullSpace constants_;
  bool is_set_up_ = false;                  ///< for this solve
  std::uint64_t pattern_number_ = 0;        ///< pattern of the matrix
  std::optional<std::size_t> solver_size_;  ///< rows of this rank; none after a restart with another method
};

}  // namespace tailwater
