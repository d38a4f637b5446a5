// What `tailwater check` does with a case before it makes a flow.
#pragma once

#include <filesystem>

namespace tailwater {

/// Reads a case file, and makes and checks its shapes if that takes few particles. Whatever it is refused for must tell
/// the place in the file.
void examine_case(const std::filesystem::path& file);

}  // namespace tailwater
