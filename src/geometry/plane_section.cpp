#include "geometry/plane_section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "base/box.h"
#include "geometry/polygon.h"

namespace tailwater {
namespace {

/// dx; the plane is moved inside by this much, off the corners of meshes that end or have a row of triangles there.
constexpr double off_corners = 1e-4;
constexpr double same_place = 1e-3;  // dx; ends of pieces that are nearer are one corner

using Piece = std::pair<Vec<2>, Vec<2>>;

/// Where a plane cuts a triangle.
std::optional<std::pair<Vec<3>, Vec<3>>> cut(const WallFace<3>& face, const Vec<3>& on_plane, const Vec<3>& normal) {
  std::vector<Vec<3>> ends;
  for (int c = 0; c < 3; ++c) {
    const Vec<3>& a = face.corners[c];
    const Vec<3>& b = face.corners[(c + 1) % 3];
    const double from = normal.dot(a - on_plane);
    const double to = normal.dot(b - on_plane);
    if ((from > 0.0) != (to > 0.0)) ends.push_back(a + from / (from - to) * (b - a));
  }
  if (ends.size() != 2) return std::nullopt;
  return std::pair{ends[0], ends[1]};
}

double cross(const Vec<2>& a, const Vec<2>& b) { return a[0] * b[1] - a[1] * b[0]; }

/// The lines of a drawing in a plane as a graph: corners, and from each the corners that pieces lead to.
class Drawing2D {
 public:
  Drawing2D(const std::vector<Piece>& pieces, double tolerance) : tolerance_(tolerance) {
    for (std::size_t i = 0; i < pieces.size(); ++i) add_divided(pieces, i);
  }

  /// The corners around the point, on the left as one walks along them; none if no line is below it.
  std::vector<Vec<2>> around(const Vec<2>& point) const {
    const std::optional<std::pair<int, int>> first = line_below(point);
    if (!first) return {};
    std::vector<int> way;
    auto [from, to] = *first;
    do {
      way.push_back(from);
      const int next = next_corner(from, to);
      from = std::exchange(to, next);
    } while (std::pair{from, to} != *first && way.size() <= 4 * corners_.size());
    return without_spurs(way);
  }

 private:
  int corner_at(const Vec<2>& x) {
    const auto found = std::ranges::find_if(corners_, [&](const Vec<2>& c) { return (c - x).norm() <= tolerance_; });
    if (found != corners_.end()) return static_cast<int>(found - corners_.begin());
    corners_.push_back(x);
    next_.emplace_back();
    return static_cast<int>(corners_.size()) - 1;
  }

  /// Adds a piece, divided where others cross or touch it.
  void add_divided(const std::vector<Piece>& pieces, std::size_t i) {
    const auto& [a, b] = pieces[i];
    const Vec<2> along = b - a;
    std::vector<double> shares{0.0, 1.0};
    const Box<2> box = Box<2>(a.cwiseMin(b), a.cwiseMax(b)).widen(tolerance_);
    for (std::size_t j = 0; j < pieces.size(); ++j) {
      const auto& [c, d] = pieces[j];
      if (j == i || !box.intersects(Box<2>(c.cwiseMin(d), c.cwiseMax(d)))) {
        continue;
      }
      for (const Vec<2>& end : {c, d}) {
        const double share = along.dot(end - a) / along.squaredNorm();
        if ((a + share * along - end).norm() <= tolerance_) shares.push_back(share);
      }
      const double across = cross(along, d - c);
      if (across == 0.0) continue;
      const double share = cross(c - a, d - c) / across;
      const double other = cross(c - a, along) / across;
      if (other >= 0.0 && other <= 1.0) shares.push_back(share);
    }
    std::ranges::sort(shares);
    int last = -1;
    for (const double share : shares) {
      if (share < 0.0 || share > 1.0) continue;
      const int corner = corner_at(a + share * along);
      if (last >= 0 && corner != last) join(last, corner);
      last = corner;
    }
  }

