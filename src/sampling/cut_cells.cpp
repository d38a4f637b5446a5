#include "sampling/cut_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "geometry/from_spec.h"
#include "geometry/mesh_surface.h"
#include "parallel/at_start.h"

namespace tailwater {
namespace {

/// Shares that differ by less are the same: those of cells that are images of each other in a symmetric case.
constexpr double same_share = 1e-9;

/// Of all water: what may be too much or too little in cells so that those that are alike are all taken or none.
constexpr double most_misfit = 5e-3;

constexpr double deepest = 0.25;  // dx; a particle behind a wall is put in front of it from no deeper

template <int Dim>
Vec<Dim> centre_of(const Lattice<Dim>& lattice, const Cell<Dim>& cell) {
  Vec<Dim> x;
  for (int axis = 0; axis < Dim; ++axis) x[axis] = lattice[axis].centre(static_cast<int>(cell[axis]));
  return x;
}

template <int Dim>
Vec<Dim> edges_of(const Lattice<Dim>& lattice, const Cell<Dim>& cell) {
  Vec<Dim> edge;
  for (int axis = 0; axis < Dim; ++axis) edge[axis] = lattice[axis].width(static_cast<int>(cell[axis]));
  return edge;
}

/// Where walls, and the surface of a block, cut cells.
template <int Dim>
class Cutter {
 public:
  Cutter(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidTable& block, const WaterShape<Dim>& shape,
         const Lattice<Dim>& lattice)
      : boundary_(boundary), shape_(shape), lattice_(lattice), reach_(2.0 * spec.particles.spacing) {
    plain_.walls = boundary.walls;
    boundary.visit_plain_faces([&](int f) {
      const WallFace<Dim>& face = boundary.faces[f];
      if (boundary.plate_of(face.wall) >= 0) return;
      plain_.faces.push_back(face);
      cuts_.push_back(adapts_to_wall(spec, block, face));
    });
    plain_.file_faces(reach_);
  }

  /// The share of a cell that is in the block and in front of all walls, as if they were flat over a part of it.
  double share_of_water(const Cell<Dim>& cell) const {
    return share(cell, [&](const Vec<Dim>& x, auto&& visit) {
      visit_walls(x, visit);
      visit_shape(x, visit);
    });
  }

  /// The same without walls, of a cell whose centre the block holds or not.
  double share_of_shape(const Cell<Dim>& cell, bool holds_centre) const {
    const double half = half_diagonal(cell);
    bool is_near = false;
    visit_shape(centre_of<Dim>(lattice_, cell),
                [&](const Vec<Dim>&, double height) { is_near = std::abs(height) < half; });
    if (!is_near) return holds_centre ? 1.0 : 0.0;
    return share(cell, [&](const Vec<Dim>& x, auto&& visit) { visit_shape(x, visit); });
  }

  /// m; of the centre of a cell above the walls and the surface, negative behind any of them, infinite far from all.
  double least_height(const Cell<Dim>& cell) const {
    const Vec<Dim> x = centre_of<Dim>(lattice_, cell);
    double least = std::numeric_limits<double>::infinity();
    const auto see = [&](const Vec<Dim>&, double height) { least = std::min(least, height); };
    visit_walls(x, see);
    visit_shape(x, see);
    return least;
  }

  double half_diagonal(const Cell<Dim>& cell) const { return 0.5 * edges_of<Dim>(lattice_, cell).norm(); }

 private:
  template <class VisitNear>
  double share(const Cell<Dim>& cell, VisitNear&& visit_near) const {
    const Vec<Dim> centre = centre_of<Dim>(lattice_, cell);
    const Vec<Dim> edge = edges_of<Dim>(lattice_, cell);
    double least = std::numeric_limits<double>::infinity();
    const auto share_of_part = [&](const Vec<Dim>& x, const Vec<Dim>& part) {
      double share = 1.0;
      visit_near(x, [&](const Vec<Dim>& normal, double height) {
        share = std::min(share, part_in_front<Dim>(part, normal, height).share);
        least = std::min(least, height);
      });
      return share;
    };
    const double whole = share_of_part(centre, edge);
    if (whole <= 0.0 || least >= 0.5 * edge.norm()) return whole;
    double sum = 0.0;
    for_each_part<Dim>(centre, edge, [&](const Vec<Dim>& x, const Vec<Dim>& part) { sum += share_of_part(x, part); });
    return sum / parts_of_cell<Dim>;
  }

  /// Calls visit(normal, height), where the nearest point of something is and how high x is above it.
  template <class Visit>
  void tell(const Vec<Dim>& x, const Vec<Dim>& point, double height, const Vec<Dim>& normal, Visit&& visit) const {
    const bool is_on_it = std::abs(height) < corner_tolerance * reach_;
    visit(is_on_it ? normal : Vec<Dim>((x - point) / height), height);
  }

