// Writes whole files: first under a temporary name beside the target, then renamed over it. A run killed at any moment
// leaves either the old file or the new one. Nothing is written through a link, and no link, device or pipe is
// replaced: what stands in the place of a file that we write may be someone else's.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "parallel/communicator.h"

namespace tailwater {

/// Ending of the temporary name; a killed run may leave one such file.
inline constexpr std::string_view temporary_ending = ".part";

/// Opens a regular file, which may not be there yet, with these flags of open(2) and returns its descriptor. Throws
/// IoError for a link, a device, a pipe or a folder, and where it cannot be opened.
int open_regular_file(const std::filesystem::path& path, int flags);

/// The one guard of files that are written: what has the place of the file `path` and is not replaced, as "a link", "a
/// folder", "a device or a pipe", or "another user's file"; empty if there is no such thing.
std::string_view obstacle_at(const std::filesystem::path& path);

/// Throws IoError if a link, a device, a pipe or a folder has the place of the file `path`. A folder may be shared:
/// other users' files in it are replaced.
void require_regular_or_none(const std::filesystem::path& path);

/// Writes `parts` one after the other as the file `path`. Collective: the parts of all ranks, by rank, make one file;
/// every rank writes its own parts (MPI-IO). Throws IoError with the path and the system's reason, on all ranks; an
/// existing file is then untouched.
void write_file(const std::filesystem::path& path, std::span<const std::string_view> parts,
                const Communicator& ranks = {});

/// The same by one rank alone, and lasting: a power cut does not take the file back once it has its name, nor what was
/// written to its file system before. Returns when the name lasts too.
void write_file_to_disk(const std::filesystem::path& path, std::span<const std::string_view> parts);

/// The same as the first for one text.
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// Writes `text` over the bytes of an existing file, which needs no further room on the disk if the file was as large.
/// Not for files that others read meanwhile. Returns whether it could.
bool overwrite_file(const std::filesystem::path& path, std::string_view text);

/// Throws IoError: "cannot WHAT 'path': the system's reason for `error_number`".
[[noreturn]] void throw_io_error(std::string_view what, const std::filesystem::path& path, int error_number);

/// Removes a file or an empty folder; one that is not there is no error. Throws IoError.
void remove_file(const std::filesystem::path& path);

}  // namespace tailwater
