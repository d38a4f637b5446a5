#include "geometry/cut_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "base/random.h"
#include "geometry/from_spec.h"
#include "geometry/mesh_surface.h"

namespace tailwater {
namespace {

/// Shares that differ by less are the same: those of cells that are images of each other in a symmetric case.
constexpr double same_share = 1e-9;

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

/// Calls visit(cell) for the 3^Dim cells around a cell, itself among them.
template <int Dim, class Visit>
void for_each_around(const Cell<Dim>& cell, Visit&& visit) {
  for (int n = 0; n < (Dim == 2 ? 9 : 27); ++n) {
    Cell<Dim> around = cell;
    for (int axis = 0, rest = n; axis < Dim; ++axis, rest /= 3) around[axis] += rest % 3 - 1;
    visit(around);
  }
}

/// Where walls cut cells.
template <int Dim>
class Cutter {
 public:
  Cutter(const Boundary<Dim>& boundary, const Lattice<Dim>& lattice, double spacing)
      : boundary_(boundary), lattice_(lattice), reach_(2.0 * spacing) {
    plain_.walls = boundary.walls;
    boundary.visit_plain_faces([&](int f) {
      if (boundary.plate_of(boundary.faces[f].wall) < 0) plain_.faces.push_back(boundary.faces[f]);
    });
    plain_.file_faces(reach_);
  }

  /// The share of a cell that is in front of all walls, as if they were flat over a part of it.
  double share_in_front(const Cell<Dim>& cell) const {
    const Vec<Dim> centre = centre_of<Dim>(lattice_, cell);
    const Vec<Dim> edge = edges_of<Dim>(lattice_, cell);
    const double whole = share_of_part(centre, edge);
    const double of_ball = 0.5 * edge.norm();
    if (whole <= 0.0 || least_height(centre) >= of_ball) return whole;
    double sum = 0.0;
    for_each_part<Dim>(centre, edge, [&](const Vec<Dim>& x, const Vec<Dim>& part) { sum += share_of_part(x, part); });
    return sum / parts_of_cell<Dim>;
  }

  /// m; of a place above the walls, negative behind any of them, infinite far from all.
  double least_height(const Vec<Dim>& x) const {
    double least = std::numeric_limits<double>::infinity();
    visit_walls(x, [&](const Vec<Dim>&, double height) { least = std::min(least, height); });
    return least;
  }

 private:
  /// Calls visit(normal, height) for the walls that are no meshes and for each mesh. What is behind a mesh may be
  /// nearer to another wall, in front of it.
  template <class Visit>
  void visit_walls(const Vec<Dim>& x, Visit&& visit) const {
    const auto tell = [&](const Vec<Dim>& point, double height, const Vec<Dim>& normal) {
      const bool is_on_wall = std::abs(height) < corner_tolerance * reach_;
      visit(is_on_wall ? normal : Vec<Dim>((x - point) / height), height);
    };
    if (const NearestWall<Dim> wall = plain_.nearest(x, reach_); wall.face >= 0) {
      tell(wall.point, wall.signed_distance, plain_.faces[wall.face].normal);
    }
    if constexpr (Dim == 3) {
      for (const WallMesh& mesh : boundary_.meshes) {
        const Vec<3> way = boundary_.way_of(mesh);
        const SurfacePlace place = mesh.surface->nearest(x - way, reach_);
        if (place.triangle < 0 || place.is_on_rim) continue;
        tell(place.point + way, place.signed_distance, boundary_.faces[mesh.first_face + place.triangle].normal);
      }
    }
  }

  double share_of_part(const Vec<Dim>& x, const Vec<Dim>& edge) const {
    double share = 1.0;
    visit_walls(x, [&](const Vec<Dim>& normal, double height) {
      share = std::min(share, part_in_front<Dim>(edge, normal, height).share);
    });
    return share;
  }

