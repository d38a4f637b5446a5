// The lattice of the water along one axis: cells of equal width between the planes of walls, so that the first row of
// particles is half a cell from each of them, at any distance between them.
#pragma once

#include <array>
#include <vector>

namespace tailwater {

class LatticeAxis {
 public:
  /// Cells of 1 m from the origin on.
  LatticeAxis() : pieces_{{0.0, 1.0, 0, 0}} {}

  /// Cells between `planes` (in m, at least one): from each to the next the whole number of cells whose width is
  /// nearest to `spacing`. Planes at whole numbers of spacings from the first leave the width exactly `spacing`; a
  /// plane nearer than spacing/2 to the one before is left out, but not the last one.
  LatticeAxis(std::vector<double> planes, double spacing);

  /// The axis whose cells are each of these in `parts` parts.
  LatticeAxis divided(int parts) const;

  /// Cells between the first plane and the last: 0, ..., count() - 1. Cells outside have the width of the outermost
  /// ones.
  int count() const { return pieces_.back().first + pieces_.back().count; }

  double width(int cell) const { return piece_of(cell).width; }
  double low(int cell) const { return at(cell, 0.0); }
  double centre(int cell) const { return at(cell, 0.5); }
  /// The place `share` of the way through a cell.
  double at(int cell, double share) const {
    const Piece& piece = piece_of(cell);
    return piece.begin + ((cell - piece.first) + share) * piece.width;
  }
  /// The cell that holds a place.
  int cell_at(double x) const;

 private:
  struct Piece {
    double begin;  ///< m
    double width;  ///< m
    int first;     ///< its first cell
    int count;
  };

  const Piece& piece_of(int cell) const;

  std::vector<Piece> pieces_;
};

/// The cells of a lattice, by axis.
template <int Dim>
using Lattice = std::array<LatticeAxis, Dim>;

}  // namespace tailwater
