// The range of numbers in a case and its files.
#pragma once

namespace tailwater {

/// The largest magnitude of any quantity of a flow in SI units; products of a few such numbers are still far from the
/// largest double.
inline constexpr double largest_number = 1e15;
/// The smallest value of quantities that cannot be negative, unless they are 0.
inline constexpr double smallest_number = 1e-15;

}  // namespace tailwater