  void join(int a, int b) {
    if (std::ranges::find(next_[a], b) != next_[a].end()) return;
    next_[a].push_back(b);
    next_[b].push_back(a);
  }

  /// The line next below a point, in the direction that has the point on its left.
  std::optional<std::pair<int, int>> line_below(const Vec<2>& point) const {
    std::optional<std::pair<int, int>> found;
    double highest = -std::numeric_limits<double>::infinity();
    for (int from = 0; from < static_cast<int>(corners_.size()); ++from) {
      for (const int to : next_[from]) {
        const Vec<2>& a = corners_[from];
        const Vec<2>& b = corners_[to];
        if (!(a[0] <= point[0] && point[0] < b[0])) continue;
        const double height = a[1] + (point[0] - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
        if (height >= point[1] || height <= highest) continue;
        highest = height;
        found = {from, to};
      }
    }
    return found;
  }

  /// Next corner of a path that arrives at `at` from `from`: the leftmost one.
  int next_corner(int from, int at) const {
    const Vec<2> back = corners_[from] - corners_[at];
    int best = from;
    double least = 2.0 * std::numbers::pi;
    for (const int to : next_[at]) {
      if (to == from) continue;
      const Vec<2> on = corners_[to] - corners_[at];
      const double right = std::atan2(cross(on, back), on.dot(back));  // from `on` to `back`, counter-clockwise
      const double angle = right > 0.0 ? right : right + 2.0 * std::numbers::pi;
      if (angle < least) {
        least = angle;
        best = to;
      }
    }
    return best;
  }

  /// Without lines that the way follows to their end and back.
  std::vector<Vec<2>> without_spurs(const std::vector<int>& way) const {
    std::vector<int> kept;
    for (const int corner : way) {
      if (kept.size() >= 2 && kept[kept.size() - 2] == corner) {
        kept.pop_back();
      } else if (kept.empty() || kept.back() != corner) {
        kept.push_back(corner);
      }
    }
    while (kept.size() >= 3 && (kept[1] == kept.back() || kept[0] == kept.back())) {
      if (kept[1] == kept.back()) kept.erase(kept.begin());
      kept.pop_back();
    }
    std::vector<Vec<2>> corners;
    for (const int corner : kept) corners.push_back(corners_[corner]);
    return corners;
  }

  double tolerance_;
  std::vector<Vec<2>> corners_;
  std::vector<std::vector<int>> next_;
};

}  // namespace

std::vector<Vec<3>> section_around(const Boundary<3>& boundary, const Vec<3>& point, const Vec<3>& normal,
                                   const Vec<3>& up, double spacing) {
  const Vec<3> aside = up.cross(normal);
  const Vec<3> on_plane = point - off_corners * spacing * normal;
  std::vector<Piece> pieces;
  const auto flat = [&](const Vec<3>& x) { return Vec<2>(aside.dot(x - point), up.dot(x - point)); };
  double widest = spacing;
  for (const WallFace<3>& face : boundary.faces) {
    const auto ends = cut(face, on_plane, normal);
    if (!ends || (ends->second - ends->first).norm() <= same_place * spacing) continue;
    pieces.emplace_back(flat(ends->first), flat(ends->second));
    widest = std::max({widest, std::abs(pieces.back().first[0]), std::abs(pieces.back().second[0])});
  }
  for (const bool has_lid : {false, true}) {
    if (has_lid) pieces.emplace_back(Vec<2>(-2.0 * widest, 0.0), Vec<2>(2.0 * widest, 0.0));
    // The point itself is on the lid.
    const Vec<2> inside(0.0, has_lid ? -2.0 * same_place * spacing : 0.0);
    const std::vector<Vec<2>> corners = Drawing2D(pieces, same_place * spacing).around(inside);
    if (corners.size() < 3 || Polygon(corners, 0.0).where(inside) != Where::inside) continue;
    std::vector<Vec<3>> section;
    for (const Vec<2>& x : corners) section.push_back(point + x[0] * aside + x[1] * up);
    return section;
  }
  return {};
}

}  // namespace tailwater
