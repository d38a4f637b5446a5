// The rows of a sparse linear system: pattern, values and right-hand side, without any solver. There is one row per
// owned particle. The pattern is set when neighbours change; values are written in place. Rows are scaled to unit
// diagonal, so that wall rows and fluid rows have equal weight. On several ranks the rows are numbered rank after rank.
// Each rank writes its own rows, and no entry is sent.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "linear/cells.h"
#include "parallel/exchange_plan.h"

namespace tailwater {

/// Row i of the system is   diagonal_i x_i - sum_k weight_ik x_j(i,k) = rhs_i.
class LinearSystem {
 public:
  /// The entries of all rows in one kind of column (own() or others()), in compressed rows.
  struct Block {
    std::vector<int> begin;   ///< rows + 1
    std::vector<int> column;  ///< ascending in each row
  };

  explicit LinearSystem(Communicator ranks = {}) : ranks_(std::move(ranks)) {}

  /// Sets which unknowns each row couples: columns[row_begin[i]] .. columns[row_begin[i + 1]], in any order, without
  /// the diagonal. Columns are owned entries and ghosts of `halo`; a ghost's unknown is its owner's. Collective.
  void set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns,
                   const ExchangePlan& halo);
  /// The same without ghosts, on one rank.
  void set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns);

  /// Tells in which cell each unknown is, for a multigrid. A new pattern forgets it.
  void set_cells(Cells cells) { cells_ = std::move(cells); }
  const Cells& cells() const { return cells_; }
  bool has_cells() const { return cells_.dimension > 0; }

  /// Writes one row in place. Touches nothing but that row.
  class Row {
   public:
    /// Weight of the k-th unknown of the pattern's row.
    void set_weight(std::size_t k, double weight) { value_[slot_[k]] = weight; }
    /// Sets every weight of the row: weight(k) for the pattern's entry k, columns[k]. Returns their sum.
    template <class Weight>
    double set_weights(Weight&& weight) {
      double sum = 0.0;
      for (std::size_t k = begin_; k < end_; ++k) {
        const double w = weight(k);
        value_[slot_[k - begin_]] = w;
        sum += w;
      }
      return sum;
    }
    /// Completes the row. Every weight must have been set; `diagonal` must not be 0.
    void finish(double diagonal, double rhs);
    /// Makes the row x_i = 0, whatever was set before.
    void finish_as_zero();

   private:
    friend class LinearSystem;
    Row(LinearSystem& system, std::size_t i);
    LinearSystem& system_;
    std::size_t i_;
    std::size_t begin_;
    std::size_t end_;
    const int* slot_;
    double* value_;
  };
  Row row(std::size_t i) { return {*this, i}; }

  /// Changes the right-hand side of a finished row and keeps its weights. A row finished as zero stays zero.
  void set_rhs(std::size_t i, double rhs) { rhs_[i] = scale_[i] * rhs; }

  /// Divides the diagonal of a finished row by `share`, from 0 (then x_i = 0) to 1, and keeps the other entries. x_i
  /// becomes that share of the value that its neighbours and right-hand side would give it.
  void divide_diagonal(std::size_t i, double share);

  /// Declares that only differences of x are determined: no surface, no air.
  void set_constant_is_free(bool is_free) { constant_is_free_ = is_free; }
  bool constant_is_free() const { return constant_is_free_; }
  /// For systems with a free constant: changes the right-hand side so that a solution exists. Collective.
  void make_rhs_consistent();

  /// A rough solution: one symmetric Gauss-Seidel sweep from 0, forward and back, over each rank's own block.
  void sweep(std::span<double> solution) const;

  std::size_t size() const { return rhs_.size(); }
  std::int64_t size_of_all() const { return size_of_all_; }  ///< rows of all ranks
  const Communicator& ranks() const { return ranks_; }

  /// For the solver, which shares the arrays: the number of the present pattern, and the compressed rows.
  std::uint64_t pattern_number() const { return pattern_number_; }
  const Block& own() const { return own_; }        ///< unknowns of this rank, columns counted from its first
  const Block& others() const { return others_; }  ///< unknowns of other ranks, columns counted over all ranks
  std::span<const int> diagonal_of_own() const { return diagonal_slot_; }  ///< index in values_of_own(), by row
  std::span<double> values_of_own() { return std::span(value_).first(own_.column.size()); }
  std::span<double> values_of_others() { return std::span(value_).subspan(own_.column.size()); }
  std::span<double> rhs() { return rhs_; }
  std::span<const double> rhs() const { return rhs_; }

 private:
  template <class Body>
  void for_each_slot(std::size_t i, Body&& body) const;

  Communicator ranks_;
  std::uint64_t pattern_number_ = 0;
  bool constant_is_free_ = false;
  std::int64_t size_of_all_ = 0;
  Cells cells_;
  Block own_;
  Block others_;
  std::vector<double> value_;  ///< of own_, then of others_
  std::vector<std::size_t> pattern_begin_;
  std::vector<int> slot_;           ///< index in value_ of the k-th entry of the pattern
  std::vector<int> diagonal_slot_;  ///< index in value_ of the diagonal of row i
  std::vector<double> rhs_;
  std::vector<double> scale_;  ///< 1/diagonal of each row before scaling; 0 for x_i = 0
};

}  // namespace tailwater
