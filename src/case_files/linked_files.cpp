#include "case_files/linked_files.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cerrno>
#include <cstdint>
#include <fstream>
#include <system_error>

#include "base/error.h"
#include "base/input_file.h"
#include "case_files/mesh_file.h"
#include "case_files/points_file.h"

namespace tailwater {
namespace {

/// bytes; 1600 for each of the points that a file may have, and read in an instant
constexpr std::uintmax_t largest_points_file = std::uintmax_t{1} << 24;
/// bytes; 64 for each of the samples
constexpr std::uintmax_t largest_series_file = std::uintmax_t{1} << 26;

std::ifstream open_file(const std::filesystem::path& path, std::uintmax_t largest) {
  std::ifstream file = open_input_file(path, {.largest = largest});
  if (!file) {
    throw IoError("{}: cannot read it ({}); check the name, which is relative to the case file", path.string(),
                  std::generic_category().message(errno));
  }
  return file;
}

}  // namespace

std::vector<Coordinates> read_points_file(const std::filesystem::path& path) {
  std::ifstream file = open_file(path, largest_points_file);
  return parse_points(path, file);
}

TimeSeries read_time_series(const std::filesystem::path& path, std::span<const SeriesColumn> columns) {
  std::ifstream file = open_file(path, largest_series_file);
  return parse_series(path, file, columns);
}

TimeSeries read_measured_series(const std::filesystem::path& path, std::span<const std::string_view> names,
                                Measure measure, Samples samples) {
  std::ifstream file = open_file(path, largest_series_file);
  return parse_measured_series(path, file, names, measure, samples);
}

std::string checksum_of_file(const std::filesystem::path& path) {
  std::ifstream file = open_file(path, largest_mesh_file);
  std::vector<char> block(1 << 20);
  uLong sum = crc32(0, nullptr, 0);
  do {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    sum = crc32(sum, reinterpret_cast<const Bytef*>(block.data()), static_cast<uInt>(file.gcount()));
  } while (file);
  return fmt::format("{:08x}", sum);
}

}  // namespace tailwater
