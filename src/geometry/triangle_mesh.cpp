#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "geometry/point_grid.h"

namespace tailwater {
namespace {

/// Points that are the same to the last digit become one; returns for each point its new index.
std::vector<int> merge_equal(std::vector<Vec<3>>& points) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) { return std::tuple(points[i][0], points[i][1], points[i][2]); };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  // The first of each group keeps its place in the order of the file.
  std::vector<int> first(points.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    first[order[k]] = k > 0 && points[order[k]] == points[order[k - 1]] ? first[order[k - 1]] : order[k];
  }
  std::vector<int> renamed(points.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (first[i] == static_cast<int>(i)) {
      renamed[i] = static_cast<int>(kept);
      points[kept++] = points[i];
    } else {
      renamed[i] = renamed[first[i]];
    }
  }
  points.resize(kept);
  return renamed;
}

void rename_corners(TriangleMesh& mesh, const std::vector<int>& renamed) {
  for (std::array<int, 3>& triangle : mesh.triangles) {
    for (int& corner : triangle) corner = renamed[corner];
  }
}

}  // namespace

std::vector<TriangleEdge> edges_of(const TriangleMesh& mesh) {
  std::vector<TriangleEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    for (int e = 0; e < 3; ++e) {
      const int from = mesh.triangles[t][e];
      const int to = mesh.triangles[t][(e + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), t, e, from < to});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const TriangleEdge& a, const TriangleEdge& b) {
    return std::tie(a.low, a.high, a.triangle, a.number) < std::tie(b.low, b.high, b.triangle, b.number);
  });
  return edges;
}

void weld(TriangleMesh& mesh, double tolerance) {
  rename_corners(mesh, merge_equal(mesh.points));
  // Only where edges have no neighbour may points have been torn apart by round-off.
  std::vector<bool> is_torn(mesh.points.size(), false);
  const std::vector<TriangleEdge> edges = edges_of(mesh);
  for (std::size_t k = 0; k < edges.size();) {
    std::size_t end = k + 1;
    while (end < edges.size() && edges[end].is_between_same_points(edges[k])) ++end;
    if (end == k + 1) is_torn[edges[k].low] = is_torn[edges[k].high] = true;
    k = end;
  }
  PointGrid<3> torn(tolerance);
  std::vector<int> torn_points;
  std::vector<int> renamed(mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    renamed[i] = static_cast<int>(i);
    if (!is_torn[i]) continue;
    int same = -1;
    torn.visit_near(mesh.points[i], [&](int k) { same = torn_points[k]; });
    if (same >= 0) {
      renamed[i] = same;
    } else {
      torn.add(mesh.points[i]);
      torn_points.push_back(static_cast<int>(i));
    }
  }
  rename_corners(mesh, renamed);
}

void turn_over(TriangleMesh& mesh) {
  for (std::array<int, 3>& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

}  // namespace tailwater
