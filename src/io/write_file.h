// Writes whole files: first under a temporary name beside the target, then renamed to the target. A run that is killed
// at any time leaves either the old file or the new one. The functions do not write through links, and do not replace
// links, devices or pipes, because these may belong to another user.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "parallel/communicator.h"

namespace tailwater {

/// Ending of the temporary name; a killed run may leave one such file.
inline constexpr std::string_view temporary_ending = ".part";

/// Opens a regular file, which need not exist yet, with these flags of open(2) and returns its descriptor. Throws
/// IoError for a link, a device, a pipe or a folder, and where it cannot be opened.
int open_regular_file(const std::filesystem::path& path, int flags);

/// The common test before files are written. Describes an object in the place of `path` that is not replaced, as "a
/// link", "a folder", "a device or a pipe", or "another user's file". Empty if there is no such object.
std::string_view obstacle_at(const std::filesystem::path& path);

/// Throws IoError if there is a link, a device, a pipe or a folder in the place of the file `path`. A folder may be
/// shared: other users' files in it are replaced.
void require_regular_or_none(const std::filesystem::path& path);

/// Writes `parts` one after the other as the file `path`. Collective: the parts of all ranks, by rank, make one file;
/// every rank writes its own parts (MPI-IO). Throws IoError with the path and the system's reason, on all ranks; an
/// existing file is then untouched.
void write_file(const std::filesystem::path& path, std::span<const std::string_view> parts,
                const Communicator& ranks = {});

/// Writes the file by one rank alone, and durably: a power failure after the rename removes neither the file nor
/// earlier writes to its file system. Returns when the name is on the disk too.
void write_file_to_disk(const std::filesystem::path& path, std::span<const std::string_view> parts);

/// Writes one text as the file `path`, like write_file.
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// Writes `text` over the bytes of an existing file, which needs no further space on the disk if the file was as large.
/// Not for files that others read at the same time. Returns whether it succeeded.
bool overwrite_file(const std::filesystem::path& path, std::string_view text);

/// Throws IoError: "cannot WHAT 'path': the system's reason for `error_number`".
[[noreturn]] void throw_io_error(std::string_view what, const std::filesystem::path& path, int error_number);

/// Removes a file or an empty folder; one that is not there is no error. Throws IoError.
void remove_file(const std::filesystem::path& path);

}  // namespace tailwater
