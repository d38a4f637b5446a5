// A table that grows during the run. Every line reaches the file at once, so a killed run leaves whole lines.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tailwater {

class CsvWriter {
 public:
  /// Opens (and empties) `path` and writes the line of column names, which carry their units: "time_s", "depth_m". With
  /// `kept`, a former `size()`, continues the file instead and removes everything after these bytes. Throws IoError,
  /// also when the existing file is missing, too short or has other columns.
  CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns,
            std::optional<std::int64_t> kept = {});

  /// Appends one line: a number per column, each with the fewest digits that read back as the same double, or "nan".
  /// Throws IoError, also when the disk is full.
  void write(std::span<const double> row);

  /// Bytes written so far.
  std::int64_t size() const { return size_; }

  /// Throws IoError if the file is no longer at its place: everything written afterwards would be lost without a
  /// message.
  void require_in_place() const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void go_on(const std::string& first_line, std::int64_t kept);
  void write_line(const std::string& line);

  std::filesystem::path path_;
  std::size_t columns_;
  std::unique_ptr<std::FILE, Close> file_;
  std::int64_t size_ = 0;
};

/// Removes everything after the first `kept` bytes of a file that no process writes to. Throws IoError.
void cut_file(const std::filesystem::path& path, std::int64_t kept);

}  // namespace tailwater
