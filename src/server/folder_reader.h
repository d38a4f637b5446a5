// Reads files of a run's folder for clients. For any requested name, no file outside of the folder is opened, and no
// link in it is followed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tailwater {

class OpenFile {
 public:
  explicit OpenFile(int descriptor, std::int64_t size) : descriptor_(descriptor), size_(size) {}
  OpenFile(OpenFile&& other) noexcept;
  OpenFile& operator=(OpenFile&& other) noexcept;
  ~OpenFile();

  /// Size in bytes when the file was opened.
  std::int64_t size() const { return size_; }
  /// At most `count` bytes from `begin` on; fewer where the file ends, or can no longer be read.
  std::string read(std::int64_t begin, std::int64_t count) const;
  std::string read() const { return read(0, size_); }

 private:
  int descriptor_;
  std::int64_t size_;
};

/// Distinguishes a file from another file that has its name later.
struct FileMark {
  std::uint64_t inode = 0;
  std::int64_t changed = 0;  ///< ns
  std::int64_t size = 0;     ///< bytes

  bool operator==(const FileMark&) const = default;
};

class FolderReader {
 public:
  explicit FolderReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

  const std::filesystem::path& path() const { return folder_; }
  bool exists() const;
  /// A regular file by its names from the folder on, as in {"probes", "H1.csv"}; empty if there is none, or if one of
  /// the names is no plain name.
  std::optional<OpenFile> open(const std::vector<std::string>& names) const;
  /// Whether there is no such name yet, although there could be.
  bool lacks(const std::vector<std::string>& names) const;
  /// The text of such a file; empty if there is none.
  std::string text_of(const std::vector<std::string>& names) const;
  std::optional<FileMark> mark_of(const std::vector<std::string>& names) const;
  /// The names in a subfolder, in order; none if it does not exist.
  std::vector<std::string> names_in(const std::string& folder) const;
  /// Makes an empty file unless it exists. Returns whether it succeeded.
  bool touch(const std::string& name) const;

 private:
  int open_at(const std::vector<std::string>& names, int flags) const;

  std::filesystem::path folder_;
};

}  // namespace tailwater
