// The largest tension that walls can hold.
#pragma once

namespace tailwater {

/// Pa; the pressure of the atmosphere. Below it by this much cold water boils.
inline constexpr double largest_tension = 1e5;

}  // namespace tailwater
