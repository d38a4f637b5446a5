// The list of the frames of a run, updated while the run writes and when it is resumed. The frames are those of its
// stream or, without a stream, those of its field files.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/folder_reader.h"

namespace tailwater {

struct FrameEntry {
  double time = 0.0;  ///< s
  bool is_key = true;
  std::int64_t bytes = 0;
  FileMark mark;
  std::string field_file;  ///< name, for a run without a stream
};

class FrameIndex {
 public:
  explicit FrameIndex(const FolderReader& folder) : folder_(folder) {}

  /// Changes since the last call of look().
  struct News {
    bool is_cut = false;     ///< known frames are removed or have changed, as when a run is resumed
    double cut_time = -1.0;  ///< s; time of the last frame before them; -1: there is none
    std::vector<std::uint32_t> added;
  };
  /// Reads the folder. An incomplete frame does not count.
  News look();

  const std::map<std::uint32_t, FrameEntry>& frames() const { return frames_; }

  /// The bytes of a frame; empty if it cannot be read. A field file becomes a key frame.
  std::optional<std::string> bytes_of(std::uint32_t index) const;

 private:
  using Found = std::map<std::uint32_t, std::string>;  ///< names of files

  Found list_stream() const;
  std::optional<FrameEntry> read_entry(const std::string& name) const;
  News look_at_stream(const Found& found);
  News look_at_fields();
  void cut_from(std::uint32_t index, News& news);

  FolderReader folder_;
  std::map<std::uint32_t, FrameEntry> frames_;
  std::optional<FileMark> field_list_;
};

/// A field file as a key frame. Throws IoError.
std::string frame_of_fields(std::string_view bytes, const std::string& name, std::uint32_t index,
                            std::size_t dimension);

}  // namespace tailwater
