// The sparse linear system of the pressure: one row per owned particle, assembled once per pattern, values refreshed,
// solved by PETSc. Rows are scaled to unit diagonal, so that wall rows and fluid rows weigh alike.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "case/spec.h"

namespace tailwater {

struct SolveReport {
  int iterations = 0;
  double residual = 0.0;  ///< |b - A x| / |b|, rows scaled, computed from x
};

/// Row i of the system is   diagonal_i x_i - sum_k weight_ik x_j(i,k) = rhs_i.
class PressureSystem {
 public:
  /// Throws InputError for petsc_options that PETSc does not know.
  explicit PressureSystem(const PressureSolverTable& settings);
  ~PressureSystem();
  PressureSystem(const PressureSystem&) = delete;
  PressureSystem& operator=(const PressureSystem&) = delete;

  /// Sets which unknowns each row couples: columns[row_begin[i]] .. columns[row_begin[i + 1]], in any order, without
  /// the diagonal.
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

  /// Solves; `solution` is the starting guess on entry, unless it is hopelessly far. Throws SolverError with the
  /// residual history when the tolerance is not reached. `tolerance` overrides the settings' own.
  SolveReport solve(std::span<double> solution, std::optional<double> tolerance = {});

  /// A rough solution: one symmetric Gauss-Seidel sweep from 0, forward and back.
  void sweep(std::span<double> solution) const;

  std::size_t size() const { return rhs_.size(); }

 private:
  struct Petsc;
  void make_rhs_consistent();
  /// `value` less row i of A times `solution`.
  double less_row(double value, std::size_t i, std::span<const double> solution) const;
  double residual_norm(std::span<const double> solution) const;

  PressureSolverTable settings_;
  std::unique_ptr<Petsc> petsc_;
  bool pattern_is_new_ = true;
  bool constant_is_free_ = false;
  std::vector<int> csr_begin_;
  std::vector<int> csr_column_;
  std::vector<double> csr_value_;
  std::vector<std::size_t> pattern_begin_;
  std::vector<int> slot_;           ///< where the k-th entry of the pattern stands in csr_value_
  std::vector<int> diagonal_slot_;  ///< and the diagonal of row i
  std::vector<double> rhs_;
  std::vector<double> scale_;  ///< 1/diagonal of each row before scaling; 0 for x_i = 0
};

}  // namespace tailwater
