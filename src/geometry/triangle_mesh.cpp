#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "geometry/point_grid.h"

namespace tailwater {
namespace {

struct HashOfPlace {
  std::size_t operator()(const Vec<3>& x) const {
    constexpr std::size_t multiplier = 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio: spreads the bits
    std::size_t hash = 0;
    for (const double coordinate : x) hash = hash * multiplier + std::hash<double>()(coordinate);
    return hash;
  }
};

/// Points that are the same to the last digit become one, at the place of the first; returns for each point its new
/// index.
std::vector<int> merge_equal(std::vector<Vec<3>>& points) {
  std::unordered_map<Vec<3>, int, HashOfPlace> index_of;
  std::vector<int> renamed(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [entry, is_new] = index_of.try_emplace(points[i], static_cast<int>(index_of.size()));
    renamed[i] = entry->second;
    if (is_new) points[entry->second] = points[i];
  }
  points.resize(index_of.size());
  points.shrink_to_fit();
  return renamed;
}

void rename_corners(TriangleMesh& mesh, const std::vector<int>& renamed) {
  for (std::array<int, 3>& triangle : mesh.triangles) {
    for (int& corner : triangle) corner = renamed[corner];
  }
}

}  // namespace

Vec<3> TriangleMesh::area_normal(int triangle) const {
  return (corner(triangle, 1) - corner(triangle, 0)).cross(corner(triangle, 2) - corner(triangle, 0));
}

std::vector<TriangleEdge> edges_of(const TriangleMesh& mesh) {
  // Filed by their lower ends, so that only the few edges of a point need be compared with each other.
  const auto low_end = [&](int t, int e) { return std::min(mesh.triangles[t][e], mesh.triangles[t][(e + 1) % 3]); };
  const int triangles = static_cast<int>(mesh.triangles.size());
  std::vector<std::size_t> end(mesh.points.size() + 1, 0);  // of each point's edges, when all are filed
  for (int t = 0; t < triangles; ++t) {
    for (int e = 0; e < 3; ++e) ++end[low_end(t, e) + 1];
  }
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<TriangleEdge> edges(3 * mesh.triangles.size());
  for (int t = 0; t < triangles; ++t) {
    for (int e = 0; e < 3; ++e) {
      const int from = mesh.triangles[t][e];
      const int to = mesh.triangles[t][(e + 1) % 3];
      edges[end[low_end(t, e)]++] = {std::min(from, to), std::max(from, to), t, e, from < to};
    }
  }
  std::size_t begin = 0;
  for (std::size_t p = 0; p < mesh.points.size(); begin = end[p++]) {
    std::sort(edges.begin() + static_cast<std::ptrdiff_t>(begin), edges.begin() + static_cast<std::ptrdiff_t>(end[p]),
              [](const TriangleEdge& a, const TriangleEdge& b) {
                return std::tie(a.high, a.triangle, a.number) < std::tie(b.high, b.triangle, b.number);
              });
  }
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
