// Files that a command is asked to replace, and that may be someone else's.
#pragma once

#include <filesystem>

namespace tailwater {

/// Throws InputError if `path` has an obstacle that is not replaced: a link, a folder, a device, a pipe or another
/// user's file.
void require_own_regular_file(const std::filesystem::path& path);

/// Whether the file is a picture that `tailwater check` has drawn: it says so at its begin.
bool is_preview(const std::filesystem::path& path);

}  // namespace tailwater
