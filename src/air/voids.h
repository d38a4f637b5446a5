// The connected parts of the space that neither water nor walls fill.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "air/void_grid.h"

namespace tailwater {

/// Cells begin <= place < end of a row.
struct CellRun {
  std::int32_t row = 0;
  std::int32_t begin = 0;
  std::int32_t end = 0;

  int cells() const { return end - begin; }
  bool operator==(const CellRun&) const = default;
};

/// Runs of cells that are not filled, and the part of the void that each belongs to. Cells are joined through their
/// sides.
template <int Dim>
class Voids {
 public:
  Voids() = default;
  /// In the grid, `water` and `walls` fill cells.
  Voids(const VoidGrid<Dim>& grid, const CellMarks& water, const CellMarks& walls);

  struct Part {
    std::int64_t cells = 0;
    bool is_open = false;        ///< whether it reaches the border of the grid, where the open air is
    bool touches_water = false;  ///< else it is a hollow inside walls
  };
  const std::vector<Part>& parts() const { return parts_; }

  int rows() const { return static_cast<int>(row_begin_.size()) - 1; }
  std::span<const CellRun> runs() const { return runs_; }
  int part_of(std::size_t run) const { return part_of_[run]; }

  /// Calls visit(run, part) for the void pieces of a run of cells.
  template <class Visit>
  void visit_pieces(const CellRun& cells, Visit&& visit) const {
    for (std::size_t k = row_begin_[cells.row]; k < row_begin_[cells.row + 1]; ++k) {
      const std::int32_t begin = std::max(cells.begin, runs_[k].begin);
      const std::int32_t end = std::min(cells.end, runs_[k].end);
      if (begin < end) visit(CellRun{cells.row, begin, end}, part_of_[k]);
    }
  }

 private:
  void find_runs(const VoidGrid<Dim>& grid, const CellMarks& filled);
  void join_runs(const VoidGrid<Dim>& grid);
  void join_rows(int row, int other);
  void join(std::size_t a, std::size_t b);
  int root_of(int run);
  void find_parts(const VoidGrid<Dim>& grid, const CellMarks& water);

  std::vector<CellRun> runs_;
  std::vector<std::size_t> row_begin_;
  std::vector<int> part_of_;  ///< by run; while runs are joined, another run of the same part
  std::vector<Part> parts_;
};

}  // namespace tailwater
