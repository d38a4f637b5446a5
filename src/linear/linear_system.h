// The rows of a sparse linear system: weights and right-hand side, without any solver. There is one row per owned
// particle. The pattern is set when neighbours change; weights are written in place. Rows are scaled to unit diagonal,
// so that wall rows and fluid rows have equal weight. Each rank writes its own rows, and no entry is sent.
//
// A row is the columns of the pattern, which may be those of the pairs themselves, and a weight for each. Its parts
// follow each other: the unknowns of this rank before the diagonal, those behind it, and ghosts. Weights are kept in
// single precision, because products and sweeps are limited by memory access; all sums are in double precision.
// set_weights returns the sum of the weights as stored, from which the diagonal is made. Sums of rows, and with them
// the symmetry of two-point weights, are therefore exact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "base/pair_workspace.h"
#include "base/prefetch.h"
#include "linear/cells.h"
#include "parallel/exchange_plan.h"

namespace tailwater {

/// Row i of the system is   diagonal_i x_i - sum_k weight_ik x_j(i,k) = rhs_i.
class LinearSystem {
 public:
  /// A part of every row, or all of it. It borrows everything from its system.
  struct Part {
    std::span<const std::uint32_t> begin;  ///< first entry of each row's part
    std::span<const std::uint32_t> end;    ///< one behind its last entry
    const std::int32_t* column = nullptr;
    const float* weight = nullptr;

    /// sum_k weight_ik x_j(i,k). Eight partial sums, so that an addition need not wait for the previous one.
    double sum(std::size_t i, const double* x) const {
      Quad first{};
      Quad second{};
      std::size_t k = begin[i];
      for (; k + 8 <= end[i]; k += 8) {
        fetch_ahead(weight + k);
        fetch_ahead(column + k);
        first += weights_at(k) * Quad{x[column[k]], x[column[k + 1]], x[column[k + 2]], x[column[k + 3]]};
        second += weights_at(k + 4) * Quad{x[column[k + 4]], x[column[k + 5]], x[column[k + 6]], x[column[k + 7]]};
      }
      double rest = 0.0;
      for (; k < end[i]; ++k) rest += weight[k] * x[column[k]];
      first += second;
      return (first[0] + first[1]) + (first[2] + first[3]) + rest;
    }

    /// The sum from the row's end to its begin, for sweeps that go back. The x of the column next to the diagonal,
    /// which was computed last, is used last, and the other products need not wait for it.
    double sum_back(std::size_t i, const double* x) const {
      const std::size_t first = begin[i];
      double even = 0.0;
      double odd = 0.0;
      std::size_t k = end[i];
      for (; k >= first + 2; k -= 2) {
        even += weight[k - 1] * x[column[k - 1]];
        odd += weight[k - 2] * x[column[k - 2]];
      }
      if (k > first) even += weight[first] * x[column[first]];
      return even + odd;
    }

   private:
    using Quad = double __attribute__((vector_size(32)));

    /// The weights of entries k .. k + 3.
    Quad weights_at(std::size_t k) const {
      float four __attribute__((vector_size(16)));
      std::memcpy(&four, weight + k, sizeof(four));
      return __builtin_convertvector(four, Quad);
    }
  };

  explicit LinearSystem(Communicator ranks = {}) : ranks_(std::move(ranks)) {}
  LinearSystem(LinearSystem&&) = default;
  LinearSystem& operator=(LinearSystem&&) = default;

