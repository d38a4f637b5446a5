// Fits particles to cells of the water's lattice that walls, or the surface of a block, cut.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include "base/vec.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "geometry/point_grid.h"
#include "parallel/communicator.h"
#include "refinement/spacing_field.h"
#include "sampling/lattice_axis.h"
#include "sampling/water_shape.h"

namespace tailwater {

/// The part of a box in front of a plane that cuts it.
struct PartOfBox {
  double share;     ///< fraction of the box's volume
  double distance;  ///< m; mean distance from the plane
};

/// The part of a box with these edges that is in front of a plane with the unit normal `n`; `height` (m) is the height
/// of the box's centre above the plane.
template <int Dim>
PartOfBox part_in_front(const Vec<Dim>& edge, const Vec<Dim>& n, double height);

/// A wall counts as flat over a third of a cell's edge.
inline constexpr int parts_per_edge = 3;
template <int Dim>
inline constexpr int parts_of_cell = static_cast<int>(power<Dim>(parts_per_edge));

/// Calls visit(centre, edges) for each part of a cell.
template <int Dim, class Visit>
void for_each_part(const Vec<Dim>& centre, const Vec<Dim>& edge, Visit&& visit) {
  const Vec<Dim> part = edge / parts_per_edge;
  for (int n = 0; n < parts_of_cell<Dim>; ++n) {
    Vec<Dim> x = centre;
    for (int axis = 0, rest = n; axis < Dim; ++axis, rest /= parts_per_edge) {
      x[axis] += (rest % parts_per_edge - 0.5 * (parts_per_edge - 1)) * part[axis];
    }
    visit(x, part);
  }
}

/// Order of cells, along x first.
template <int Dim>
bool is_before(const Cell<Dim>& a, const Cell<Dim>& b) {
  return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
}

/// The range of a block's lattice that has places for particles. Its rows are parallel to x.
template <int Dim>
struct LatticeBlock {
  const Lattice<Dim>& axes;
  std::array<int, Dim> count;  ///< of places along each axis

  std::int64_t rows() const {
    std::int64_t rows = 1;
    for (int axis = 1; axis < Dim; ++axis) rows *= count[axis];
    return rows;
  }
  bool has(const Cell<Dim>& cell) const {
    for (int axis = 0; axis < Dim; ++axis) {
      if (cell[axis] < 0 || cell[axis] >= count[axis]) return false;
    }
    return true;
  }
  std::int64_t row_of(const Cell<Dim>& cell) const {
    std::int64_t row = 0;
    for (int axis = Dim - 1; axis > 0; --axis) row = row * count[axis] + cell[axis];
    return row;
  }
  /// Calls visit(cell) for the cells of a row.
  template <class Visit>
  void visit_row(std::int64_t row, Visit&& visit) const {
    Cell<Dim> cell{};
    for (int axis = 1; axis < Dim; row /= count[axis++]) cell[axis] = row % count[axis];
    for (; cell[0] < count[0]; ++cell[0]) visit(cell);
  }
};

/// The cells of a block that become particles.
template <int Dim>
struct FittedCells {
  /// A cell that a wall or the surface cuts, or a part of one.
  struct Cut {
    Cell<Dim> cell;
    int part;       ///< in the order of divide_cell
    double share;   ///< fraction of its volume that is water; 0 if no particle fits there
    double volume;  ///< m^Dim
    bool is_taken;
  };

  std::vector<double> in_row;  ///< number of cells in each row that are taken, or parts of them
  std::vector<Cut> cut;        ///< in their order
  double share = 1.0;          ///< volume of a particle as a fraction of its cell's
  double missed = 0.0;         ///< fraction of the water that is in cells that are not taken
};

template <int Dim>
using CellTest = std::function<bool(const Cell<Dim>&)>;

/// A block of water whose cells are to be fitted.
template <int Dim>
struct BlockToFit {
  const CaseSpec& spec;
  const FluidTable& table;
  const Boundary<Dim>& boundary;
  WaterShape<Dim>& shape;
  const LatticeBlock<Dim>& lattice;
  CellTest<Dim> is_reached;  ///< whether the centre of a cell is in the water
  /// Whether the particle of a cut cell with this centre fits in front of all walls at a spacing [m].
  std::function<bool(const Vec<Dim>& centre, double spacing)> has_room;
  const SpacingField<Dim>* field;  ///< by which cut cells are divided before they are fitted; null: they are not
};

/// Fits the cells of a block to the volume of its water. Takes cells with the largest fractions of water, as many as
/// match that volume best; water in unreached cells beside reached ones counts as well. Cells with equal fractions are
/// all taken or all left out, or taken by whole levels where the error would be too large, so that a symmetric case
/// starts symmetric. In zones of refinement the parts of cut cells are fitted. Where nothing cuts a cell, all reached
/// cells are taken with their own volumes. Each rank visits its part of the rows, and all get the same result.
/// Collective.
template <int Dim>
FittedCells<Dim> fit_cells(const BlockToFit<Dim>& block, const Communicator& ranks);

/// Number of reached cells in each row. Each rank visits its part of the rows. Collective.
template <int Dim>
std::vector<double> count_in_rows(const LatticeBlock<Dim>& lattice, const CellTest<Dim>& is_reached,
                                  const Communicator& ranks);

}  // namespace tailwater
