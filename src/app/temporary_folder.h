// A folder that only this user can read; it is removed with its object.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace tailwater {

class TemporaryFolder {
 public:
  /// Made in another folder, that of temporary files if none is named.
  explicit TemporaryFolder(std::filesystem::path where = {}) {
    std::error_code error;
    if (where.empty()) where = std::filesystem::temp_directory_path(error);
    std::string name = (where / "tailwater-XXXXXX").string();
    if (!error && mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Empty if it cannot be made; errno has the reason.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace tailwater
