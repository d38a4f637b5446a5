#include "geometry/polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/face.h"

namespace tailwater {

Polygon::Polygon(std::vector<Vec<2>> corners, double tolerance) : corners_(std::move(corners)), tolerance_(tolerance) {
  if (corners_.empty()) return;
  const auto [lowest, highest] = std::ranges::minmax(corners_, {}, [](const Vec<2>& x) { return x[1]; });
  const int count = static_cast<int>(corners_.size());
  low_ = lowest[1] - tolerance_;
  constexpr double beyond_rounding = 1.0 + 1e-9;
  band_ = beyond_rounding * (highest[1] + tolerance_ - low_) / count;
  if (!(band_ > 0.0)) band_ = 1.0;
  edges_.resize(count);
  const auto band_at = [&](double y) { return std::clamp(static_cast<int>((y - low_) / band_), 0, count - 1); };
  for (int i = 0, last = count - 1; i < count; last = i++) {
    const auto [low, high] = std::minmax(corners_[last][1], corners_[i][1]);
    // One more band on each side, as a margin for rounding.
    const int first = std::max(0, band_at(low - tolerance_) - 1);
    const int end = std::min(count - 1, band_at(high + tolerance_) + 1);
    for (int band = first; band <= end; ++band) edges_[band].push_back(i);
  }
}

Where Polygon::where(const Vec<2>& x) const {
  const double band = std::floor((x[1] - low_) / band_);
  if (!(band >= 0.0 && band < static_cast<double>(edges_.size()))) return Where::outside;
  bool is_inside = false;
  for (const int i : edges_[static_cast<std::size_t>(band)]) {
    const Vec<2>& a = corners_[i == 0 ? corners_.size() - 1 : i - 1];
    const Vec<2>& b = corners_[i];
    if ((x - closest_point(WallFace<2>{{a, b}, Vec<2>::Zero()}, x)).norm() <= tolerance_) return Where::on_outline;
    if ((a[1] > x[1]) != (b[1] > x[1]) && x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) {
      is_inside = !is_inside;
    }
  }
  return is_inside ? Where::inside : Where::outside;
}

namespace {

/// Twice the area of a triangle, positive if its corners run counter-clockwise.
double turn(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

}  // namespace

std::vector<std::array<int, 3>> triangles_in(const std::vector<Vec<2>>& corners) {
  std::vector<int> left(corners.size());
  std::iota(left.begin(), left.end(), 0);
  double area = 0.0;
  for (std::size_t k = 2; k < corners.size(); ++k) area += turn(corners[0], corners[k - 1], corners[k]);
  if (area < 0.0) std::ranges::reverse(left);
  std::vector<std::array<int, 3>> triangles;
  while (left.size() >= 3) {  // cuts off one ear after the other
    const std::size_t count = left.size();
    std::size_t ear = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::array<int, 3> t{left[(k + count - 1) % count], left[k], left[(k + 1) % count]};
      const auto holds = [&](int other) {
        const Vec<2>& x = corners[other];
        return other != t[0] && other != t[1] && other != t[2] && turn(corners[t[0]], corners[t[1]], x) >= 0.0 &&
               turn(corners[t[1]], corners[t[2]], x) >= 0.0 && turn(corners[t[2]], corners[t[0]], x) >= 0.0;
      };
      if (turn(corners[t[0]], corners[t[1]], corners[t[2]]) < 0.0 || std::ranges::any_of(left, holds)) continue;
      ear = k;
      break;
    }
    triangles.push_back({left[(ear + count - 1) % count], left[ear], left[(ear + 1) % count]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

}  // namespace tailwater
