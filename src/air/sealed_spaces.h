// Spaces that walls, plates and open ends close, without a way out for air. They keep their gas, however water divides
// it. They are determined from the walls alone, so water does not change which space a place is in.
#pragma once

#include <span>
#include <vector>

#include "air/voids.h"

namespace tailwater {

template <int Dim>
class SealedSpaces {
 public:
  SealedSpaces() = default;
  /// `closed` marks the cells behind walls, beside plates and on open ends.
  SealedSpaces(const VoidGrid<Dim>& grid, const CellMarks& closed);

  /// Determines which spaces have a way out for air: those that an open part of the void reaches, as through an open
  /// end that is not full of water.
  void find_ways_out(const Voids<Dim>& voids);
  /// Marks a space whose volume may change by more than walls and inflow change it, as through an end with a level.
  void set_yielding(int space) { is_rigid_[space] = 0; }
  bool is_rigid(int space) const { return is_rigid_[space] != 0; }

  /// The sealed space of the first of these cells that is in one; -1: there is none. Where a wall has moved over all of
  /// the cells, the space of the cells beside them.
  int of(const VoidGrid<Dim>& grid, std::span<const CellRun> cells) const;
  /// The space of the cell nearest to x that no wall closes, within dx; -1 if that is not sealed.
  int near(const VoidGrid<Dim>& grid, const Vec<Dim>& x, double spacing) const;

 private:
  Voids<Dim> walled_;            ///< all space that no wall closes, water or air
  std::vector<char> is_sealed_;  ///< by part
  std::vector<char> is_rigid_;   ///< by part
};

}  // namespace tailwater
