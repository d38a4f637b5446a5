// Pictures that the program makes by itself; the Python package draws them.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "geometry/boundary.h"
#include "parallel/communicator.h"

namespace tailwater {

/// Draws `count` pictures of a run that has ended. Without Python, VTK or Xvfb there is a warning instead, because the
/// results of the run are complete. Only the root draws.
void draw_pictures(const std::filesystem::path& run, int count, const Communicator& ranks);

/// Draws walls, water of the given spacing (m) and places marked in red, in perspective, into the PNG file `image`.
/// Throws IoError if this fails.
void draw_start(const std::filesystem::path& image, const std::string& title, double spacing,
                const Boundary<3>& boundary, std::span<const Vec<3>> water, std::span<const Vec<3>> marks);

}  // namespace tailwater
