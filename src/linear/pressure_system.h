// The sparse linear system of the pressure: one row per owned particle, assembled once per pattern, values refreshed,
// solved by PETSc. Rows are scaled to unit diagonal, so that wall rows and fluid rows weigh alike. On several ranks the
// rows are numbered rank after rank; each rank writes its own rows in place, and no entry is sent.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "case/spec.h"
#include "parallel/exchange_plan.h"

namespace tailwater {

struct SolveReport {
  int iterations = 0;
  std::size_t restarts = 0;  ///< after a breakdown of the Krylov method
  double residual = 0.0;     ///< |b - A x| / |b|, rows scaled, computed from x
};

/// Row i of the system is   diagonal_i x_i - sum_k weight_ik x_j(i,k) = rhs_i.
class PressureSystem {
 public:
  /// Throws InputError for petsc_options that PETSc does not know.
  explicit PressureSystem(const PressureSolverTable& settings, Communicator ranks = {});
  ~PressureSystem();
  PressureSystem(const PressureSystem&) = delete;
  PressureSystem& operator=(const PressureSystem&) = delete;

  /// Sets which unknowns each row couples: columns[row_begin[i]] .. columns[row_begin[i + 1]], in any order, without
  /// the diagonal. Columns are owned entries and ghosts of `halo`; a ghost's unknown is its owner's. Collective.
  void set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns,
                   const ExchangePlan& halo);
  /// The same without ghosts, on one rank.
  void set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns);

  /// Writes one row in place. Touches nothing but that row.
  class Row {
   public:
    /// Weight of the k-th unknown of the pattern's row.
    void set_weight(std::size_t k, double weight) { value_[slot_[k]] = weight; }
    /// Completes the row; every weight must have been set, `diagonal` must not be 0.
    void finish(double diagonal, double rhs);
    /// Makes it x_i = 0, whatever was set.
    void finish_as_zero();

   private:
    friend class PressureSystem;
    Row(PressureSystem& system, std::size_t i);
    PressureSystem& system_;
    std::size_t i_;
    const int* slot_;
    double* value_;
  };
  Row row(std::size_t i) { return {*this, i}; }

  /// Changes the right-hand side of a finished row, whose weights stay; a row that was finished as zero stays zero.
  void set_rhs(std::size_t i, double rhs) { rhs_[i] = scale_[i] * rhs; }

  /// Divides the diagonal of a finished row by `share`, from 0 (then x_i = 0) to 1; the other entries stay. x_i becomes
  /// that share of what its neighbours and its right-hand side would make of it.
  void divide_diagonal(std::size_t i, double share);

  /// Tells that only differences of x are determined (no surface, no air). The right-hand side is then made consistent
  /// and the solution gets mean 0.
  void set_constant_is_free(bool is_free) { constant_is_free_ = is_free; }

  /// Solves; `solution` is the starting guess on entry, unless it is hopelessly far. Where the Krylov method breaks
  /// down it begins again from 0, once, with GMRES, which cannot. Throws SolverError with the residual history when the
  /// tolerance is not reached. `tolerance` overrides the settings' own. Collective.
  SolveReport solve(std::span<double> solution, std::optional<double> tolerance = {});

  /// A rough solution: one symmetric Gauss-Seidel sweep from 0, forward and back, of each rank's rows alone.
  void sweep(std::span<double> solution) const;

  std::size_t size() const { return rhs_.size(); }
  /// Relative residual at which a solve ends.
  double tolerance() const { return settings_.tolerance; }

 private:
  struct Petsc;

  /// The entries of all rows whose columns are of one kind.
  struct Block {
    std::vector<int> begin;   ///< rows + 1
    std::vector<int> column;  ///< ascending in each row
  };

  template <class Body>
  void for_each_slot(std::size_t i, Body&& body) const;
  void make_rhs_consistent();
  void make_matrix();
  void set_up_solver();
  void begin_again();
  double residual_norm();

  PressureSolverTable settings_;
  Communicator ranks_;
  std::unique_ptr<Petsc> petsc_;
  bool pattern_is_new_ = true;
  bool constant_is_free_ = false;
  std::int64_t size_of_all_ = 0;  ///< rows of all ranks
  Block own_;                     ///< unknowns of this rank, columns counted from its first
  Block others_;                  ///< unknowns of other ranks, columns counted over all ranks
  std::vector<double> value_;     ///< of own_, then of others_
  std::vector<std::size_t> pattern_begin_;
  std::vector<int> slot_;           ///< where the k-th entry of the pattern stands in value_
  std::vector<int> diagonal_slot_;  ///< and the diagonal of row i
  std::vector<double> rhs_;
  std::vector<double> scale_;  ///< 1/diagonal of each row before scaling; 0 for x_i = 0
};

}  // namespace tailwater
