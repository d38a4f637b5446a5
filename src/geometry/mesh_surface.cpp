#include "geometry/mesh_surface.h"

#include <unsupported/Eigen/BVH>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/box.h"
#include "base/eigen.h"

namespace tailwater {
namespace {

using AxisBox = Box<3>;

AxisBox box_of(const TriangleMesh& mesh, int triangle) {
  AxisBox box;
  for (int c = 0; c < 3; ++c) box.extend(mesh.corner(triangle, c));
  return box;
}

/// Whether a path meets a box.
AxisBox box_of(const Eigen::AlignedBox3d& box) {
  return {Vec<3>::Map(box.min().data()), Vec<3>::Map(box.max().data())};
}

bool meets(const AxisBox& box, const Vec<3>& from, const Vec<3>& to) {
  double begin = 0.0;
  double end = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = to[axis] - from[axis];
    if (length == 0.0) {
      if (from[axis] < box.min()[axis] || from[axis] > box.max()[axis]) return false;
      continue;
    }
    const double at_low = (box.min()[axis] - from[axis]) / length;
    const double at_high = (box.max()[axis] - from[axis]) / length;
    begin = std::max(begin, std::min(at_low, at_high));
    end = std::min(end, std::max(at_low, at_high));
  }
  return begin <= end;
}

}  // namespace

std::vector<Vec<3>> normals_at(const TriangleMesh& mesh, const SurfacePlace& place) {
  constexpr double same_normal = 0.996;  // cosine of 5 degrees
  std::vector<Vec<3>> normals;
  for (const int t : place.triangles) {
    const Vec<3> normal = mesh.area_normal(t).normalized();
    if (std::ranges::none_of(normals, [&](const Vec<3>& n) { return n.dot(normal) > same_normal; })) {
      normals.push_back(normal);
    }
  }
  return normals;
}

/// Eigen's hierarchy of boxes, walked here depth first, the nearer branch first.
struct MeshSurface::Tree {
  using Hierarchy = Eigen::KdBVH<double, 3, int>;
  Hierarchy boxes;

  explicit Tree(const TriangleMesh& mesh) {
    std::vector<int> triangles(mesh.triangles.size());
    std::vector<Eigen::AlignedBox3d> around(mesh.triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      triangles[t] = static_cast<int>(t);
      const AxisBox box = box_of(mesh, static_cast<int>(t));
      around[t] = {to_eigen(box.min()), to_eigen(box.max())};
    }
    boxes.init(triangles.begin(), triangles.end(), around.begin(), around.end());
  }

  /// Calls visit(triangle) for the triangles in the branches with `order(box)` up to `limit()`, the smaller of two
  /// sibling branches first. The limit may decrease meanwhile, which excludes branches with a larger order.
  template <class Order, class Limit, class Visit>
  void walk(Order&& order, Limit&& limit, Visit&& visit) const {
    // A single triangle has no box of its own: its root is -1, of which the triangle is the child.
    std::vector<std::pair<double, int>> waiting{{0.0, boxes.getRootIndex()}};
    while (!waiting.empty()) {
      const auto [rank, node] = waiting.back();
      waiting.pop_back();
      if (rank > limit()) continue;
      Hierarchy::VolumeIterator branch = nullptr, last_branch = nullptr;  // set for those that there are
      Hierarchy::ObjectIterator triangle = nullptr, last_triangle = nullptr;
      boxes.getChildren(node, branch, last_branch, triangle, last_triangle);
      for (; triangle != last_triangle; ++triangle) visit(*triangle);
      const std::size_t before = waiting.size();
      for (; branch != last_branch; ++branch) waiting.emplace_back(order(box_of(boxes.getVolume(*branch))), *branch);
      if (waiting.size() == before + 2 && waiting[before].first < waiting[before + 1].first) {
        std::swap(waiting[before], waiting[before + 1]);
      }
    }
  }
};

