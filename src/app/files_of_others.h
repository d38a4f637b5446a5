// Files that a command would replace, and that may belong to another user.
#pragma once

#include <filesystem>

namespace tailwater {

/// Throws InputError if `path` has an obstacle that is not replaced: a link, a folder, a device, a pipe or another
/// user's file.
void require_own_regular_file(const std::filesystem::path& path);

/// Whether the file is a picture that `tailwater check` has drawn, according to its first bytes.
bool is_preview(const std::filesystem::path& path);

}  // namespace tailwater
