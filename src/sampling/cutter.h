// How walls, and the surface of a block of water, cut boxes: cells of the water's lattice, or parts of them.
#pragma once

#include <limits>
#include <vector>

#include "geometry/mesh_surface.h"
#include "geometry/some_walls.h"
#include "sampling/cut_cells.h"

namespace tailwater {

/// A cell of a lattice, or a part of one.
template <int Dim>
struct CellBox {
  Vec<Dim> centre;
  Vec<Dim> edges;

  CellBox(const Vec<Dim>& middle, const Vec<Dim>& lengths) : centre(middle), edges(lengths) {}
  CellBox(const Lattice<Dim>& lattice, const Cell<Dim>& cell) {
    for (int axis = 0; axis < Dim; ++axis) {
      centre[axis] = lattice[axis].centre(static_cast<int>(cell[axis]));
      edges[axis] = lattice[axis].width(static_cast<int>(cell[axis]));
    }
  }

  double volume() const { return edges.prod(); }
  double half_diagonal() const { return 0.5 * edges.norm(); }
};

/// Computes how walls, and the surface of a block, cut cells.
template <int Dim>
class Cutter {
 public:
  explicit Cutter(const BlockToFit<Dim>& block)
      : boundary_(block.boundary), shape_(block.shape), reach_(2.0 * block.spec.particles.spacing) {
    plain_.walls = boundary_.walls;
    boundary_.visit_plain_faces([&](int f) {
      const WallFace<Dim>& face = boundary_.faces[f];
      if (boundary_.plate_of(face.wall) >= 0) return;
      plain_.faces.push_back(face);
      cuts_.push_back(adapts_to_wall(block.spec, block.table, face));
    });
    plain_.file_faces(reach_);
    find_hulls(block.spec);
    is_open_mesh_.assign(boundary_.walls.size(), 0);
    for (const WallMesh& mesh : boundary_.meshes)
      is_open_mesh_[mesh.wall] = is_hull(block.spec.walls[mesh.wall]) ? 0 : 1;
  }

  /// Fraction of a box that is in the block and in front of all walls, which count as flat over each part of the box.
  double fraction_of_water(const CellBox<Dim>& cell) const {
    return share(cell, [&](const Vec<Dim>& x, auto&& visit) {
      visit_walls(x, visit);
      visit_shape(x, visit);
    });
  }

  /// Fraction of a box that is in the block, without regard to walls. `holds_centre`: whether its centre is in it.
  double fraction_of_shape(const CellBox<Dim>& cell, bool holds_centre) const {
    const double half = cell.half_diagonal();
    bool is_near = false;
    visit_shape(cell.centre, [&](const Vec<Dim>&, double height) { is_near = std::abs(height) < half; });
    if (!is_near) return holds_centre ? 1.0 : 0.0;
    return share(cell, [&](const Vec<Dim>& x, auto&& visit) { visit_shape(x, visit); });
  }

  /// Height [m] of a place above the walls and the surface, negative behind any of them, infinite far from all.
  double min_height(const Vec<Dim>& x) const {
    double least = std::numeric_limits<double>::infinity();
    const auto see = [&](const Vec<Dim>&, double height) { least = std::min(least, height); };
    visit_walls(x, see);
    visit_shape(x, see);
    return least;
  }

 private:
  template <class VisitNear>
  double share(const CellBox<Dim>& cell, VisitNear&& visit_near) const {
    double least = std::numeric_limits<double>::infinity();
    const auto share_of_part = [&](const Vec<Dim>& x, const Vec<Dim>& part) {
      double share = 1.0;
      visit_near(x, [&](const Vec<Dim>& normal, double height) {
        share = std::min(share, part_in_front<Dim>(part, normal, height).share);
        least = std::min(least, height);
      });
      return share;
    };
    const double whole = share_of_part(cell.centre, cell.edges);
    if (whole <= 0.0 || least >= cell.half_diagonal()) return whole;
    double sum = 0.0;
    for_each_part<Dim>(cell.centre, cell.edges,
                       [&](const Vec<Dim>& x, const Vec<Dim>& part) { sum += share_of_part(x, part); });
    return sum / parts_of_cell<Dim>;
  }

  /// Calls visit(normal, height) for a surface, where `point` is its nearest point to x and `height` [m] that of x
  /// above it.
  template <class Visit>
  void tell(const Vec<Dim>& x, const Vec<Dim>& point, double height, const Vec<Dim>& normal, Visit&& visit) const {
    const bool is_on_it = std::abs(height) < corner_tolerance * reach_;
    visit(is_on_it ? normal : Vec<Dim>((x - point) / height), height);
  }

  /// A closed wall that water surrounds, without meshes.
  struct Hull {
    std::vector<std::uint8_t> walls;  ///< by wall, whether it is this one
    Box<Dim> box = {};                ///< around its faces
  };

  void find_hulls(const CaseSpec& spec) {
    for (std::size_t w = 0; w < spec.walls.size(); ++w) {
      if (!is_hull(spec.walls[w])) continue;
      Hull hull{std::vector<std::uint8_t>(plain_.walls.size(), 0)};
      hull.walls[w] = 1;
      for (const WallFace<Dim>& face : plain_.faces) {
        if (face.wall == static_cast<int>(w)) hull.box.extend(face.box());
      }
      if (!hull.box.isEmpty()) hulls_.push_back(std::move(hull));
    }
  }

  /// Calls visit(normal, height) for the nearest wall that is not a mesh, and for each mesh and each hull that x is
  /// behind. A point behind these may be nearer to another wall, in front of it: inside a block, above the bed. Where
  /// the rims of open meshes meet, as at the edges of a basin, x is behind them if it is behind the nearest of these.
  template <class Visit>
  void visit_walls(const Vec<Dim>& x, Visit&& visit) const {
    const auto tell_of = [&](const NearestWall<Dim>& wall) {
      if (wall.face < 0 || !cuts_[wall.face]) return;
      tell(x, wall.point, wall.signed_distance, plain_.faces[wall.face].normal, visit);
    };
    const NearestWall<Dim> nearest = plain_.nearest(x, reach_);
    tell_of(nearest);
    for (const Hull& hull : hulls_) {
      if (!hull.box.contains(x)) continue;
      const NearestWall<Dim> wall = nearest_among<Dim>(plain_, hull.walls, x, reach_);
      if (wall.face != nearest.face && wall.signed_distance < 0.0) tell_of(wall);
    }
    if constexpr (Dim == 3) {
      bool is_beside_rim = false;
      for (const WallMesh& mesh : boundary_.meshes) {
        const Vec<3> moved = boundary_.displacement_of(mesh);
        const SurfacePlace place = mesh.surface->nearest(x - moved, reach_);
        is_beside_rim = is_beside_rim || (place.triangle >= 0 && place.is_on_rim);
        if (place.triangle < 0 || place.is_on_rim) continue;
        tell(x, place.point + moved, place.signed_distance, boundary_.faces[mesh.first_face + place.triangle].normal,
             visit);
      }
      if (!is_beside_rim) return;
      const NearestWall<3> wall = nearest_among<3>(boundary_, is_open_mesh_, x, reach_);
      if (wall.face < 0 || wall.signed_distance >= 0.0) return;
      tell(x, wall.point, wall.signed_distance, boundary_.faces[wall.face].normal, visit);
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
  double reach_;            ///< m
  Boundary<Dim> plain_;     ///< without meshes and plates
  std::vector<bool> cuts_;  ///< for each face of `plain_`
  std::vector<Hull> hulls_;
  std::vector<std::uint8_t> is_open_mesh_;  ///< by wall
};

}  // namespace tailwater
