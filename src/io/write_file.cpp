#include "io/write_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "base/error.h"

namespace tailwater {

namespace {

/// 0, or the errno of the first call that failed.
int write_parts(const std::filesystem::path& path, std::span<const std::string_view> parts) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) {
    return errno;
  }
  int error_number = 0;
  for (const std::string_view part : parts) {
    if (error_number == 0 && std::fwrite(part.data(), 1, part.size(), file) != part.size()) {
      error_number = errno;
    }
  }
  // A full disk often shows only when the last buffer is written or the file is closed.
  if (std::fclose(file) != 0 && error_number == 0) {
    error_number = errno;
  }
  return error_number;
}

}  // namespace

void throw_io_error(std::string_view what, const std::filesystem::path& path, int error_number) {
  throw IoError(fmt::format("cannot {} '{}': {}", what, path.string(), std::generic_category().message(error_number)));
}

void write_file(const std::filesystem::path& path, std::span<const std::string_view> parts) {
  std::filesystem::path temporary = path;
  temporary += temporary_ending;
  int error_number = write_parts(temporary, parts);
  if (error_number == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) {
    error_number = errno;
  }
  if (error_number != 0) {
    std::remove(temporary.c_str());
    throw_io_error("write", path, error_number);
  }
}

void write_text_file(const std::filesystem::path& path, std::string_view text) { write_file(path, {&text, 1}); }

}  // namespace tailwater
