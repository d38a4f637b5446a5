// The common guard of files that are read. A folder, a device or a pipe may never end or never give a byte. A file may
// be larger than any valid file of its kind.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <istream>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>

#include "base/error.h"

namespace tailwater {

struct InputFileKind {
  std::string_view name = "a file";                                     ///< with its article
  std::uintmax_t largest = std::numeric_limits<std::uintmax_t>::max();  ///< bytes
  std::string_view remedy_for_size = "give fewer points, samples or triangles";
};

/// An open regular file, or one that leads there. Throws IoError for a folder, a device or a pipe, InputError for too
/// large a file. If there is no file, or it cannot be read, the stream has failed and errno has the reason.
inline std::ifstream open_input_file(const std::filesystem::path& path, const InputFileKind& kind = {}) {
  std::error_code error;  // the caller reports a missing file
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) {
    throw IoError("{}: is a folder; give {} in it", path.string(), kind.name);
  }
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw IoError("{}: is a device or a pipe; give {}", path.string(), kind.name);
  }
  if (const std::uintmax_t size = std::filesystem::file_size(path, error); !error && size > kind.largest) {
    throw InputError("{}: has {} bytes, and {} has at most {}; {}", path.string(), size, kind.name, kind.largest,
                     kind.remedy_for_size);
  }
  return std::ifstream(path, std::ios::binary);
}

/// All bytes of a stream, but at most `most` + 1, in case it never ends.
inline std::string read_bytes(std::istream& stream, std::uintmax_t most) {
  constexpr std::uintmax_t block = 1 << 16;
  std::string bytes;
  while (stream && bytes.size() <= most) {
    const std::size_t before = bytes.size();
    bytes.resize(before + std::min(block, most + 1 - before));
    stream.read(bytes.data() + before, static_cast<std::streamsize>(bytes.size() - before));
    bytes.resize(before + static_cast<std::size_t>(stream.gcount()));
  }
  return bytes;
}

}  // namespace tailwater
