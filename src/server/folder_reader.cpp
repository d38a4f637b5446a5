#include "server/folder_reader.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace tailwater {
namespace {

bool is_plain_name(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == name.npos && name.find('\0') == name.npos;
}

FileMark mark_from(const struct stat& status) {
  return {.inode = status.st_ino,
          .changed = status.st_mtim.tv_sec * 1'000'000'000 + status.st_mtim.tv_nsec,
          .size = status.st_size};
}

}  // namespace

OpenFile::OpenFile(OpenFile&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_) {}

OpenFile& OpenFile::operator=(OpenFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  return *this;
}

OpenFile::~OpenFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::string OpenFile::read(std::int64_t begin, std::int64_t count) const {
  std::string bytes(static_cast<std::size_t>(std::max<std::int64_t>(0, std::min(count, size_ - begin))), '\0');
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t got = pread(descriptor_, bytes.data() + filled, bytes.size() - filled,
                              static_cast<off_t>(begin + static_cast<std::int64_t>(filled)));
    if (got <= 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
  return bytes;
}

/// Returns the descriptor, or -1.
int FolderReader::open_at(const std::vector<std::string>& names, int flags) const {
  if (names.empty() || !std::all_of(names.begin(), names.end(), is_plain_name)) return -1;
  int folder = ::open(folder_.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  for (std::size_t k = 0; k < names.size() && folder >= 0; ++k) {
    const bool is_last = k + 1 == names.size();
    const int what = is_last ? flags : O_PATH | O_DIRECTORY;
    const int next = openat(folder, names[k].c_str(), what | O_NOFOLLOW | O_CLOEXEC, 0666);
    close(folder);
    folder = next;
  }
  return folder;
}

bool FolderReader::exists() const {
  std::error_code error;
  return std::filesystem::is_directory(folder_, error);
}

std::optional<OpenFile> FolderReader::open(const std::vector<std::string>& names) const {
  const int file = open_at(names, O_RDONLY | O_NONBLOCK);  // a pipe must not block the reader
  if (file < 0) return std::nullopt;
  struct stat status {};
  if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) {
    close(file);
    return std::nullopt;
  }
  return OpenFile(file, status.st_size);
}

bool FolderReader::lacks(const std::vector<std::string>& names) const {
  if (names.empty() || !std::all_of(names.begin(), names.end(), is_plain_name)) return false;
  std::filesystem::path path = folder_;
  for (const std::string& name : names) {
    path /= name;
    std::error_code error;
    const std::filesystem::file_type type = std::filesystem::symlink_status(path, error).type();
    if (type == std::filesystem::file_type::not_found) return true;
    if (type != std::filesystem::file_type::directory) return false;
  }
  return false;
}

std::string FolderReader::text_of(const std::vector<std::string>& names) const {
  const std::optional<OpenFile> file = open(names);
  return file ? file->read() : "";
}

std::optional<FileMark> FolderReader::mark_of(const std::vector<std::string>& names) const {
  const int file = open_at(names, O_PATH);
  if (file < 0) return std::nullopt;
  struct stat status {};
  const bool is_file = fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  close(file);
  return is_file ? std::optional(mark_from(status)) : std::nullopt;
}

std::vector<std::string> FolderReader::names_in(const std::string& folder) const {
  std::vector<std::string> names;
  std::error_code error;
  const std::filesystem::path path = folder_ / folder;
  if (!is_plain_name(folder) || !std::filesystem::is_directory(std::filesystem::symlink_status(path, error))) return {};
  for (std::filesystem::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool FolderReader::touch(const std::string& name) const {
  const int file = open_at({name}, O_WRONLY | O_CREAT);
  if (file < 0) return false;
  close(file);
  return true;
}

}  // namespace tailwater
