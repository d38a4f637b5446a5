#include "geometry/polygon.h"

#include "geometry/boundary.h"

namespace tailwater {

Where where_in(const std::vector<Vec<2>>& corners, const Vec<2>& x, double tolerance) {
  bool is_inside = false;
  for (std::size_t i = 0, last = corners.size() - 1; i < corners.size(); last = i++) {
    const Vec<2>& a = corners[last];
    const Vec<2>& b = corners[i];
    if ((x - closest_point(WallFace<2>{{a, b}, Vec<2>::Zero()}, x)).norm() <= tolerance) {
      return Where::on_outline;
    }
    if ((a[1] > x[1]) != (b[1] > x[1]) && x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) {
      is_inside = !is_inside;
    }
  }
  return is_inside ? Where::inside : Where::outside;
}

}  // namespace tailwater
