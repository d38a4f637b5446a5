// Which numbers a case and its files may have.
#pragma once

namespace tailwater {

/// No quantity of a flow is larger in SI units, and products of a few such numbers are still far from the largest
/// double.
inline constexpr double largest_number = 1e15;
/// Likewise for quantities that cannot be negative, unless they are 0.
inline constexpr double smallest_number = 1e-15;

}  // namespace tailwater
