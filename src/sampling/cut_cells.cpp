#include "sampling/cut_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "geometry/from_spec.h"
#include "parallel/at_start.h"
#include "sampling/cutter.h"

namespace tailwater {
namespace {

/// Fractions that differ by less are equal, as those of cells that are mirror images of each other in a symmetric case.
constexpr double same_fraction = 1e-9;

/// Fraction of the whole water volume by which the taken cells may differ from it, so that equal cells are all taken or
/// all left out.
constexpr double max_misfit = 5e-3;

/// [dx]; greatest depth behind a wall from which a particle is moved in front of it.
constexpr double max_depth = 0.25;

}  // namespace

template <int Dim>
PartOfBox part_in_front(const Vec<Dim>& edge, const Vec<Dim>& n, double height) {
  const double whole = n.cwiseAbs().dot(edge);
  const double t = height + 0.5 * whole;  // along n, from the lowest corner to the plane
  if (t <= 0.0) return {0.0, 0.0};
  if (t >= whole) return {1.0, height};
  // An axis nearly parallel to the plane does not change the result, and its sums would suffer from cancellation.
  constexpr double in_plane = 1e-4;
  std::array<double, Dim> extents{};
  int m = 0;
  for (int axis = 0; axis < Dim; ++axis) {
    if (const double extent = std::abs(n[axis]) * edge[axis]; extent > in_plane * whole) extents[m++] = extent;
  }
  // The fraction is the sum of (-1)^k (t - b)^m over the corners, divided by m! and the extents, with b the distance of
  // a corner that is k edges from the lowest. Its integral over t is the fraction times the mean distance.
  double share = 0.0;
  double integral = 0.0;
  for (int corner = 0; corner < 1 << m; ++corner) {
    double rest = t;
    double sign = 1.0;
    for (int k = 0; k < m; ++k) {
      if ((corner >> k & 1) == 0) continue;
      rest -= extents[k];
      sign = -sign;
    }
    if (rest <= 0.0) continue;
    share += sign * std::pow(rest, m);
    integral += sign * std::pow(rest, m + 1) / (m + 1);
  }
  if (share <= 0.0) return {0.0, 0.0};
  const double distance = integral / share;
  for (int k = 0; k < m; ++k) share /= (k + 1) * extents[k];
  return {std::min(share, 1.0), distance};
}

namespace {

/// Sums over the cells of a row. Sums are formed row by row, so that they do not depend on the number of ranks.
struct RowSums {
  double reached = 0.0;          ///< cells
  double whole = 0.0;            ///< cells that are full of water
  double volume_whole = 0.0;     ///< m^Dim
  double volume_of_water = 0.0;  ///< m^Dim, in all cells
  double volume_in_shape = 0.0;  ///< m^Dim, in all cells, without walls
};
constexpr std::size_t numbers_of_row = sizeof(RowSums) / sizeof(double);

/// Calls visit(row) for this rank's part of the rows.
template <int Dim, class Visit>
void for_each_own_row(const LatticeBlock<Dim>& lattice, const Communicator& ranks, Visit&& visit) {
  const std::int64_t rows = lattice.rows();
  const std::int64_t end = rows * (ranks.rank() + 1) / ranks.size();
  for (std::int64_t row = rows * ranks.rank() / ranks.size(); row < end; ++row) visit(row);
}

/// Takes evenly spaced levels of cells with equal fractions, so that the taken cells have the fraction `wanted` of the
/// total volume. A case that is symmetric about a vertical plane stays symmetric.
template <int Dim>
void take_levels(std::span<typename FittedCells<Dim>::Cut> alike, double wanted) {
  using Cut = typename FittedCells<Dim>::Cut;
  std::ranges::sort(alike, [](const Cut& a, const Cut& b) { return is_before<Dim>(a.cell, b.cell); });
  int level = 0;
  for (std::size_t k = 0; k < alike.size(); ++k) {
    if (k > 0 && alike[k].cell[Dim - 1] != alike[k - 1].cell[Dim - 1]) ++level;
    alike[k].is_taken = std::floor((level + 1) * wanted + 0.5) > std::floor(level * wanted + 0.5);
  }
}

/// Takes cells or parts with the largest fractions until they have the volume (m^Dim). Cells of equal fraction, such as
/// mirror images in a symmetric case, are all taken or all left out, whichever is nearer, if the error in volume is at
/// most `max_missed` (m^Dim). Otherwise whole levels of them are taken.
template <int Dim>
void take_cells(double volume, double max_missed, std::vector<typename FittedCells<Dim>::Cut>& cells) {
  using Cut = typename FittedCells<Dim>::Cut;
  const auto precedes = [](const Cut& a, const Cut& b) {
    return a.cell != b.cell ? is_before<Dim>(a.cell, b.cell) : a.part < b.part;
  };
  std::ranges::sort(
      cells, [&](const Cut& a, const Cut& b) { return a.share != b.share ? a.share > b.share : precedes(a, b); });
  for (std::size_t k = 0; k < cells.size() && cells[k].share > 0.0 && volume > 0.0;) {
    const std::size_t begin = k;
    double of_alike = 0.0;
    do {
      of_alike += cells[k++].volume;
    } while (k < cells.size() && cells[k - 1].share - cells[k].share < same_fraction);
    double wanted = std::min(1.0, volume / of_alike);
    const double nearer = std::round(wanted);
    if (std::abs(nearer - wanted) * of_alike <= max_missed) wanted = nearer;
    take_levels<Dim>(std::span(cells).subspan(begin, k - begin), wanted);
    volume -= of_alike;
  }
  std::ranges::sort(cells, precedes);
}

/// Whether a neighbouring cell is reached by water.
template <int Dim>
bool is_beside_water(const BlockToFit<Dim>& block, const Cell<Dim>& cell) {
  bool found = false;
  for_each_around<Dim>(cell, [&](Cell<Dim> beside) {
    for (int axis = 0; axis < Dim; ++axis) {
      const int count = block.lattice.count[axis];
      if (!periodic_range(block.spec.domain, axis).empty()) beside[axis] = (beside[axis] + count) % count;
      if (beside[axis] < 0 || beside[axis] >= count) return;
    }
    found = found || block.is_reached(beside);
  });
  return found;
}

/// How the water in a cell becomes a particle.
enum class CellUse : std::uint8_t {
  dry,      ///< contains no water
  whole,    ///< full of water: becomes a particle
  cut,      ///< may become a particle
  no_room,  ///< its centre is reached by water, but no particle fits there
  behind,   ///< its centre is behind a wall, and no particle can be moved in front of it
};

struct ClassifiedCell {
  CellUse use;
  bool is_reached = false;
  double fraction = 0.0;  ///< fraction of its volume that is water
};

/// Classifies a cell whose centre is reached by water.
template <int Dim>
ClassifiedCell classify_reached(const BlockToFit<Dim>& block, const Cutter<Dim>& cutter, const Cell<Dim>& cell) {
  const CellBox<Dim> box(block.lattice.axes, cell);
  const double fraction = cutter.fraction_of_water(box);
  if (fraction > 1.0 - same_fraction) return {CellUse::whole, true, fraction};
  return {block.has_room(box.centre, block.spec.particles.spacing) ? CellUse::cut : CellUse::no_room, true, fraction};
}

template <int Dim>
ClassifiedCell classify(const BlockToFit<Dim>& block, const Cutter<Dim>& cutter, const Cell<Dim>& cell) {
  if (block.is_reached(cell)) return classify_reached<Dim>(block, cutter, cell);
  const CellBox<Dim> box(block.lattice.axes, cell);
  const double height = cutter.min_height(box.centre);
  const bool is_cut = height < 0.0 && height > -box.half_diagonal();
  if (!is_cut || !is_beside_water<Dim>(block, cell)) return {CellUse::dry};
  const double fraction = cutter.fraction_of_water(box);
  if (fraction < same_fraction) return {CellUse::dry};
  const double dx = block.spec.particles.spacing;
  const bool can_be_particle = height > -max_depth * dx && block.has_room(box.centre, dx);
  return {can_be_particle ? CellUse::cut : CellUse::behind, false, fraction};
}

/// Adds a cell of volume `volume` [m^Dim] to the sums.
void count(const ClassifiedCell& cell, double volume, RowSums& sums) {
  sums.volume_of_water += cell.fraction * volume;
  if (cell.is_reached) sums.reached += 1.0;
  if (cell.use != CellUse::whole) return;
  sums.whole += 1.0;
  sums.volume_whole += volume;
}

/// Counts the parts of a cell that is cut, and appends them to `cut`.
template <int Dim>
void visit_parts(const BlockToFit<Dim>& block, const Cutter<Dim>& cutter, const Cell<Dim>& cell, RowSums& sums,
                 std::vector<typename FittedCells<Dim>::Cut>& cut) {
  const CellBox<Dim> whole(block.lattice.axes, cell);
  const double dx = block.spec.particles.spacing;
  int number = 0;
  divide_cell<Dim>(*block.field, dx, whole.centre, whole.edges, [&](const Vec<Dim>& centre, const Vec<Dim>& edges) {
    const CellBox<Dim> part(centre, edges);
    const double fraction = cutter.fraction_of_water(part);
    sums.volume_of_water += fraction * part.volume();
    const double local = dx * block.field->at(centre);
    const bool can_be_particle =
        fraction > same_fraction && cutter.min_height(centre) > -max_depth * local && block.has_room(centre, local);
    cut.push_back({cell, number++, can_be_particle ? fraction : 0.0, part.volume(), false});
  });
}

/// Classifies and counts the cells of a row. Appends those that may be taken, and those where no particle fits, to
/// `cut`.
template <int Dim>
RowSums visit_cells(const BlockToFit<Dim>& block, const Cutter<Dim>& cutter, std::int64_t row,
                    std::vector<typename FittedCells<Dim>::Cut>& cut) {
  RowSums sums;
  block.lattice.visit_row(row, [&](const Cell<Dim>& cell) {
    const CellBox<Dim> box(block.lattice.axes, cell);
    if (block.shape.has_surface()) {
      const bool holds_centre = block.shape.holds(cell, box.centre);
      sums.volume_in_shape += cutter.fraction_of_shape(box, holds_centre) * box.volume();
    }
    const ClassifiedCell classified = classify<Dim>(block, cutter, cell);
    const bool is_cut = classified.use != CellUse::whole && classified.use != CellUse::dry;
    if (is_cut && block.field != nullptr) {
      sums.reached += classified.is_reached ? 1.0 : 0.0;
      visit_parts<Dim>(block, cutter, cell, sums, cut);
      return;
    }
    count(classified, box.volume(), sums);
    if (classified.use == CellUse::cut) cut.push_back({cell, 0, classified.fraction, box.volume(), false});
    if (classified.use == CellUse::no_room) cut.push_back({cell, 0, 0.0, box.volume(), false});
  });
  return sums;
}

/// The sums over all rows.
RowSums total_of(const std::vector<RowSums>& rows) {
  RowSums all;
  for (const RowSums& row : rows) {
    all.reached += row.reached;
    all.whole += row.whole;
    all.volume_whole += row.volume_whole;
    all.volume_of_water += row.volume_of_water;
    all.volume_in_shape += row.volume_in_shape;
  }
  return all;
}

/// Volume of the water in all cells [m^Dim]. The parts of cells miss corners of the surface, so the sum is scaled by
/// the volume of the shape, which is exact.
template <int Dim>
double volume_of_water(const WaterShape<Dim>& shape, const RowSums& all) {
  if (!shape.has_surface()) return all.volume_of_water;
  const double exact = all.volume_in_shape > 0.0 ? shape.volume() / all.volume_in_shape : 0.0;
  return exact * all.volume_of_water;
}

/// Takes as many cut cells as hold the `water` [m^Dim] outside whole cells, and computes the volume of particles as a
/// fraction of their cells.
template <int Dim>
void take_cut_cells(const LatticeBlock<Dim>& lattice, const RowSums& all, double water, FittedCells<Dim>& fitted) {
  take_cells<Dim>(water - all.volume_whole, max_misfit * water, fitted.cut);
  double of_cells = all.volume_whole;
  double in_cells = all.volume_whole;
  const Cell<Dim>* last = nullptr;  // that is taken, or parts of it
  for (const auto& cut : fitted.cut) {
    if (!cut.is_taken) continue;
    of_cells += cut.volume;
    in_cells += cut.share * cut.volume;
    if (last == nullptr || *last != cut.cell) fitted.in_row[lattice.row_of(cut.cell)] += 1.0;
    last = &cut.cell;
  }
  if (of_cells > 0.0) fitted.share = water / of_cells;
  if (all.volume_of_water > 0.0) fitted.missed = 1.0 - in_cells / all.volume_of_water;
}

}  // namespace

template <int Dim>
FittedCells<Dim> fit_cells(const BlockToFit<Dim>& block, const Communicator& ranks) {
  const Cutter<Dim> cutter(block);
  std::vector<RowSums> rows(static_cast<std::size_t>(block.lattice.rows()));
  FittedCells<Dim> fitted;
  for_each_own_row(block.lattice, ranks,
                   [&](std::int64_t row) { rows[row] = visit_cells(block, cutter, row, fitted.cut); });
  fitted.cut = gather_on_all(ranks, fitted.cut);
  ranks.sum_of_each({&rows[0].reached, rows.size() * numbers_of_row});
  for (const RowSums& row : rows) fitted.in_row.push_back(row.whole);
  const RowSums all = total_of(rows);
  if (all.reached == 0.0 || (fitted.cut.empty() && !block.shape.has_surface())) return fitted;
  take_cut_cells<Dim>(block.lattice, all, volume_of_water(block.shape, all), fitted);
  return fitted;
}

template <int Dim>
std::vector<double> count_in_rows(const LatticeBlock<Dim>& lattice, const CellTest<Dim>& is_reached,
                                  const Communicator& ranks) {
  std::vector<double> in_row(static_cast<std::size_t>(lattice.rows()), 0.0);
  for_each_own_row(lattice, ranks, [&](std::int64_t row) {
    lattice.visit_row(row, [&](const Cell<Dim>& cell) { in_row[row] += is_reached(cell) ? 1.0 : 0.0; });
  });
  ranks.sum_of_each(in_row);
  return in_row;
}

TAILWATER_IN_2D_AND_3D(part_in_front);
TAILWATER_IN_2D_AND_3D(fit_cells);
TAILWATER_IN_2D_AND_3D(count_in_rows);

}  // namespace tailwater