  /// Calls visit(normal, height) for the walls that are no meshes and for each mesh. What is behind a mesh may be
  /// nearer to another wall, in front of it.
  template <class Visit>
  void visit_walls(const Vec<Dim>& x, Visit&& visit) const {
    if (const NearestWall<Dim> wall = plain_.nearest(x, reach_); wall.face >= 0 && cuts_[wall.face]) {
      tell(x, wall.point, wall.signed_distance, plain_.faces[wall.face].normal, visit);
    }
    if constexpr (Dim == 3) {
      for (const WallMesh& mesh : boundary_.meshes) {
        const Vec<3> moved = boundary_.displacement_of(mesh);
        const SurfacePlace place = mesh.surface->nearest(x - moved, reach_);
        if (place.triangle < 0 || place.is_on_rim) continue;
        tell(x, place.point + moved, place.signed_distance, boundary_.faces[mesh.first_face + place.triangle].normal,
             visit);
      }
    }
  }

  template <class Visit>
  void visit_shape(const Vec<Dim>& x, Visit&& visit) const {
    shape_.visit_surface(x, reach_, [&](const Vec<Dim>& point, double height, const Vec<Dim>& normal) {
      tell(x, point, height, normal, visit);
    });
  }

  const Boundary<Dim>& boundary_;
  const WaterShape<Dim>& shape_;
  const Lattice<Dim>& lattice_;
  double reach_;            ///< m
  Boundary<Dim> plain_;     ///< without meshes and plates
  std::vector<bool> cuts_;  ///< by its faces
};

}  // namespace

template <int Dim>
PartOfBox part_in_front(const Vec<Dim>& edge, const Vec<Dim>& n, double height) {
  const double whole = n.cwiseAbs().dot(edge);
  const double t = height + 0.5 * whole;  // from the lowest corner to the plane, along n
  if (t <= 0.0) return {0.0, 0.0};
  if (t >= whole) return {1.0, height};
  // Along an axis nearly in the plane nothing changes, and the sums would cancel.
  constexpr double in_plane = 1e-4;
  std::array<double, Dim> extents{};
  int m = 0;
  for (int axis = 0; axis < Dim; ++axis) {
    if (const double extent = std::abs(n[axis]) * edge[axis]; extent > in_plane * whole) extents[m++] = extent;
  }
  // The share is the sum of (-1)^k (t - b)^m over the corners, with b the distance to a corner that is k edges from the
  // lowest, over m! and the extents. Its integral over t is the share times the mean distance.
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

/// What is summed over cells, row by row, so that the sums do not depend on who makes them.
struct RowSums {
  double reached = 0.0;          ///< cells
  double whole = 0.0;            ///< cells that are all water
  double volume_whole = 0.0;     ///< m^Dim
  double volume_of_water = 0.0;  ///< m^Dim, in all cells
  double volume_in_shape = 0.0;  ///< m^Dim, the same without walls
};
constexpr std::size_t numbers_of_row = sizeof(RowSums) / sizeof(double);

/// Calls visit(row) for this rank's part of the rows.
template <int Dim, class Visit>
void for_each_own_row(const LatticeBlock<Dim>& lattice, const Communicator& ranks, Visit&& visit) {
  const std::int64_t rows = lattice.rows();
  const std::int64_t end = rows * (ranks.rank() + 1) / ranks.size();
  for (std::int64_t row = rows * ranks.rank() / ranks.size(); row < end; ++row) visit(row);
}

/// Takes, of cells that are alike, every so many levels, so that they have the share `wanted` of their volume. What is
/// symmetric about a vertical plane stays so.
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

/// Takes cells with the largest shares until they have the volume (m^Dim). Of cells of one share, as those that are
/// images of each other in a symmetric case, all are taken or none, whichever is nearer, if that misses the volume by
/// `most_missed` (m^Dim) at most, and whole levels of them if not.
template <int Dim>
void take_cells(const Lattice<Dim>& lattice, double volume, double most_missed,
                std::vector<typename FittedCells<Dim>::Cut>& cells) {
  using Cut = typename FittedCells<Dim>::Cut;
  std::ranges::sort(cells, [](const Cut& a, const Cut& b) {
    return a.share != b.share ? a.share > b.share : is_before<Dim>(a.cell, b.cell);
  });
  for (std::size_t k = 0; k < cells.size() && cells[k].share > 0.0 && volume > 0.0;) {
    const std::size_t begin = k;
    double of_alike = 0.0;
    do {
      of_alike += edges_of<Dim>(lattice, cells[k++].cell).prod();
    } while (k < cells.size() && cells[k - 1].share - cells[k].share < same_share);
    double wanted = std::min(1.0, volume / of_alike);
    const double nearer = std::round(wanted);
    if (std::abs(nearer - wanted) * of_alike <= most_missed) wanted = nearer;
    take_levels<Dim>(std::span(cells).subspan(begin, k - begin), wanted);
    volume -= of_alike;
  }
  std::ranges::sort(cells, [](const Cut& a, const Cut& b) { return is_before<Dim>(a.cell, b.cell); });
}

/// Whether a cell beside this one is reached.
template <int Dim>
bool is_beside_water(const CaseSpec& spec, const LatticeBlock<Dim>& lattice, const CellTest<Dim>& is_reached,
                     const Cell<Dim>& cell) {
  bool found = false;
  for_each_around<Dim>(cell, [&](Cell<Dim> beside) {
    for (int axis = 0; axis < Dim; ++axis) {
      const int count = lattice.count[axis];
      if (!periodic_range(spec.domain, axis).empty()) beside[axis] = (beside[axis] + count) % count;
      if (beside[axis] < 0 || beside[axis] >= count) return;
    }
    found = found || is_reached(beside);
  });
  return found;
}

/// Takes as many of the cut cells as hold the `water` [m^Dim] that whole cells leave over, and finds the share of it
/// that each cell holds.
template <int Dim>
void take_cut_cells(const LatticeBlock<Dim>& lattice, const RowSums& all, double water, FittedCells<Dim>& fitted) {
  take_cells<Dim>(lattice.axes, water - all.volume_whole, most_misfit * water, fitted.cut);
  double of_cells = all.volume_whole;
  double in_cells = all.volume_whole;
  for (const auto& cut : fitted.cut) {
    if (!cut.is_taken) continue;
    const double volume = edges_of<Dim>(lattice.axes, cut.cell).prod();
    of_cells += volume;
    in_cells += cut.share * volume;
    fitted.in_row[lattice.row_of(cut.cell)] += 1.0;
  }
  if (of_cells > 0.0) fitted.share = water / of_cells;
  if (all.volume_of_water > 0.0) fitted.missed = 1.0 - in_cells / all.volume_of_water;
}

}  // namespace

template <int Dim>
FittedCells<Dim> fit_cells(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidTable& block,
                           WaterShape<Dim>& shape, const LatticeBlock<Dim>& lattice, const CellTest<Dim>& is_reached,
                           const CellTest<Dim>& has_room, const Communicator& ranks) {
  const Cutter<Dim> cutter(spec, boundary, block, shape, lattice.axes);
  std::vector<RowSums> rows(static_cast<std::size_t>(lattice.rows()));
  FittedCells<Dim> fitted;
  for_each_own_row(lattice, ranks, [&](std::int64_t row) {
    RowSums& sums = rows[row];
    lattice.visit_row(row, [&](const Cell<Dim>& cell) {
      const double volume = edges_of<Dim>(lattice.axes, cell).prod();
      if (shape.has_surface()) {
        const bool holds_centre = shape.holds(cell, centre_of<Dim>(lattice.axes, cell));
        sums.volume_in_shape += cutter.share_of_shape(cell, holds_centre) * volume;
      }
      const bool is_cell_reached = is_reached(cell);
      double height = 0.0;
      if (!is_cell_reached) {
        height = cutter.least_height(cell);
        const bool is_cut = height < 0.0 && height > -cutter.half_diagonal(cell);
        if (!is_cut || !is_beside_water<Dim>(spec, lattice, is_reached, cell)) return;
      }
      const double share = cutter.share_of_water(cell);
      if (!is_cell_reached && share < same_share) return;
      sums.volume_of_water += share * volume;
      if (is_cell_reached) sums.reached += 1.0;
      if (is_cell_reached && share > 1.0 - same_share) {
        sums.whole += 1.0;
        sums.volume_whole += volume;
      } else if (height > -deepest * spec.particles.spacing) {
        if (has_room(cell)) {
          fitted.cut.push_back({cell, share, false});
        } else if (is_cell_reached) {
          fitted.cut.push_back({cell, 0.0, false});
        }
      }
    });
  });
  fitted.cut = gather_on_all(ranks, fitted.cut);
  ranks.sum_of_each({&rows[0].reached, rows.size() * numbers_of_row});
  RowSums all;
  for (const RowSums& row : rows) {
    fitted.in_row.push_back(row.whole);
    all.reached += row.reached;
    all.volume_whole += row.volume_whole;
    all.volume_of_water += row.volume_of_water;
    all.volume_in_shape += row.volume_in_shape;
  }
  if (all.reached == 0.0 || (fitted.cut.empty() && !shape.has_surface())) return fitted;

  // The parts of cells leave out corners of the surface; what its formula gives is exact.
  double exact = 1.0;
  if (shape.has_surface()) exact = all.volume_in_shape > 0.0 ? shape.volume() / all.volume_in_shape : 0.0;
  const double water = exact * all.volume_of_water;
  take_cut_cells<Dim>(lattice, all, water, fitted);
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
