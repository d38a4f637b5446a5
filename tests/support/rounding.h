// Rounding errors by the type of number.
#pragma once

#include <limits>

namespace tailwater {

inline constexpr double eps = std::numeric_limits<double>::epsilon();
inline constexpr double single_eps = std::numeric_limits<float>::epsilon();

}  // namespace tailwater
