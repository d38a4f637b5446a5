#include "io/csv_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <string_view>

#include "base/assert.h"
#include "base/error.h"
#include "io/write_file.h"

namespace tailwater {
namespace {

constexpr std::string_view remedy_for_other_file =
    "remedy: restore the file, or start the run again: tailwater run --force";

}  // namespace

CsvWriter::CsvWriter(const std::filesystem::path& path, const std::vector<std::string>& columns,
                     std::optional<std::int64_t> kept)
    : path_(path), columns_(columns.size()) {
  file_.reset(fdopen(open_regular_file(path_, kept ? O_RDWR : O_WRONLY | O_CREAT | O_TRUNC), kept ? "r+b" : "wb"));
  if (!file_) throw_io_error("write", path_, errno);
  const std::string first_line = fmt::format("{}\n", fmt::join(columns, ","));
  if (kept) {
    go_on(first_line, *kept);
  } else {
    write_line(first_line);
  }
}

void CsvWriter::go_on(const std::string& first_line, std::int64_t kept) {
  std::string found(first_line.size(), '\0');
  if (std::fread(found.data(), 1, found.size(), file_.get()) != found.size() || found != first_line) {
    throw IoError("cannot continue '{}': it does not begin with the columns of this run; {}", path_.string(),
                  remedy_for_other_file);
  }
  cut_file(path_, kept);
  if (std::fseek(file_.get(), 0, SEEK_END) != 0) throw_io_error("write", path_, errno);
  size_ = kept;
}

void CsvWriter::write(std::span<const double> row) {
  TAILWATER_ASSERT(row.size() == columns_, "a CSV row has one number per column");
  std::string line;
  for (const double number : row) {
    line += line.empty() ? "" : ",";
    line += std::isnan(number) ? "nan" : fmt::format("{}", number);  // {fmt} would compare it, which traps
  }
  write_line(line + "\n");
}

void CsvWriter::write_line(const std::string& line) {
  if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size() || std::fflush(file_.get()) != 0) {
    throw_io_error("write", path_, errno);
  }
  size_ += static_cast<std::int64_t>(line.size());
}

void CsvWriter::require_in_place() const {
  struct stat written {};
  struct stat found {};
  if (fstat(fileno(file_.get()), &written) != 0) throw_io_error("write", path_, errno);
  if (stat(path_.c_str(), &found) != 0) throw_io_error("write", path_, errno);
  if (written.st_dev != found.st_dev || written.st_ino != found.st_ino) {
    throw IoError("cannot write '{}': another file has taken its place", path_.string());
  }
}

void cut_file(const std::filesystem::path& path, std::int64_t kept) {
  require_regular_or_none(path);
  struct stat found {};
  if (stat(path.c_str(), &found) != 0) throw_io_error("read", path, errno);
  if (found.st_size < kept) {
    throw IoError("cannot continue '{}': it has {} bytes, and had {} at the checkpoint; {}", path.string(),
                  found.st_size, kept, remedy_for_other_file);
  }
  if (truncate(path.c_str(), kept) != 0) throw_io_error("write", path, errno);
}

}  // namespace tailwater
