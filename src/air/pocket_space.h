// The space in and around pockets, cell by cell: each cell has the air that it belongs to, or the nearest air. The
// volume of a pocket and its fraction of the air beside a particle follow from this.
//
// Water covers cells within 1.1 dx of its particles, so that it has no holes. It then extends some 0.5 dx beyond its
// surface. The volume of a pocket is therefore not that of its void cells. With weights omega from 1 near the pocket to
// 0 some 3 dx inside the water it is
//
//   V = sum over cells c of omega_c |c| - sum over water j of w_j omega(j),
//
// where |c| is the part of the cell in front of walls, and omega(j) the mean over the cube of edge dx around j. A
// lattice of such cubes leaves no gap, so V is exact above one. Cells between two pockets count for the nearer. Nothing
// is seen through a plate: cells on its two sides belong to the air of their side.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "air/pockets.h"
#include "geometry/boundary.h"
#include "parallel/communicator.h"
#include "particles/particles.h"

namespace tailwater {

/// A pocket beside a particle.
struct PocketShare {
  int pocket;    ///< index
  double share;  ///< fraction of all air beside the particle
};

template <int Dim>
class PocketSpace {
 public:
  PocketSpace() = default;
  PocketSpace(std::shared_ptr<const VoidGrid<Dim>> grid, double spacing, const Voids<Dim>& voids,
              const CellMarks& walls, const Boundary<Dim>& boundary, std::span<const FoundPocket> pockets);

  /// The volume of each pocket [m^Dim], at least that of a cell; collective.
  std::vector<double> volumes(const Boundary<Dim>& boundary, const Particles<Dim>& particles,
                              const Communicator& ranks) const;

  /// The pocket whose air is nearest to x, within dx; -1 where open air is nearer, or there is no air.
  int pocket_at(const Vec<Dim>& x) const;

  /// The fraction of each pocket in the air near x; empty where there is no pocket. Deep in the water the fractions
  /// fall to 0 together.
  std::vector<PocketShare> shares_at(const Boundary<Dim>& boundary, const Vec<Dim>& x) const;

 private:
  using Cell = typename VoidGrid<Dim>::Cell;

  /// Owner of a cell.
  enum : std::int16_t { behind_wall = -2, in_water = -1, open_air = 0 };  // else 1 + index of the pocket

  void find_bounds(std::span<const FoundPocket> pockets);
  void fill(const Voids<Dim>& voids, const CellMarks& walls, std::span<const FoundPocket> pockets);
  void grow(const Boundary<Dim>& boundary);
  bool is_inside(const Vec<Dim>& at) const;
  /// The place of a cell of the grid in this space; -1 if it is outside.
  std::int64_t place(const Cell& c) const;
  template <class Visit>
  void visit_cells(Visit&& visit) const;
  template <class Visit>
  void visit_sides(const Cell& c, Visit&& visit) const;
  void set(const CellRun& run, std::int16_t owner);
  /// The part of a cell in front of walls, from 0 to 1.
  double in_front(const Cell& c, const Boundary<Dim>& boundary) const;
  double weight_of(std::int64_t place) const;
  bool is_seen(const Boundary<Dim>& boundary, const Vec<Dim>& x, const Cell& c, std::int64_t place) const;
  void take_water(const Boundary<Dim>& boundary, const Vec<Dim>& x, double volume, std::vector<double>& volumes) const;

  std::shared_ptr<const VoidGrid<Dim>> grid_;
  double spacing_ = 0.0;
  int pockets_ = 0;
  Cell low_{};    ///< the first cell of this space
  Cell count_{};  ///< its cells
  std::vector<std::int16_t> owner_;
  std::vector<std::int8_t> layer_;  ///< steps from the air that owns it
};

}  // namespace tailwater
