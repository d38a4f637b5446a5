// The lock that a running run holds on its folder: one run, one folder.
#pragma once

#include <filesystem>
#include <string_view>

namespace tailwater {

inline constexpr std::string_view lock_file_name = ".lock";

/// A lock on the file FOLDER/.lock (flock). The system releases it at the end of the process, however that ends, so a
/// killed run leaves no lock. Where the file system has no locks there is a warning and no protection.
class FolderLock {
 public:
  /// Locks an existing folder. Throws InputError, which names the process, while a run holds the lock, and IoError when
  /// the file cannot be made.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  /// Removes the file and releases the lock.
  ~FolderLock();

  /// Holds no lock, for a rank that is not the root.
  FolderLock() = default;

  /// Whether a run holds the lock. A run that begins during this call waits for its end.
  static bool is_held(const std::filesystem::path& folder);

  /// Throws the constructor's exceptions while a run holds the lock; does not lock.
  static void require_free(const std::filesystem::path& folder);

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace tailwater
