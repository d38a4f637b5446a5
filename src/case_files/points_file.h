// A CSV file of points, as described in linked_files.h.
#pragma once

#include <filesystem>
#include <istream>
#include <vector>

#include "case_files/coordinates.h"

namespace tailwater {

/// The points of `file`, whose name is used in messages, in m. Throws InputError with file, line and remedy.
std::vector<Coordinates> parse_points(const std::filesystem::path& path, std::istream& file);

}  // namespace tailwater
