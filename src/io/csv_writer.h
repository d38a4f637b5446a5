// A table that grows during the run. Every line reaches the file at once, so a killed run leaves whole lines.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tailwater {

class CsvWriter {
 public:
  /// Opens (and empties) `path` and writes the line of column names, which carry their units: "time_s", "depth_m".
  /// Throws IoError.
  CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns);

  /// Appends one line: a number per column, each with the fewest digits that read back as the same double.
  /// Throws IoError, also when the disk is full.
  void write(std::span<const double> row);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void write_line(const std::string& line);

  std::filesystem::path path_;
  std::size_t columns_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace tailwater
