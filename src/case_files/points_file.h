// A CSV file of points, as linked_files.h describes it.
#pragma once

#include <filesystem>
#include <istream>
#include <vector>

#include "case_files/coordinates.h"

namespace tailwater {

/// The points of `file`, whose name messages tell, in m. Throws InputError with file, line and remedy.
std::vector<Coordinates> parse_points(const std::filesystem::path& path, std::istream& file);

}  // namespace tailwater
