#include "io/write_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include "base/error.h"
#include "parallel/together.h"

namespace tailwater {

namespace {

constexpr std::string_view foreign_file = "another user's file";

/// Whether a file must survive a power failure.
enum class Lasting { as_the_system_likes, on_disk };

/// Returns 0, or the errno of the first call that failed. The file is new: one that a killed run has left is removed
/// first.
int write_parts(const std::filesystem::path& path, std::span<const std::string_view> parts,
                Lasting lasting = Lasting::as_the_system_likes) {
  require_regular_or_none(path);
  if (unlink(path.c_str()) != 0 && errno != ENOENT) return errno;
  const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor < 0) return errno;
  std::FILE* file = fdopen(descriptor, "wb");
  if (file == nullptr) {
    close(descriptor);
    return ENOMEM;
  }
  int error_number = 0;
  for (const std::string_view part : parts) {
    if (error_number == 0 && std::fwrite(part.data(), 1, part.size(), file) != part.size()) error_number = errno;
  }
  if (error_number == 0 && lasting == Lasting::on_disk && (std::fflush(file) != 0 || syncfs(fileno(file)) != 0)) {
    error_number = errno;
  }
  // A full disk often shows only when the last buffer is written or the file is closed.
  if (std::fclose(file) != 0 && error_number == 0) error_number = errno;
  return error_number;
}

/// Maximum number of bytes in one call of MPI-IO, whose counts are ints.
constexpr std::size_t largest_write = std::size_t{1} << 30;

/// MPI's message for `code`; empty for success.
std::string reason_of(int code) {
  if (code == MPI_SUCCESS) return "";
  char reason[MPI_MAX_ERROR_STRING] = {};
  int length = 0;
  MPI_Error_string(code, reason, &length);
  return reason;
}

/// Returns the reason of a failure, or an empty text. Not a collective MPI call: the bytes of a rank are contiguous,
/// and Open MPI's collective calls do not report a full disk.
std::string write_parts(MPI_File file, std::int64_t offset, std::span<const std::string_view> parts) {
  for (std::string_view rest : parts) {
    while (!rest.empty()) {
      const int count = static_cast<int>(std::min(rest.size(), largest_write));
      MPI_Status status;
      const int code = MPI_File_write_at(file, offset, rest.data(), count, MPI_BYTE, &status);
      if (code != MPI_SUCCESS) return reason_of(code);
      int written = 0;
      MPI_Get_count(&status, MPI_BYTE, &written);
      if (written != count) return "the disk may be full";
      offset += count;
      rest.remove_prefix(static_cast<std::size_t>(count));
    }
  }
  return "";
}

void write_file_together(const std::filesystem::path& path, std::span<const std::string_view> parts,
                         const Communicator& ranks) {
  std::filesystem::path temporary = path;
  temporary += temporary_ending;
  std::int64_t size = 0;
  for (const std::string_view part : parts) size += static_cast<std::int64_t>(part.size());
  const std::int64_t offset = ranks.sum_before(size);
  do_on_root(ranks, [&] { require_regular_or_none(path); });
  // Makes the file, or empties one that a killed run has left. The system calls return the reason if that fails.
  do_on_root(ranks, [&] {
    const int error_number = write_parts(temporary, {});
    if (error_number != 0) throw_io_error("write", path, error_number);
  });
  const auto require_none = [&](const std::string& reason) {
    do_together(ranks, [&] {
      if (!reason.empty()) throw IoError("cannot write '{}': {}", path.string(), reason);
    });
  };
  try {
    MPI_File file = MPI_FILE_NULL;
    // If only some ranks can open the file, they leave it open, because closing is collective.
    require_none(reason_of(MPI_File_open(ranks.handle(), temporary.c_str(), MPI_MODE_WRONLY, MPI_INFO_NULL, &file)));
    const std::string failure = write_parts(file, offset, parts);
    const std::string close_failure = reason_of(MPI_File_close(&file));
    require_none(failure.empty() ? close_failure : failure);
    do_on_root(ranks, [&] {
      if (std::rename(temporary.c_str(), path.c_str()) != 0) throw_io_error("write", path, errno);
    });
  } catch (const IoError&) {
    if (ranks.is_root()) std::remove(temporary.c_str());
    throw;
  }
}

/// Writes beside `path` and renames.
void replace_file(const std::filesystem::path& path, std::span<const std::string_view> parts, Lasting lasting) {
  require_regular_or_none(path);
  std::filesystem::path temporary = path;
  temporary += temporary_ending;
  int error_number = write_parts(temporary, parts, lasting);
  if (error_number == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error_number = errno;
  if (error_number != 0) {
    std::remove(temporary.c_str());
    throw_io_error("write", path, error_number);
  }
}

/// Waits until the names in `folder` are on the disk.
void flush_folder(const std::filesystem::path& folder) {
  const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) throw_io_error("read", folder, errno);
  const int error_number = fsync(file) == 0 ? 0 : errno;
  close(file);
  // Some file systems do not support this for a folder, and report so.
  if (error_number != 0 && error_number != EINVAL && error_number != ENOTSUP) {
    throw_io_error("write", folder, error_number);
  }
}

}  // namespace

void throw_io_error(std::string_view what, const std::filesystem::path& path, int error_number) {
  throw IoError("cannot {} '{}': {}", what, path.string(), std::generic_category().message(error_number));
}

std::string_view obstacle_at(const std::filesystem::path& path) {
  struct stat found {};
  if (lstat(path.c_str(), &found) != 0) return {};  // an object whose status cannot be read cannot be opened either
  if (S_ISLNK(found.st_mode)) return "a link";
  if (S_ISDIR(found.st_mode)) return "a folder";
  if (!S_ISREG(found.st_mode)) return "a device or a pipe";
  return found.st_uid == geteuid() ? std::string_view() : foreign_file;
}

void require_regular_or_none(const std::filesystem::path& path) {
  const std::string_view obstacle = obstacle_at(path);
  if (obstacle.empty() || obstacle == foreign_file) return;
  throw IoError(
      "cannot write '{}': {} is in its place, and is neither followed nor replaced; remedy: remove it, or choose "
      "another name",
      path.string(), obstacle);
}

int open_regular_file(const std::filesystem::path& path, int flags) {
  require_regular_or_none(path);
  const int file = open(path.c_str(), flags | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file < 0) throw_io_error((flags & O_ACCMODE) == O_RDONLY ? "read" : "write", path, errno);
  return file;
}

void write_file(const std::filesystem::path& path, std::span<const std::string_view> parts, const Communicator& ranks) {
  if (!ranks.is_alone()) {
    write_file_together(path, parts, ranks);
    return;
  }
  replace_file(path, parts, Lasting::as_the_system_likes);
}

void write_file_to_disk(const std::filesystem::path& path, std::span<const std::string_view> parts) {
  replace_file(path, parts, Lasting::on_disk);
  flush_folder(path.has_parent_path() ? path.parent_path() : ".");
}

bool overwrite_file(const std::filesystem::path& path, std::string_view text) {
  const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return false;
  const auto size = static_cast<ssize_t>(text.size());
  const bool is_written = write(file, text.data(), text.size()) == size && ftruncate(file, size) == 0;
  close(file);
  return is_written;
}

void write_text_file(const std::filesystem::path& path, std::string_view text) { write_file(path, {&text, 1}); }

void remove_file(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::remove(path, error);
  if (error) throw_io_error("remove", path, error.value());
}

}  // namespace tailwater