MeshSurface::MeshSurface(TriangleMesh mesh)
    : mesh_(std::move(mesh)), neighbours_(mesh_.triangles.size(), {-1, -1, -1}) {
  const std::vector<TriangleEdge> edges = edges_of(mesh_);
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (k + 1 < edges.size() && edges[k].is_between_same_points(edges[k + 1])) {
      neighbours_[edges[k].triangle][edges[k].number] = edges[k + 1].triangle;
      neighbours_[edges[k + 1].triangle][edges[k + 1].number] = edges[k].triangle;
      ++k;
    } else {
      is_closed_ = false;
    }
  }
  point_normals_.assign(mesh_.points.size(), Vec<3>::Zero());
  AxisBox box;
  for (int t = 0; t < static_cast<int>(mesh_.triangles.size()); ++t) {
    const Vec<3> normal = mesh_.area_normal(t).normalized();
    for (int c = 0; c < 3; ++c) {
      const Vec<3> one = (mesh_.corner(t, (c + 1) % 3) - mesh_.corner(t, c)).normalized();
      const Vec<3> other = (mesh_.corner(t, (c + 2) % 3) - mesh_.corner(t, c)).normalized();
      point_normals_[mesh_.triangles[t][c]] += std::atan2(one.cross(other).norm(), one.dot(other)) * normal;
      box.extend(mesh_.corner(t, c));
    }
  }
  low_ = box.min();
  high_ = box.max();
  tree_ = std::make_unique<Tree>(mesh_);
}

MeshSurface::~MeshSurface() = default;

void MeshSurface::look_around_corner(int triangle, int corner, SurfacePlace& place) const {
  const int point = mesh_.triangles[triangle][corner];
  const auto number_in = [&](int t) {
    return static_cast<int>(std::find(mesh_.triangles[t].begin(), mesh_.triangles[t].end(), point) -
                            mesh_.triangles[t].begin());
  };
  place.triangles = {triangle};
  // Across the edges that end in the point; from a rim back to the start and on across those that begin there.
  for (const int edge : {2, 0}) {
    for (int t = triangle;;) {
      t = neighbours_[t][(number_in(t) + edge) % 3];
      if (t == triangle) return;
      if (t < 0) break;
      place.triangles.push_back(t);
    }
  }
  place.is_on_rim = true;
}

SurfacePlace MeshSurface::nearest(const Vec<3>& x, double search_distance) const {
  double least = search_distance * search_distance;
  int triangle = -1;
  Foot foot;
  tree_->walk([&](const AxisBox& box) { return box.squaredExteriorDistance(x); }, [&] { return least; },
              [&](int t) {
                const Foot here = closest_feature(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2), x);
                const double distance = (x - here.point).squaredNorm();
                if (distance > least || (triangle >= 0 && distance == least)) return;
                least = distance;
                triangle = t;
                foot = here;
              });
  if (triangle < 0) return {};
  SurfacePlace place{.triangle = triangle, .point = foot.point};
  Vec<3> normal = mesh_.area_normal(triangle);
  if (foot.is_corner()) {
    normal = point_normals_[mesh_.triangles[triangle][foot.number()]];
    look_around_corner(triangle, foot.number(), place);
  } else {
    place.triangles = {triangle};
    const int beyond = foot.is_edge() ? neighbours_[triangle][foot.number()] : -1;
    place.is_on_rim = foot.is_edge() && beyond < 0;
    if (beyond >= 0) {
      normal = normal.normalized() + mesh_.area_normal(beyond).normalized();
      place.triangles.push_back(beyond);
    }
  }
  const bool is_behind = normal.dot(x - foot.point) < 0.0;
  place.signed_distance = is_behind ? -std::sqrt(least) : std::sqrt(least);
  double clearest = -std::numeric_limits<double>::infinity();
  for (const int t : place.triangles) {
    const double height = mesh_.area_normal(t).normalized().dot(x - foot.point) * (is_behind ? -1.0 : 1.0);
    if (height > clearest) {
      clearest = height;
      place.triangle = t;
    }
  }
  return place;
}

int MeshSurface::first_crossed(const Vec<3>& from, const Vec<3>& to, double tolerance) const {
  int first = -1;
  double least = std::numeric_limits<double>::infinity();
  const Vec<3> margin = Vec<3>::Constant(tolerance);
  tree_->walk(
      [&](const AxisBox& box) {
        return meets({Vec<3>(box.min() - margin), Vec<3>(box.max() + margin)}, from, to) ? 0.0 : 1.0;
      },
      [] { return 0.5; },
      [&](int t) {
        const WallFace<3> face = face_of(mesh_, t);
        if (!crosses(face, from, to, tolerance)) return;
        const double distance = (meet(face, from, to) - from).norm();
        if (distance < least) {
          least = distance;
          first = t;
        }
      });
  return first;
}

void MeshSurface::find_in(const Vec<3>& low, const Vec<3>& high, std::vector<int>& found) const {
  const AxisBox wanted(low, high);
  tree_->walk([&](const AxisBox& box) { return box.intersects(wanted) ? 0.0 : 1.0; }, [] { return 0.5; },
              [&](int t) {
                if (box_of(mesh_, t).intersects(wanted)) found.push_back(t);
              });
}

}  // namespace tailwater
