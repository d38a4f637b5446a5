// Files that a command is asked to replace, and that may be someone else's.
#pragma once

#include <filesystem>

namespace tailwater {

/// Throws InputError unless the path is a regular file that belongs to this user: links, devices, pipes and what others
/// have written are not replaced.
void require_own_regular_file(const std::filesystem::path& path);

/// Whether the file is a picture that `tailwater check` has drawn: it says so at its begin.
bool is_preview(const std::filesystem::path& path);

}  // namespace tailwater
