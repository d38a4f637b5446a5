#include "air/sealed_spaces.h"

#include <limits>

namespace tailwater {

template <int Dim>
SealedSpaces<Dim>::SealedSpaces(const VoidGrid<Dim>& grid, const CellMarks& closed)
    : walled_(grid, CellMarks(grid.rows(), grid.length()), closed),
      is_sealed_(walled_.parts().size(), 0),
      is_rigid_(walled_.parts().size(), 1) {}

template <int Dim>
void SealedSpaces<Dim>::find_ways_out(const Voids<Dim>& voids) {
  for (std::size_t k = 0; k < is_sealed_.size(); ++k) is_sealed_[k] = walled_.parts()[k].is_open ? 0 : 1;
  for (std::size_t k = 0; k < voids.runs().size(); ++k) {
    if (!voids.parts()[voids.part_of(k)].is_open) continue;
    walled_.visit_pieces(voids.runs()[k], [&](const CellRun& /*piece*/, int part) { is_sealed_[part] = 0; });
  }
}

template <int Dim>
int SealedSpaces<Dim>::of(const VoidGrid<Dim>& grid, std::span<const CellRun> cells) const {
  bool are_behind_wall = true;
  for (const CellRun& run : cells) {
    int space = -1;
    if (run.row < 0 || run.row >= walled_.rows()) continue;  // a checkpoint may hold any number
    walled_.visit_pieces(run, [&](const CellRun& /*piece*/, int part) {
      are_behind_wall = false;
      if (space < 0 && is_sealed_[part] != 0) space = part;
    });
    if (space >= 0) return space;
  }
  if (!are_behind_wall) return -1;
  for (const CellRun& run : cells) {
    if (run.row < 0 || run.row >= walled_.rows()) continue;
    const Vec<Dim> x = grid.centre(grid.cell(run.row, run.begin));
    if (const int space = near(grid, x, 2.0 * grid.edge().maxCoeff()); space >= 0) return space;
  }
  return -1;
}

template <int Dim>
int SealedSpaces<Dim>::near(const VoidGrid<Dim>& grid, const Vec<Dim>& x, double spacing) const {
  int space = -1;
  double nearest = std::numeric_limits<double>::infinity();
  grid.visit_ball(x, spacing, [&](int row, int begin, int end) {
    walled_.visit_pieces({row, begin, end}, [&](const CellRun& piece, int part) {
      for (int place = piece.begin; place < piece.end; ++place) {
        const double square = (grid.centre(grid.cell(row, place)) - x).squaredNorm();
        if (square >= nearest) continue;
        nearest = square;
        space = part;
      }
    });
  });
  return space >= 0 && is_sealed_[space] != 0 ? space : -1;
}

template class SealedSpaces<2>;
template class SealedSpaces<3>;

}  // namespace tailwater
