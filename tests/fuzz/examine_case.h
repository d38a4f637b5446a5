// The part of `tailwater check` before it makes a flow.
#pragma once

#include <filesystem>

namespace tailwater {

/// Reads a case file, and makes and checks its shapes if they have few particles. Every error message must name the
/// place in the file.
void examine_case(const std::filesystem::path& file);

}  // namespace tailwater
