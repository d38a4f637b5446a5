// A level of the multigrid on cells (cell_multigrid.h): its matrix, its exchange between ranks, and the map of its rows
// to those of the next level.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/prefetch.h"
#include "linear/linear_system.h"

namespace tailwater::multigrid {

struct Entry {
  int column;
  float weight;
};

/// diagonal_i x_i = b_i + sum_k weight_k x_column_k. In each row the columns left of the diagonal stand before
/// `middle`, and the others behind it, including those of ghosts, which are numbered behind the rows.
struct Matrix {
  std::vector<int> begin{0};
  std::vector<int> middle;
  std::vector<Entry> entries;
  std::vector<float> diagonal;
  std::vector<float> inverse;  ///< 1/diagonal; 0 where the diagonal is 0

  std::size_t size() const { return diagonal.size(); }
  std::span<const Entry> row(std::size_t i) const { return {entries.data() + begin[i], entries.data() + begin[i + 1]}; }
  void reserve(std::size_t rows, std::size_t entries_of_all);
  /// `row` is in any order and may have the diagonal's own column, which is left out.
  void add_row(std::span<const Entry> row, double diagonal_of_row);

  float sum_left(std::size_t i, const std::vector<float>& x) const { return sum(begin[i], middle[i], x); }
  float sum_right(std::size_t i, const std::vector<float>& x) const { return sum(middle[i], begin[i + 1], x); }
  float sum_all(std::size_t i, const std::vector<float>& x) const { return sum(begin[i], begin[i + 1], x); }

 private:
  /// Two partial sums, so that an addition need not wait for the previous one.
  float sum(int first, int end, const std::vector<float>& x) const {
    float even = 0.0F;
    float odd = 0.0F;
    int k = first;
    for (int line = first; line < end; line += 8) fetch_ahead(entries.data() + line);
    for (; k + 1 < end; k += 2) {
      even += entries[k].weight * x[entries[k].column];
      odd += entries[k + 1].weight * x[entries[k + 1].column];
    }
    if (k < end) even += entries[k].weight * x[entries[k].column];
    return even + odd;
  }
};

/// Entries that are sent to and received from other ranks, by rank. Empty for a level that all ranks have.
struct Couplings {
  std::vector<std::vector<std::int32_t>> sent;  ///< rows
  std::vector<std::int64_t> received;           ///< number of ghosts
  ExchangePlan plan;
};

/// How all ranks assemble a level from the parts of each.
struct Gathering {
  std::vector<int> counts;    ///< rows of each rank's part
  std::size_t first_own = 0;  ///< this rank's first row in the parts of all
  std::vector<int> row;       ///< row of each entry of the parts of all
};

struct Level {
  Matrix matrix;
  Couplings couplings;
  std::optional<Gathering> gathering;
  bool is_whole = false;  ///< this rank has all rows
  /// cell on the next level, of the rows that have one; discarded once the next level is made
  std::vector<std::uint64_t> cell;
  std::vector<int> parent;  ///< rows of the next level, of the rows that have a cell: these come first
  std::size_t cells = 0;    ///< this rank's rows of the next level
  std::vector<float> rhs;
  std::vector<float> solution;

  /// Brings the ghosts of x up to date. Collective unless all ranks have the level.
  template <class Value>
  void exchange(std::vector<Value>& x) const {
    if (!is_whole) couplings.plan.exchange(x);
  }
};

/// The first level, made from the rows of a system (multigrid_first_level.cpp).
struct FirstLevel {
  Level level;
  std::vector<int> row;      ///< row of the system, for each row of the level
  std::vector<float> scale;  ///< scale of that row
};
/// Collective.
FirstLevel first_level(const LinearSystem& system);

/// Corrections that are constant in a cell are too small by about this factor (Braess 1995). The matrices of coarse
/// levels are divided by it.
inline constexpr double over_correction = 1.8;

/// The level behind `fine`; also sets the parent of each row of `fine` (multigrid_next_level.cpp). Collective.
Level next_level(Level& fine, int dimension, const Communicator& ranks);

}  // namespace tailwater::multigrid
