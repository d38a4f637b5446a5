// Which side of a polygon's outline a point is on.
#pragma once

#include <vector>

#include "base/vec.h"

namespace tailwater {

enum class Where { outside, on_outline, inside };

/// Where `x` is relative to a polygon whose outline is `tolerance` thick, by the parity of the edges to its right.
Where where_in(const std::vector<Vec<2>>& corners, const Vec<2>& x, double tolerance);

}  // namespace tailwater
