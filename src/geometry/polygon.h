// Which side of a polygon's outline a point is on.
#pragma once

#include <array>
#include <vector>

#include "base/vec.h"

namespace tailwater {

enum class Where { outside, on_outline, inside };

/// A polygon whose outline is `tolerance` [m] thick. Its edges are filed by height, so that a point is compared with
/// few of them.
class Polygon {
 public:
  Polygon() = default;
  Polygon(std::vector<Vec<2>> corners, double tolerance);

  const std::vector<Vec<2>>& corners() const { return corners_; }
  /// By the parity of the edges to its right. A polygon without corners holds nothing.
  Where where(const Vec<2>& x) const;

 private:
  std::vector<Vec<2>> corners_;
  double tolerance_ = 0.0;
  double low_ = 0.0;                     ///< m; height at which the first band begins
  double band_ = 1.0;                    ///< m; height of a band
  std::vector<std::vector<int>> edges_;  ///< of each band, by their second corner
};

/// Triangles that fill a polygon whose outline does not cross itself, by the indices of their corners.
std::vector<std::array<int, 3>> triangles_in(const std::vector<Vec<2>>& corners);

}  // namespace tailwater