  /// Sets which unknowns each row couples: columns[row_begin[i]] .. columns[row_begin[i + 1]], without the diagonal.
  /// Each row has the columns below i, then those above i, then ghosts of `halo`, whose unknowns belong to their
  /// owners. Borrows the columns, and takes the workspace for the weights, until forget_weights. Collective.
  void set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns,
                   const ExchangePlan& halo);
  /// Sets a pattern without ghosts, on one rank.
  void set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns);

  /// Discards all weights. Only the right-hand sides stay, until the next pattern is set.
  void forget_weights() {
    columns_ = {};
    weights_ = {};
  }

  /// The memory of the weights, for other use while there are none.
  PairWorkspace& workspace() { return workspace_; }

  /// Sets the cell of each unknown, for a multigrid. A new pattern discards the cells.
  void set_cells(Cells cells) { cells_ = std::move(cells); }
  const Cells& cells() const { return cells_; }
  bool has_cells() const { return cells_.dimension > 0; }

  /// Writes one row in place and changes no other row.
  class Row {
   public:
    /// Sets every weight of the row: weight(k) for the pattern's entry k, columns[k]. Returns the sum of the stored
    /// weights.
    template <class Weight>
    double set_weights(Weight&& weight) {
      return write_weights([&](float* weights) {
        const std::size_t first = system_.row_begin_[i_];
        const std::size_t end = system_.row_begin_[i_ + 1];
        double sum = 0.0;
        for (std::size_t k = first; k < end; ++k) sum += weights[k - first] = static_cast<float>(weight(k));
        return sum;
      });
    }
    /// Sets all weights at once: write(weights) writes those of all entries of the row and returns the sum of the
    /// stored ones.
    template <class Write>
    double write_weights(Write&& write) {
      return system_.sum_[i_] = write(system_.weights_.data() + system_.row_begin_[i_]);
    }
    /// Completes the row. Every weight must have been set; `diagonal` must not be 0.
    void finish(double diagonal, double rhs);
    /// Makes the row x_i = 0, for any earlier contents.
    void finish_as_zero();

   private:
    friend class LinearSystem;
    Row(LinearSystem& system, std::size_t i) : system_(system), i_(i) {}
    LinearSystem& system_;
    std::size_t i_;
  };
  Row row(std::size_t i) { return {*this, i}; }

  /// Changes the right-hand side of a finished row and keeps its weights. A row finished as zero stays zero.
  void set_rhs(std::size_t i, double rhs) { rhs_[i] = scale_[i] * rhs; }

  /// Divides the diagonal of a finished row by `share`, from 0 (then x_i = `from`) to 1, and keeps the other entries.
  /// x_i - from becomes that fraction of the value that its neighbours and right-hand side would give it.
  void divide_diagonal(std::size_t i, double share, double from = 0.0);

  /// Declares that only differences of x are determined: no surface, no air.
  void set_constant_is_free(bool is_free) { constant_is_free_ = is_free; }
  bool constant_is_free() const { return constant_is_free_; }
  /// For systems with a free constant: changes the right-hand side so that a solution exists. Collective.
  void make_rhs_consistent();

  /// The x_i that satisfies row i, given the other unknowns. `x` has the ghosts' values behind those of the rows.
  double answer(std::size_t i, const double* x) const { return rhs_[i] + scale_[i] * whole().sum(i, x); }

  /// y = A x. `x` gets the ghosts' values behind those of the rows. Collective.
  void multiply(std::vector<double>& x, std::span<double> y) const;

  std::size_t size() const { return rhs_.size(); }
  std::size_t size_with_ghosts() const { return rhs_.size() + ghost_number_.size(); }
  std::int64_t size_of_all() const { return size_of_all_; }  ///< rows of all ranks
  const Communicator& ranks() const { return ranks_; }

  /// The factor of the weights of row i that makes the diagonal 1.
  double scale(std::size_t i) const { return scale_[i]; }
  /// The sum of the weights of row i, before they are scaled.
  double sum_of_weights(std::size_t i) const { return sum_[i]; }

  /// For solvers: the number of the present pattern, and the rows.
  std::uint64_t pattern_number() const { return pattern_number_; }
  Part whole() const {
    const std::span<const std::uint32_t> begin(row_begin_);
    return {begin.first(size()), begin.last(size()), columns_.data(), weights_.data()};
  }
  std::size_t entries() const { return columns_.size(); }
  /// The number over all ranks, rank after rank, of this rank's first unknown, and of the unknown of a ghost's column.
  std::int64_t first_number() const { return first_number_; }
  std::int64_t number_of_ghost(std::int32_t column) const { return ghost_number_[column - size()]; }
  /// Whether some row of this or another rank couples ghosts, so that products exchange them.
  bool has_ghosts() const { return has_ghosts_; }
  /// Values of x with those of ghosts behind them. Collective.
  void exchange(std::vector<double>& x) const { halo_.exchange(x); }
  std::span<double> rhs() { return rhs_; }
  std::span<const double> rhs() const { return rhs_; }

 private:
  Communicator ranks_;
  std::uint64_t pattern_number_ = 0;
  bool constant_is_free_ = false;
  bool has_ghosts_ = false;
  std::int64_t size_of_all_ = 0;
  std::int64_t first_number_ = 0;
  ExchangePlan halo_;
  Cells cells_;
  std::vector<std::uint32_t> row_begin_;  ///< rows + 1
  std::span<const std::int32_t> columns_;
  PairWorkspace workspace_;
  std::span<float> weights_;                ///< in the workspace
  std::vector<std::int64_t> ghost_number_;  ///< number over all ranks, of each ghost's column
  std::vector<double> rhs_;
  std::vector<double> scale_;  ///< 1/diagonal of each row before scaling; 0 for x_i = 0
  std::vector<double> sum_;    ///< sum of the weights of each row
};

}  // namespace tailwater
