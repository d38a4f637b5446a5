// Cells of the water's lattice that walls cut, and how many particles their water makes.
#pragma once

#include <vector>

#include "base/vec.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "geometry/point_grid.h"

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
inline constexpr int parts_of_cell =
    Dim == 2 ? parts_per_edge* parts_per_edge : parts_per_edge* parts_per_edge* parts_per_edge;

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

/// Fits the cells that a fill has reached to the volume of its water: as many cells as the water has volume, to the
/// nearest whole number, and those that have the largest shares of their volumes in front of the walls. Cells with
/// equal shares are taken in an order drawn from `particles.seed`. Returns the volume of the water over that of the
/// cells left, which keep their order, along x first. Where walls cut no cell, nothing changes and this is 1.
template <int Dim>
double fit_to_volume(const CaseSpec& spec, const Boundary<Dim>& boundary, const Lattice<Dim>& lattice,
                     std::vector<Cell<Dim>>& cells);

}  // namespace tailwater
