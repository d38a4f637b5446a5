// Where water can get to in a case: cells that cover it, and the walls between them.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "base/vec.h"
#include "case/spec.h"
#include "geometry/boundary.h"

namespace tailwater {

/// Cells that cover `faces` and `water`. They are as large as dx, or larger so that there are not more than `most`:
/// whether a path meets a wall does not depend on their size.
template <int Dim>
class CellSpace {
 public:
  using Cell = std::array<int, Dim>;

  CellSpace(const CaseSpec& spec, std::vector<WallFace<Dim>> faces, std::span<const Vec<Dim>> water, double most);

  std::size_t count() const { return near_wall_.size(); }
  double volume() const { return size_.prod(); }  ///< of a cell, m^Dim
  std::size_t index(const Cell& c) const;
  Vec<Dim> centre(const Cell& c) const;
  Cell cell_of(const Vec<Dim>& x) const;
  /// The neighbour of a cell; empty outside of all cells.
  std::optional<Cell> next(Cell c, int axis, int step) const;

  const std::vector<WallFace<Dim>>& faces() const { return faces_; }
  /// Puts other faces in the place of the present ones, as when walls have moved.
  void set_faces(std::vector<WallFace<Dim>> faces);

  /// Does the way from one place to another pass the face? A place exactly on it is before it, so that no way can pass
  /// a wall by resting on it.
  bool passes(const WallFace<Dim>& face, const Vec<Dim>& from, const Vec<Dim>& to) const;
  /// A face that the way passes; -1 if none.
  int face_between(const Vec<Dim>& from, const Vec<Dim>& to) const;
  /// The same from a cell to the next one (which may be outside), quickly.
  int face_beside(const Cell& c, int axis, int step) const;

  /// Calls visit(cell) for all cells in the box around two faces, and those beside it.
  template <class Visit>
  void visit_around(const WallFace<Dim>& a, const WallFace<Dim>& b, Visit&& visit) const {
    Vec<Dim> low = a.corners[0];
    Vec<Dim> high = low;
    for (const WallFace<Dim>* face : {&a, &b}) {
      for (const Vec<Dim>& corner : face->corners) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
    }
    const Cell first = cell_of(low - size_);
    const Cell last = cell_of(high + size_);
    Cell c = first;
    for (int axis = 0; axis < Dim;) {
      visit(c);
      for (axis = 0; axis < Dim && ++c[axis] > last[axis]; ++axis) c[axis] = first[axis];
    }
  }

 private:
  std::vector<WallFace<Dim>> faces_;
  double tolerance_;
  Vec<Dim> low_, size_;
  Cell count_;
  std::array<bool, Dim> is_periodic_;
  std::vector<bool> near_wall_;  ///< cells from which one step may meet a face
};

/// The cells that water gets to.
template <int Dim>
struct Spread {
  std::vector<typename CellSpace<Dim>::Cell> cells;  ///< in the order in which it gets there
  std::optional<Vec<Dim>> way_out;  ///< the last place inside of water that leaves the case; the search ends there
  std::vector<bool> met;            ///< by face: is it one that held the water?
  std::size_t sides = 0;            ///< of the cells, at faces
};

/// Lets water run from cell to cell, from those of `start`, until it is at rest or leaves the case: anywhere if `down`
/// is 0, else (a unit vector) sideways and down, never up.
template <int Dim>
Spread<Dim> spread(const CellSpace<Dim>& space, const std::vector<typename CellSpace<Dim>::Cell>& start,
                   const Vec<Dim>& down);

/// The cells of water at `positions`, but those that a wall parts from the middle of their cell.
template <int Dim>
std::vector<typename CellSpace<Dim>::Cell> cells_of(const CellSpace<Dim>& space, std::span<const Vec<Dim>> positions);

}  // namespace tailwater
