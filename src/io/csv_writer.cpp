#include "io/csv_writer.h"

#include <fmt/format.h>

#include <cerrno>

#include "base/assert.h"
#include "io/write_file.h"

namespace tailwater {

CsvWriter::CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns)
    : path_(path), columns_(columns.size()), file_(std::fopen(path.c_str(), "wb")) {
  if (!file_) {
    throw_io_error("write", path_, errno);
  }
  write_line(fmt::format("{}\n", fmt::join(columns, ",")));
}

void CsvWriter::write(std::span<const double> row) {
  TAILWATER_ASSERT(row.size() == columns_, "a CSV row has one number per column");
  write_line(fmt::format("{}\n", fmt::join(row, ",")));
}

void CsvWriter::write_line(const std::string& line) {
  if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size() || std::fflush(file_.get()) != 0) {
    throw_io_error("write", path_, errno);
  }
}

}  // namespace tailwater
