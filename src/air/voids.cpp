#include "air/voids.h"

#include <algorithm>
#include <numeric>

namespace tailwater {
namespace {

/// Whether a run is at the border of the grid in a direction that does not repeat.
template <int Dim>
bool is_at_border(const VoidGrid<Dim>& grid, const CellRun& run) {
  const auto c = grid.cell(run.row, run.begin);
  for (int d = 0; d < Dim - 1; ++d) {
    if (!grid.repeats(d) && (c[d] == 0 || c[d] == grid.count(d) - 1)) return true;
  }
  return !grid.repeats(Dim - 1) && (run.begin == 0 || run.end == grid.length());
}

template <int Dim>
bool touches(const VoidGrid<Dim>& grid, const CellMarks& water, const CellRun& run) {
  for (int end : {run.begin - 1, static_cast<int>(run.end)}) {
    if (grid.wrap(Dim - 1, end) && water(run.row, end)) return true;
  }
  for (int axis = 0; axis < Dim - 1; ++axis) {
    for (const int direction : {-1, 1}) {
      const int row = grid.row_beside(run.row, axis, direction);
      if (row >= 0 && water.any(row, run.begin, run.end)) return true;
    }
  }
  return false;
}

}  // namespace

template <int Dim>
Voids<Dim>::Voids(const VoidGrid<Dim>& grid, const CellMarks& water, const CellMarks& walls) {
  CellMarks filled = water;
  filled |= walls;
  find_runs(grid, filled);
  join_runs(grid);
  find_parts(grid, water);
}

template <int Dim>
void Voids<Dim>::find_runs(const VoidGrid<Dim>& grid, const CellMarks& filled) {
  const int length = grid.length();
  for (int row = 0; row < grid.rows(); ++row) {
    row_begin_.push_back(runs_.size());
    for (int begin = filled.next_unmarked(row, 0, length); begin < length;) {
      const int end = filled.next_marked(row, begin, length);
      runs_.push_back({row, begin, end});
      begin = filled.next_unmarked(row, end, length);
    }
  }
  row_begin_.push_back(runs_.size());
}

template <int Dim>
void Voids<Dim>::join_runs(const VoidGrid<Dim>& grid) {
  part_of_.resize(runs_.size());
  std::iota(part_of_.begin(), part_of_.end(), 0);
  for (int row = 0; row < grid.rows(); ++row) {
    const std::size_t begin = row_begin_[row];
    const std::size_t end = row_begin_[row + 1];
    const bool goes_round = grid.repeats(Dim - 1) && end - begin > 1;
    if (goes_round && runs_[begin].begin == 0 && runs_[end - 1].end == grid.length()) join(begin, end - 1);
    for (int axis = 0; axis < Dim - 1; ++axis) {
      const int other = grid.row_beside(row, axis, 1);
      if (other >= 0) join_rows(row, other);
    }
  }
}

template <int Dim>
void Voids<Dim>::join_rows(int row, int other) {
  std::size_t a = row_begin_[row];
  std::size_t b = row_begin_[other];
  while (a < row_begin_[row + 1] && b < row_begin_[other + 1]) {
    if (runs_[a].begin < runs_[b].end && runs_[b].begin < runs_[a].end) join(a, b);
    if (runs_[a].end < runs_[b].end) {
      ++a;
    } else {
      ++b;
    }
  }
}

template <int Dim>
int Voids<Dim>::root_of(int run) {
  while (part_of_[run] != run) run = part_of_[run] = part_of_[part_of_[run]];
  return run;
}

template <int Dim>
void Voids<Dim>::join(std::size_t a, std::size_t b) {
  const auto [least, other] = std::minmax({root_of(static_cast<int>(a)), root_of(static_cast<int>(b))});
  part_of_[other] = least;
}

template <int Dim>
void Voids<Dim>::find_parts(const VoidGrid<Dim>& grid, const CellMarks& water) {
  for (std::size_t k = 0; k < runs_.size(); ++k) part_of_[k] = root_of(static_cast<int>(k));
  for (std::size_t k = 0; k < runs_.size(); ++k) {  // the first run of a part is the one that all are joined with
    const auto joined = static_cast<std::size_t>(part_of_[k]);
    if (joined == k) {
      part_of_[k] = static_cast<int>(parts_.size());
      parts_.emplace_back();
    } else {
      part_of_[k] = part_of_[joined];
    }
    Part& part = parts_[part_of_[k]];
    part.cells += runs_[k].cells();
    part.is_open = part.is_open || is_at_border(grid, runs_[k]);
  }
  for (std::size_t k = 0; k < runs_.size(); ++k) {
    Part& part = parts_[part_of_[k]];
    if (!part.is_open && !part.touches_water) part.touches_water = touches(grid, water, runs_[k]);
  }
}

template class Voids<2>;
template class Voids<3>;

}  // namespace tailwater
