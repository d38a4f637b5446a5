#include "refinement/zone_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/from_spec.h"

namespace tailwater {
namespace {

/// dx; distance from the border up to which depths are exact: kernels reach 3 dx, and the checks need 8.
constexpr double exact_beyond = 10.0;

/// dx; between the nodes at which depths are stored.
constexpr double nodes_apart = 0.5;

/// Whether an edge lies beyond one side of a box.
bool is_beyond(const Box<2>& bounds, const Vec<2>& from, const Vec<2>& to, double tolerance) {
  for (int axis = 0; axis < 2; ++axis) {
    if (std::max(from[axis], to[axis]) <= bounds.min()[axis] + tolerance) return true;
    if (std::min(from[axis], to[axis]) >= bounds.max()[axis] - tolerance) return true;
  }
  return false;
}

template <int Dim>
Vec<2> plan(const Vec<Dim>& x) {
  return {x[0], x[1]};
}

/// Stores a piece of walls or of an outline; returns the box around it.
template <int Dim>
Box<Dim> add_piece(const WallFace<Dim>& piece, std::vector<WallFace<Dim>>& pieces, FaceGrid<Dim>& near) {
  const Box<Dim> box = piece.box();
  near.add(static_cast<int>(pieces.size()), box.min(), box.max(),
           [&](const Vec<Dim>& x) { return (closest_point(piece, x) - x).norm(); });
  pieces.push_back(piece);
  return box;
}

/// m; at most the reach of the grid.
template <int Dim>
double distance_from(const std::vector<WallFace<Dim>>& pieces, const FaceGrid<Dim>& near, const Vec<Dim>& x) {
  double distance = near.reach();
  for (const int n : near.near(x)) distance = std::min(distance, (x - closest_point(pieces[n], x)).norm());
  return distance;
}

}  // namespace

template <int Dim>
ZoneDepth<Dim>::ZoneDepth(const RefinementTable& table, const Boundary<Dim>& boundary, const Box<Dim>& bounds,
                          const Vec<Dim>& period, double border, double spacing)
    : depth_of_pieces_(table.shape == ZoneShape::walls ? table.distance + border : 0.0),
      period_(period),
      bounds_(bounds),
      near_(border + table.distance + exact_beyond * spacing),
      near_edges_(near_.reach()),
      farthest_(exact_beyond * spacing),
      step_(nodes_apart * spacing) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < Dim; ++axis) {
    if (period[axis] == 0.0 && table.shape == ZoneShape::polygon) continue;
    bounds_.min()[axis] = -infinity;
    bounds_.max()[axis] = infinity;
  }
  if (table.shape == ZoneShape::walls) {
    add_walls(table, boundary);
  } else {
    add_outline(table, spacing);
  }
}

template <int Dim>
void ZoneDepth<Dim>::add_outline(const RefinementTable& table, double spacing) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const CaseLabel owner("refinement", table.name);
  const double tolerance = corner_tolerance * spacing;
  const Box<2> bounds(plan<Dim>(bounds_.min()), plan<Dim>(bounds_.max()));
  std::vector<Vec<2>> corners;
  Box<2> box;
  for (const Coordinates& point : table.points) {
    corners.push_back(to_vec<2>(point, owner, "points"));
    box.extend(corners.back());
  }
  for (std::size_t n = 0; n < corners.size(); ++n) {
    const Vec<2>& from = corners[n];
    const Vec<2>& to = corners[(n + 1) % corners.size()];
    if (!is_beyond(bounds, from, to, tolerance)) add_piece<2>({{from, to}, Vec<2>::Zero()}, edges_, near_edges_);
  }
  box_ = {Vec<Dim>::Constant(-infinity), Vec<Dim>::Constant(infinity)};
  for (int axis = 0; axis < 2; ++axis) {
    box_.min()[axis] = box.min()[axis];
    box_.max()[axis] = box.max()[axis];
    // A place on the outline of the walls is within: the polygon may end there.
    bounds_.min()[axis] += tolerance;
    bounds_.max()[axis] -= tolerance;
  }
  outline_ = std::make_unique<const Polygon>(std::move(corners), tolerance);
}

template <int Dim>
void ZoneDepth<Dim>::add_walls(const RefinementTable& table, const Boundary<Dim>& boundary) {
  for (const WallFace<Dim>& face : boundary.faces) {
    if (std::ranges::count(table.walls, boundary.walls[face.wall].name) == 0) continue;
    box_.extend(add_piece<Dim>(face, pieces_, near_));
  }
  box_.widen(depth_of_pieces_);
}

template <int Dim>
Vec<Dim> ZoneDepth<Dim>::in_plan(Vec<Dim> x) const {
  if constexpr (Dim == 3) {
    if (outline_ != nullptr) x[2] = 0.0;
  }
  return x;
}

template <int Dim>
double ZoneDepth<Dim>::depth_of_image(const Vec<Dim>& place) const {
  const Vec<Dim> x = place.cwiseMax(bounds_.min()).cwiseMin(bounds_.max());
  if (outline_ == nullptr) return depth_of_pieces_ - distance_from<Dim>(pieces_, near_, x);
  const double distance = distance_from<2>(edges_, near_edges_, plan<Dim>(x));
  return outline_->where(plan<Dim>(x)) != Where::outside ? distance : -distance;
}

