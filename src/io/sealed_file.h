// A file with a head that identifies it and a checksum that detects damage. The head is 512 bytes of text, which HDF5
// and its tools skip, so that a sealed HDF5 file is still valid for them:
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
  int ranks = 1;       ///< number of ranks of the run
  std::string body;
  std::filesystem::path path{};  ///< path from which it was read
};

/// Writes a file with this body and the data of `head`, whose own body is ignored, and returns when it is on the disk
/// (write_file.h). Throws IoError.
void write_sealed_file(const std::filesystem::path& path, const SealedFile& head, std::string_view body);

/// Throws IoError, which names the file, if it cannot be read or any bit of it has changed.
SealedFile read_sealed_file(const std::filesystem::path& path);

/// Reads the head alone, without a test of the checksum. Throws IoError.
SealedFile read_head_of_sealed_file(const std::filesystem::path& path);

}  // namespace tailwater
