// One run, one folder: the lock that a run holds on its folder while it goes.
#pragma once

#include <filesystem>
#include <string_view>

namespace tailwater {

inline constexpr std::string_view lock_file_name = ".lock";

/// A lock on the file FOLDER/.lock (flock). The system ends it with the process, however that ends, so a killed run
/// locks nothing. Where the file system has no locks there is a warning and no protection.
class FolderLock {
 public:
  /// Takes the lock of a folder that exists. Throws InputError, which names the process, while a run holds it, and
  /// IoError when there can be no file.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  /// Removes the file and gives the lock back.
  ~FolderLock();

  /// Holds nothing: a rank that is not the root.
  FolderLock() = default;

  /// Whether a run holds the lock. A run that begins at this very moment waits for the answer.
  static bool is_held(const std::filesystem::path& folder);

  /// Throws as the constructor does while a run holds the lock; takes nothing.
  static void require_free(const std::filesystem::path& folder);

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace tailwater
