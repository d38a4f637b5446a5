// The space that water can reach in a case: cells that cover the case, and the walls between them.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "base/box.h"
#include "base/vec.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "geometry/opening.h"
#include "sampling/fluid_particles.h"

namespace tailwater {

/// Maximum number of cells of a whole case; if there would be more cells of size dx, the cells are larger.
constexpr double max_cells_of_case = 4e6;

/// The faces of the walls, and the faces that close the `ends`.
template <int Dim>
std::vector<WallFace<Dim>> faces_with(const Boundary<Dim>& boundary, const std::vector<Opening<Dim>>& ends);

/// Cells that cover `faces` and the box of the `water`. Their size is dx, or larger to limit their number to `most`.
/// Whether a path meets a wall does not depend on their size.
template <int Dim>
class CellSpace {
 public:
  using Cell = std::array<int, Dim>;

  CellSpace(const CaseSpec& spec, std::vector<WallFace<Dim>> faces, const Box<Dim>& water, double most);

  std::size_t count() const { return near_faces_.size() - 1; }
  double volume() const { return size_.prod(); }                 ///< volume of a cell, m^Dim
  const Vec<Dim>& size() const { return size_; }                 ///< edges of a cell, m
  double edge() const { return std::pow(volume(), 1.0 / Dim); }  ///< edge of a cell, m
  std::size_t index(const Cell& c) const;
  Cell cell(std::size_t index) const;
  Vec<Dim> centre(const Cell& c) const;
  Cell cell_of(const Vec<Dim>& x) const;
  /// The part of a vector across the periodic directions.
  Vec<Dim> across_periods(Vec<Dim> v) const;
  /// The neighbour of a cell; empty if it is outside all cells.
  std::optional<Cell> next(Cell c, int axis, int step) const;

  std::span<const WallFace<Dim>> faces() const { return std::span(faces_).first(faces_.size() - image_of_.size()); }
  /// Replaces the faces, as when walls have moved.
  void set_faces(std::vector<WallFace<Dim>> faces);

  /// Whether the straight line from one place to another passes the face. A place exactly on it counts as in front. A
  /// line that begins on it, to rounding, and leads behind it passes it, so that no line can pass a wall through a
  /// place on it, whatever the rounding of the faces that meet there.
  bool passes(const WallFace<Dim>& face, const Vec<Dim>& from, const Vec<Dim>& to) const;
  /// Whether the centre of a cell is behind the walls next to it. A centre on a wall is on neither side. Beside a
  /// convex edge a centre is in front, although it may be behind the plane of one of the faces that meet there.
  bool is_behind_walls(const Cell& c) const;
  /// The face on which the centre of a cell lies; -1 if none.
  int face_at(const Cell& c) const;
  /// The first face that the line passes, which begins in cell `c` and is no longer than a cell; -1 if none. A line
  /// that cuts a corner off a body passes two faces: into the body and out again.
  int face_between(const Cell& c, const Vec<Dim>& from, const Vec<Dim>& to) const;
  /// face_between for the line from the centre of a cell to that of the next one, which may be outside.
  int face_beside(const Cell& c, int axis, int step) const;
  /// Calls visit(face) for the faces that the same line meets first and from the front. If two are back to back, only
  /// the one that faces this cell counts.
  template <class Visit>
  void visit_fronts_beside(const Cell& c, int axis, int step, Visit&& visit) const;

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
  /// The first of the faces and images that the line passes, as face_between.
  int first_passed(const Cell& c, const Vec<Dim>& from, const Vec<Dim>& to) const;
  /// The index of a face or, for an image, of the face of which it is one.
  int drawn(int face) const {
    const int image = face - static_cast<int>(faces().size());
    return image < 0 ? face : image_of_[image];
  }

  PeriodicDomain<Dim> domain_;
  std::vector<WallFace<Dim>> faces_;  ///< as given, then their images in other periods
  std::vector<int> image_of_;         ///< for each image, the index of its face
  double tolerance_;
  Vec<Dim> low_, size_;
  Cell count_;
  std::array<bool, Dim> is_periodic_;
  std::vector<std::size_t>
      near_faces_;  ///< by cell: begin in near_list_ of the faces that one step from the cell may meet
  std::vector<int> near_list_;
};

/// Walks from the cells of `start` from cell to cell, each once. `go(c, axis, step)` returns the cell beside `c` in
/// that direction if the walk goes on there. Marks the cells in `is_known`, by their index, and leaves out those marked
/// before. Returns the cells in the order of the walk.
template <int Dim, class Go>
std::vector<typename CellSpace<Dim>::Cell> walk(const CellSpace<Dim>& space,
                                                const std::vector<typename CellSpace<Dim>::Cell>& start,
                                                std::vector<bool>& is_known, Go&& go) {
  using Cell = typename CellSpace<Dim>::Cell;
  std::vector<Cell> cells;
  const auto visit = [&](const Cell& c) {
    if (is_known[space.index(c)]) return;
    is_known[space.index(c)] = true;
    cells.push_back(c);
  };
  for (const Cell& c : start) visit(c);
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const Cell c = cells[k];
    for (int move = 0; move < 2 * Dim; ++move) {
      if (const std::optional<Cell> next = go(c, move / 2, move % 2 == 0 ? -1 : 1)) visit(*next);
    }
  }
  return cells;
}

/// The cells that water reaches.
template <int Dim>
struct Spread {
  std::vector<typename CellSpace<Dim>::Cell> cells;  ///< in the order in which water reaches them
  std::optional<Vec<Dim>> way_out;  ///< the last place inside, if water leaves the case; the search ends there
  std::vector<bool> met;            ///< by face: whether it held the water
  std::vector<bool> wet;            ///< by face: whether it held the water from its front
  std::vector<std::optional<Vec<Dim>>> behind;  ///< by face: a place behind it that the water reaches
  std::size_t sides = 0;                        ///< sides of the cells that are at faces
};

/// Whether water at the outer edge of the cells leaves the case, or is held there.
enum class Edge { leads_out, holds };

/// Spreads water from the cells of `start` from cell to cell until it is at rest or leaves the case. If `down` is 0 it
/// spreads in all directions; if `down` is a unit vector, sideways and down, never up, whatever the angle between the
/// cells and gravity.
template <int Dim>
Spread<Dim> spread(const CellSpace<Dim>& space, const std::vector<typename CellSpace<Dim>::Cell>& start,
                   const Vec<Dim>& down, Edge edge = Edge::leads_out);

/// The cell beside a place on an open end, inside of the case; none if a wall is between them, as may happen with large
/// cells.
template <int Dim>
std::optional<typename CellSpace<Dim>::Cell> cell_inside(const CellSpace<Dim>& space, const Opening<Dim>& end,
                                                         const Vec<Dim>& place_on_end);

/// The cells of the water of all ranks, without places that a wall separates from the centre of their cell. Collective.
template <int Dim>
std::vector<typename CellSpace<Dim>::Cell> cells_of(const CellSpace<Dim>& space, const FluidParticles<Dim>& fluid);

}  // namespace tailwater
