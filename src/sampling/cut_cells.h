// Cells of the water's lattice that walls, and the surface of a block, cut, and how many particles their water makes.
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
#include "sampling/lattice_axis.h"
#include "sampling/water_shape.h"

namespace tailwater {

/// A part of a box that is cut by a plane.
struct PartOfBox {
  double share;     ///< of the box's volume
  double distance;  ///< m; from the plane, in the mean
};

/// The part of a box with these edges that is in front of a plane with the unit normal `n`; `height` (m) is that of the
/// box's centre above the plane.
template <int Dim>
PartOfBox part_in_front(const Vec<Dim>& edge, const Vec<Dim>& n, double height);

/// A wall counts as flat over a third of a cell.
inline constexpr int parts_per_edge = 3;
template <int Dim>
inline constexpr int parts_of_cell = static_cast<int>(power<Dim>(parts_per_edge));

/// Divides a cell: calls visit(centre, edges) for each part.
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

/// The order of cells, along x first.
template <int Dim>
bool is_before(const Cell<Dim>& a, const Cell<Dim>& b) {
  return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
}

/// A block's lattice, as far as it has places for particles. Its rows lie along x.
template <int Dim>
struct LatticeBlock {
  const Lattice<Dim>& axes;
  std::array<int, Dim> count;  ///< of places along each axis

  std::int64_t rows() const {
    std::int64_t rows = 1;
    for (int axis = 1; axis < Dim; ++axis) rows *= count[axis];
    return rows;
  }
  std::int64_t row_of(const Cell<Dim>& cell) const {
    std::int64_t row = 0;
    for (int axis = Dim - 1; axis > 0; --axis) row = row * count[axis] + cell[axis];
    return row;
  }
  /// Calls visit(cell) along a row.
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
  /// A cell that something cuts.
  struct Cut {
    Cell<Dim> cell;
    double share;  ///< of its volume that is water; 0 if no particle can stand there
    bool is_taken;
  };

  std::vector<double> in_row;  ///< how many cells of each row are taken
  std::vector<Cut> cut;        ///< in their order
  double share = 1.0;          ///< of its cell's volume that a particle has
  double missed = 0.0;         ///< share of the water that is in cells that are not taken
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
  CellTest<Dim> has_room;    ///< whether the particle of a cut cell can stand in front of all walls
};

/// Fits the cells of a block to the volume of its water: takes as many as are nearest to it, those that have the
/// largest fractions of their volumes in front of the walls and in the block. The fractions of cells beside those that
/// are reached count as well. Of cells with equal fractions all are taken or none, or whole levels of them where these
/// are too many, so that a symmetric case starts symmetric. Where nothing cuts a cell, all that are reached are taken
/// with their own volumes. Each rank visits its part of the rows, and all get the same result. Collective.
template <int Dim>
FittedCells<Dim> fit_cells(const BlockToFit<Dim>& block, const Communicator& ranks);

/// How many cells of each row are reached. Each rank looks at its part of the rows. Collective.
template <int Dim>
std::vector<double> count_in_rows(const LatticeBlock<Dim>& lattice, const CellTest<Dim>& is_reached,
                                  const Communicator& ranks);

}  // namespace tailwater
