// How deep a place is in a zone of finer particles that is not a box: a polygon, in 3D the prism over a polygon in
// plan, or the surroundings of walls.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "base/box.h"
#include "base/vec.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "geometry/face_grid.h"
#include "geometry/point_grid.h"
#include "geometry/polygon.h"

namespace tailwater {

template <int Dim>
class ZoneDepth {
 public:
  /// `border` [m] is the width over which the spacing falls, `bounds` the box around all walls, and `period` has the
  /// lengths [m] of the periodic directions, 0 for the others. Edges of a polygon beyond the bounds bound nothing.
  /// Throws CaseError for points of another dimension.
  ZoneDepth(const RefinementTable& table, const Boundary<Dim>& boundary, const Box<Dim>& bounds, const Vec<Dim>& period,
            double border, double spacing);

  struct Depth {
    double depth;    ///< m; behind the place where the spacing begins to fall, negative outside
    Vec<Dim> slope;  ///< its gradient
  };
  /// Between the nodes of a lattice by quadratic splines, so that the gradient is continuous, also where two walls are
  /// equally near. The depth is limited at some spacings beyond the border on either side.
  Depth at(const Vec<Dim>& x) const;
  double depth(const Vec<Dim>& x) const;

  /// Around all places with a depth above 0.
  const Box<Dim>& box() const { return box_; }

 private:
  /// Nodes along each edge of a tile, whose outermost ones belong to its neighbours too.
  static constexpr int tile_nodes = 10;
  using Tile = std::vector<double>;

  /// Weights along an axis of the nodes before, at and behind the nearest one.
  using Weights = std::array<std::array<double, 3>, Dim>;
  struct Around {
    const double* first;  ///< m; depth at the first of the nodes around
    Vec<Dim> off;         ///< place beyond the nearest node, over the step
  };

  void add_outline(const RefinementTable& table, double spacing);
  void add_walls(const RefinementTable& table, const Boundary<Dim>& boundary);
  /// m; without images in periodic directions.
  double depth_of_image(const Vec<Dim>& place) const;
  /// A prism has the depth of the plane z = 0 at all heights.
  Vec<Dim> in_plan(Vec<Dim> x) const;
  double exact_depth(const Vec<Dim>& x) const;
  Around around(const Vec<Dim>& x) const;
  static Weights weights_at(const Vec<Dim>& off);
  static double weighted(const double* first, const Weights& weights);
  bool is_far(const Vec<Dim>& x) const;
  /// The tile whose inner nodes include a node; computed when it is needed first.
  const Tile& tile_around(const Cell<Dim>& cell) const;

  std::vector<WallFace<Dim>> pieces_;       ///< of the walls
  std::vector<WallFace<2>> edges_;          ///< of the outline, in plan
  std::unique_ptr<const Polygon> outline_;  ///< null for walls
  double depth_of_pieces_;                  ///< m
  Vec<Dim> period_;                         ///< m
  Box<Dim> bounds_;                         ///< m; places beyond count as the nearest ones within
  Box<Dim> box_;
  FaceGrid<Dim> near_;
  FaceGrid<2> near_edges_;
  double farthest_;                                        ///< m; distance outside at which the depth is limited
  double step_;                                            ///< m; between nodes
  mutable std::unordered_map<std::uint64_t, Tile> tiles_;  ///< m; depths at nodes, by the key of the tile
};

}  // namespace tailwater