  const Boundary<Dim>& boundary_;
  const Lattice<Dim>& lattice_;
  double reach_;         ///< m
  Boundary<Dim> plain_;  ///< without meshes and plates
};

template <int Dim>
bool is_before(const Cell<Dim>& a, const Cell<Dim>& b) {
  return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
}

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
  // The share is the sum of (-1)^k (t - b)^m over the corners, with b the way to a corner that is k edges from the
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

template <int Dim>
double fit_to_volume(const CaseSpec& spec, const Boundary<Dim>& boundary, const Lattice<Dim>& lattice,
                     std::vector<Cell<Dim>>& cells) {
  struct Candidate {
    Cell<Dim> cell;
    double share;
    double draw;
  };
  const double dx = spec.particles.spacing;
  const Cutter<Dim> cutter(boundary, lattice, dx);
  std::vector<Candidate> candidates;
  double water = 0.0;  // m^Dim
  double of_cells = 0.0;
  bool is_cut = false;
  const auto consider = [&](const Cell<Dim>& cell, bool is_reached) {
    const double share = cutter.share_in_front(cell);
    is_cut = is_cut || share < 1.0 - same_share;
    const double volume = edges_of<Dim>(lattice, cell).prod();
    water += share * volume;
    of_cells += is_reached ? volume : 0.0;
    const double height = cutter.least_height(centre_of<Dim>(lattice, cell));
    if (!is_reached && height < -deepest * dx) return;
    candidates.push_back({cell, std::round(share / same_share) * same_share,
                          random_number(spec.particles.seed, cell_key<Dim>(cell), 0)});
  };
  std::unordered_set<std::uint64_t> seen;
  for (const Cell<Dim>& cell : cells) seen.insert(cell_key<Dim>(cell));
  for (const Cell<Dim>& cell : cells) consider(cell, true);
  // Beside them, the cells whose centres are behind a wall.
  for (const Cell<Dim>& cell : cells) {
    for_each_around<Dim>(cell, [&](Cell<Dim> beside) {
      for (int axis = 0; axis < Dim; ++axis) {
        const int count = lattice[axis].count();
        if (!periodic_range(spec.domain, axis).empty()) beside[axis] = (beside[axis] + count) % count;
        if (beside[axis] < 0 || beside[axis] >= count) return;
      }
      if (seen.contains(cell_key<Dim>(beside))) return;
      if (cutter.least_height(centre_of<Dim>(lattice, beside)) >= 0.0) return;
      seen.insert(cell_key<Dim>(beside));
      consider(beside, false);
    });
  }
  if (!is_cut) return 1.0;
  // Cells have much the same volume, that of dx^Dim.
  const double mean = of_cells / static_cast<double>(cells.size());
  const std::size_t count =
      std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(water / mean)), 1, candidates.size());
  std::ranges::sort(candidates, [](const Candidate& a, const Candidate& b) {
    if (a.share != b.share) return a.share > b.share;
    if (a.draw != b.draw) return a.draw < b.draw;
    return is_before<Dim>(a.cell, b.cell);
  });
  candidates.resize(count);
  cells.clear();
  of_cells = 0.0;
  for (const Candidate& candidate : candidates) cells.push_back(candidate.cell);
  std::ranges::sort(cells, is_before<Dim>);
  for (const Cell<Dim>& cell : cells) of_cells += edges_of<Dim>(lattice, cell).prod();
  return water / of_cells;
}

template double fit_to_volume<2>(const CaseSpec&, const Boundary<2>&, const Lattice<2>&, std::vector<Cell<2>>&);
template double fit_to_volume<3>(const CaseSpec&, const Boundary<3>&, const Lattice<3>&, std::vector<Cell<3>>&);

template PartOfBox part_in_front<2>(const Vec<2>&, const Vec<2>&, double);
template PartOfBox part_in_front<3>(const Vec<3>&, const Vec<3>&, double);

}  // namespace tailwater
