#include "io/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "base/error.h"
#include "io/messages.h"
#include "io/write_file.h"

namespace tailwater {
namespace {

namespace fs = std::filesystem;

std::string this_process() {
  std::array<char, 256> name{};
  return fmt::format("process {} on {}", getpid(),
                     gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "an unknown machine");
}

/// Takes the lock. Several attempts are needed, because other processes may hold it for an instant to test it
/// (is_held).
bool take_lock(int file) {
  constexpr int attempts = 5;
  for (int k = 0; k < attempts; ++k) {
    if (k > 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (flock(file, LOCK_EX | LOCK_NB) == 0) return true;
    if (errno != EWOULDBLOCK) return false;
  }
  errno = EWOULDBLOCK;
  return false;
}

/// Throws the error that another run is running, with the text that it has written into the locked file.
[[noreturn]] void throw_busy(int file, const fs::path& folder) {
  std::array<char, 300> text{};
  const ssize_t size = pread(file, text.data(), text.size() - 1, 0);
  close(file);
  throw InputError(
      "the run that writes into '{0}' is still going ({1}): name another folder, or end that run first (touch "
      "{0}/STOP)",
      folder.string(), size > 0 ? text.data() : "its process is unknown");
}

/// The lock file of a folder; -1 if there is none.
int open_lock(const fs::path& folder) {
  return open((folder / lock_file_name).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
}

/// Whether another process has locked it.
bool is_locked(int file) { return flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK; }

/// Whether the open file still has that name: the run that held it may just have removed it.
bool is_file(int file, const fs::path& path) {
  struct stat open_one {};
  struct stat named {};
  return fstat(file, &open_one) == 0 && stat(path.c_str(), &named) == 0 && open_one.st_ino == named.st_ino &&
         open_one.st_dev == named.st_dev;
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder) : path_(folder / lock_file_name) {
  do {
    if (file_ >= 0) close(file_);
    file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0) throw_io_error("write", path_, errno);
    if (take_lock(file_)) continue;
    if (errno == EWOULDBLOCK) throw_busy(std::exchange(file_, -1), folder);
    warn("folder-without-locks",
         "the file system of '{}' has no locks ({}): two runs could write into this folder at once", folder.string(),
         std::generic_category().message(errno));
    break;
  } while (!is_file(file_, path_));
  const std::string holder = this_process();
  if (ftruncate(file_, 0) != 0 || pwrite(file_, holder.data(), holder.size(), 0) < 0) {
    const int error_number = errno;
    close(std::exchange(file_, -1));
    throw_io_error("write", path_, error_number);
  }
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(file_, other.file_);
  return *this;
}

FolderLock::~FolderLock() {
  if (file_ < 0) return;
  std::error_code error;  // a missing folder needs no lock
  fs::remove(path_, error);
  close(file_);
}

bool FolderLock::is_held(const fs::path& folder) {
  const int file = open_lock(folder);
  if (file < 0) return false;
  const bool is_busy = is_locked(file);
  close(file);
  return is_busy;
}

void FolderLock::require_free(const fs::path& folder) {
  const int file = open_lock(folder);
  if (file < 0) return;
  if (is_locked(file)) throw_busy(file, folder);
  close(file);
}

}  // namespace tailwater
