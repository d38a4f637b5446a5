#pragma once

#include <vector>

namespace tailwater {

/// A point or vector as read from a file: as many numbers as there are dimensions.
using Coordinates = std::vector<double>;

}  // namespace tailwater
