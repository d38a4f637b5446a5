// A multigrid for matrices of particles: the unknowns of a background cell, two particles wide, move as one on the next
// level, those of 2^Dim cells on the one after that, and so on down to a few, solved directly. Each matrix is the
// Galerkin product of the one before. Corrections that are constant in a cell are too small by about the same factor
// everywhere, for which the matrix makes up (Braess 1995). W cycles, with one Gauss-Seidel sweep from the first row to
// the last before the correction and one back after it.
//
// The first level leaves out small weights and raises those it keeps to the same row sum. The Laplacian's weights fall
// off steeply, so half of them (2D) or a fifth (3D) act nearly as all do, and the rest of the cycle costs little. It is
// an M-matrix even where the given one is not.
//
// Rows without a cell follow from others, like the dummies of a wall: corrections reach them through their weights, as
// if they were eliminated. Rows without weights stand for themselves.
//
// Numbers are in single precision, which is enough for a preconditioner. Gauss-Seidel runs over each rank's own rows;
// other ranks' unknowns are as they were exchanged last. Cells do not span ranks until few are left. Then all ranks
// have the whole level and go on without messages. docs/theory/linear.md has the measurements.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/prefetch.h"
#include "linear/linear_system.h"

namespace tailwater {

class CellMultigrid {
 public:
  /// For a system with cells. Collective.
  explicit CellMultigrid(LinearSystem& system);

  /// Takes over what LinearSystem::divide_diagonal has changed since, and returns whether it did. Only the first level
  /// follows, which is enough for a few rows near the surface (docs/theory/linear.md).
  bool follow(const LinearSystem& system);

  /// correction = an approximation of A^-1 residual. Collective.
  void apply(std::span<const double> residual, std::span<double> correction);

 private:
  struct Entry {
    int column;
    float weight;
  };

  /// diagonal_i x_i = b_i + sum_k weight_k x_column_k. In each row the columns left of the diagonal stand before
  /// `middle`. Behind it stand the others, and those of ghosts, which are numbered behind the rows.
  struct Matrix {
    std::vector<int> begin{0};
    std::vector<int> middle;
    std::vector<Entry> entries;
    std::vector<float> diagonal;
    std::vector<float> inverse;  ///< of the diagonal; 0 where that is 0

    std::size_t size() const { return diagonal.size(); }
    std::span<const Entry> row(std::size_t i) const {
      return {entries.data() + begin[i], entries.data() + begin[i + 1]};
    }
    void reserve(std::size_t rows, std::size_t entries_of_all);
    void add_row(std::span<const Entry> row, double diagonal_of_row);
    float sum_left(std::size_t i, const std::vector<float>& x) const { return sum(begin[i], middle[i], x); }
    float sum_right(std::size_t i, const std::vector<float>& x) const { return sum(middle[i], begin[i + 1], x); }
    float sum_all(std::size_t i, const std::vector<float>& x) const { return sum(begin[i], begin[i + 1], x); }
    /// Two sums side by side do not wait for each other.
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

  /// What goes to other ranks and comes from them, by rank. A level that all ranks have has none.
  struct Couplings {
    std::vector<std::vector<std::int32_t>> sent;  ///< rows
    std::vector<std::int64_t> received;           ///< number of ghosts
    ExchangePlan plan;
  };

  /// How all ranks get a level from the parts of each.
  struct Gathering {
    std::vector<int> counts;    ///< rows of each rank's part
    std::size_t first_own = 0;  ///< this rank's in the parts of all
    std::vector<int> row;       ///< of each entry of the parts of all
  };

  struct Level {
    Matrix matrix;
    Couplings couplings;
    std::optional<Gathering> gathering;
    bool is_whole = false;            ///< this rank has all rows
    std::vector<std::uint64_t> cell;  ///< on the next level, of the rows that have one; forgotten once that is made
    std::vector<int> parent;          ///< rows of the next level, of the rows that have a cell: these come first
    std::size_t cells = 0;            ///< this rank's rows of the next level
    std::vector<float> rhs;
    std::vector<float> solution;
  };

  std::vector<int> order_rows(std::span<const std::uint64_t> cell, std::span<const double> total, Level& level);
  void take_rows(LinearSystem& system);
  void hold_cells(std::size_t i, float lost);
  Couplings couple(const LinearSystem& system, std::vector<int>& needed, std::span<const int> place) const;
  std::vector<int> find_parents(Level& fine, Level& next, std::span<const int> rows) const;
  void add_next_level();
  void gather(Level& level) const;
  void invert_coarsest();

  void cycle(std::size_t k);
  void correct_by_next(std::size_t k);

  Communicator ranks_;
  int dimension_;
  bool constant_is_free_;
  std::vector<int> row_;      ///< of the system, for each row of the first level
  std::vector<float> scale_;  ///< of that row
  std::vector<Level> levels_;
  Eigen::MatrixXf coarsest_inverse_;
};

}  // namespace tailwater
