// A file whose head says what it is and whose checksum shows damage. The head is 512 bytes of text, which HDF5 and its
// tools skip, so that a sealed HDF5 file is still one for them:
//
//     tailwater checkpoint, format 1
//     written by tailwater 1.0.0 (commit abc123)
//     ranks 2
//     bytes 123456
//     crc32 89abcdef
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tailwater {

struct SealedFile {
  int format = 0;      ///< version of the format of the body
  std::string writer;  ///< program that wrote it, with its version; one line
  int ranks = 1;       ///< of the run
  std::string body;
  std::filesystem::path path{};  ///< from which it was read
};

/// Writes a file of this body and what `head` says, whose own body does not count, and returns when it is on the disk
/// (write_file.h). Throws IoError.
void write_sealed_file(const std::filesystem::path& path, const SealedFile& head, std::string_view body);

/// Throws IoError, which names the file, if it cannot be read or differs in any bit from what was written.
SealedFile read_sealed_file(const std::filesystem::path& path);

/// The head alone, which is not compared with the checksum. Throws IoError.
SealedFile read_head_of_sealed_file(const std::filesystem::path& path);

}  // namespace tailwater