template <int Dim>
double ZoneDepth<Dim>::exact_depth(const Vec<Dim>& x) const {
  double deepest = depth_of_image(x);
  for (int axis = 0; axis < Dim; ++axis) {
    if (period_[axis] == 0.0) continue;
    for (const double shift : {period_[axis], -period_[axis]}) {
      deepest = std::max(deepest, depth_of_image(x + shift * Vec<Dim>::Unit(axis)));
    }
  }
  return deepest;
}

template <int Dim>
bool ZoneDepth<Dim>::is_far(const Vec<Dim>& x) const {
  const Vec<Dim> inside = x.cwiseMax(bounds_.min()).cwiseMin(bounds_.max());
  double distance = box_.exteriorDistance(inside);
  for (int axis = 0; axis < Dim; ++axis) {
    for (const double shift : {period_[axis], -period_[axis]}) {
      distance = std::min(distance, box_.exteriorDistance(inside + shift * Vec<Dim>::Unit(axis)));
    }
  }
  return distance > farthest_ + 2.0 * step_;
}

template <int Dim>
const typename ZoneDepth<Dim>::Tile& ZoneDepth<Dim>::tile_around(const Cell<Dim>& cell) const {
  const auto [found, is_new] = tiles_.try_emplace(cell_key<Dim>(cell));
  Tile& tile = found->second;
  if (!is_new) return tile;
  const auto size = static_cast<std::size_t>(power<Dim>(tile_nodes));
  for (std::size_t n = 0; n < size; ++n) {
    Vec<Dim> x;
    std::size_t rest = n;
    for (int axis = 0; axis < Dim; ++axis, rest /= tile_nodes) {
      const auto first = static_cast<double>(cell[axis] * (tile_nodes - 2) - 1);
      x[axis] = step_ * (first + static_cast<double>(rest % tile_nodes));
    }
    tile.push_back(exact_depth(x));
  }
  return tile;
}

template <int Dim>
typename ZoneDepth<Dim>::Around ZoneDepth<Dim>::around(const Vec<Dim>& x) const {
  const Cell<Dim> tile = cell_of<Dim>(Vec<Dim>(x + Vec<Dim>::Constant(0.5 * step_)), (tile_nodes - 2) * step_);
  Around result{tile_around(tile).data(), Vec<Dim>::Zero()};
  std::ptrdiff_t stride = 1;
  for (int d = 0; d < Dim; ++d, stride *= tile_nodes) {
    // From the first node of the tile.
    const double place = x[d] / step_ - static_cast<double>(tile[d] * (tile_nodes - 2) - 1);
    const double node = std::clamp(std::floor(place + 0.5), 1.0, tile_nodes - 2.0);
    result.off[d] = place - node;
    result.first += stride * static_cast<std::ptrdiff_t>(node - 1.0);
  }
  return result;
}

template <int Dim>
typename ZoneDepth<Dim>::Weights ZoneDepth<Dim>::weights_at(const Vec<Dim>& off) {
  Weights weights;
  for (int d = 0; d < Dim; ++d) {
    weights[d] = {0.5 * (0.5 - off[d]) * (0.5 - off[d]), 0.75 - off[d] * off[d], 0.5 * (0.5 + off[d]) * (0.5 + off[d])};
  }
  return weights;
}

/// The sum over the 3^Dim nodes from the first one.
template <int Dim>
double ZoneDepth<Dim>::weighted(const double* first, const Weights& weights) {
  double sum = 0.0;
  for (int c = 0; c < (Dim == 3 ? 3 : 1); ++c) {
    for (int b = 0; b < 3; ++b) {
      const double* const row = first + tile_nodes * (b + tile_nodes * c);
      const double of_row = weights[0][0] * row[0] + weights[0][1] * row[1] + weights[0][2] * row[2];
      sum += weights[1][b] * (Dim == 3 ? weights[Dim - 1][c] : 1.0) * of_row;
    }
  }
  return sum;
}

template <int Dim>
double ZoneDepth<Dim>::depth(const Vec<Dim>& x) const {
  if (is_far(x)) return -farthest_;
  const Around nodes = around(in_plan(x));
  return weighted(nodes.first, weights_at(nodes.off));
}

template <int Dim>
typename ZoneDepth<Dim>::Depth ZoneDepth<Dim>::at(const Vec<Dim>& x) const {
  if (is_far(x)) return {-farthest_, Vec<Dim>::Zero()};
  const Around nodes = around(in_plan(x));
  const Weights weights = weights_at(nodes.off);
  Depth result{weighted(nodes.first, weights), Vec<Dim>::Zero()};
  for (int d = 0; d < Dim; ++d) {
    Weights changes = weights;
    changes[d] = {(nodes.off[d] - 0.5) / step_, -2.0 * nodes.off[d] / step_, (nodes.off[d] + 0.5) / step_};
    result.slope[d] = weighted(nodes.first, changes);
  }
  return result;
}

template class ZoneDepth<2>;
template class ZoneDepth<3>;

}  // namespace tailwater
