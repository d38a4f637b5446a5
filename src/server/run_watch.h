// The changes in the folder of a run, as server-sent events for the page.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "server/frame_index.h"

namespace tailwater {

class RunWatch {
 public:
  /// Reports frames from this index on.
  RunWatch(const std::filesystem::path& run, std::uint32_t first_frame);

  /// Reads the folder and returns the changes since the last call as the text of events; the first call reports all
  /// tables, the state of the run, and its frames. Events: frame, table, info, cut, gone (docs/reference/view.md).
  std::string look();

 private:
  using Clock = std::chrono::steady_clock;

  std::string frames();
  std::string tables();
  std::string info();

  FolderReader folder_;
  FrameIndex index_;
  std::uint32_t first_frame_;
  bool is_gone_ = false;
  std::map<std::string, std::int64_t> table_sizes_;  ///< bytes
  std::string last_info_;
  Clock::time_point next_info_time_;
};

/// The tables of a run by their path in its folder.
std::vector<std::string> tables_of(const FolderReader& folder);

/// "probes/H1.csv" as its names. Empty if it is not one of the files that a page may read: tables, summary, case and
/// log.
std::vector<std::string> names_of_readable_file(std::string_view path);

}  // namespace tailwater
