// The speed up to which water counts as incompressible.
#pragma once

namespace tailwater {

/// m/s; a tenth of the speed of sound in water. Water, walls and bodies of a case are not faster.
inline constexpr double largest_speed_of_case = 150.0;

}  // namespace tailwater
