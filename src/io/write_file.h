// Writes whole files: first under a temporary name beside the target, then renamed over it. A run killed at any moment
// leaves either the old file or the new one.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "parallel/communicator.h"

namespace tailwater {

/// Ending of the temporary name; a killed run may leave one such file.
inline constexpr std::string_view temporary_ending = ".part";

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
