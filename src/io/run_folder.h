// The folder a run writes into, and the names of its contents.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/folder_lock.h"
#include "parallel/communicator.h"

namespace tailwater {

inline constexpr std::string_view stop_file_name = "STOP";
inline constexpr std::string_view checkpoint_file_name = "CHECKPOINT";
inline constexpr std::string_view effective_case_name = "case.effective.toml";
inline constexpr std::string_view summary_name = "summary.json";
/// Names in the folder of the stream for viewers.
inline constexpr std::string_view scene_name = "scene.json";
inline constexpr std::string_view frame_ending = ".frame";

class RunFolder {
 public:
  /// Makes the folder with probes/ and fields/, and holds its lock during the lifetime of this object. Either
  /// everything succeeds or nothing is changed. InputError: `path` is a file, a folder that is not empty without
  /// `force`, the folder of a running run, or one with links in the place of results. IoError: it cannot be made, read
  /// or written. `force` removes the results of an earlier run and requests to it; only the effective case stays, until
  /// the new run replaces it. Files that no run has written always stay. Collective: the root makes the folder; its
  /// error is thrown on all ranks.
  static RunFolder create(const std::filesystem::path& path, bool force, const Communicator& ranks = {});

  /// Opens the folder of an earlier run, which is to be resumed; holds its lock, as above. Requests to that run and the
  /// report of its failure are removed. Throws InputError if that run is still running or there are links in the place
  /// of results, IoError if the folder cannot be written. Collective, as above.
  static RunFolder open(const std::filesystem::path& path, const Communicator& ranks = {});

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path effective_case() const { return path_ / effective_case_name; }
  std::filesystem::path steps() const { return path_ / "steps.csv"; }
  std::filesystem::path log() const { return path_ / "log.txt"; }
  std::filesystem::path ranks() const { return path_ / "ranks.csv"; }
  std::filesystem::path summary() const { return path_ / summary_name; }
  std::filesystem::path probe(const std::string& name) const { return path_ / "probes" / (name + ".csv"); }
  std::filesystem::path probe_map(const std::string& name) const { return path_ / "probes" / (name + ".vtp"); }
  std::filesystem::path fields() const { return path_ / "fields"; }
  /// The folder of the stream for viewers, made with the first file in it.
  std::filesystem::path view() const { return path_ / "view"; }
  /// The files by which a user requests the end of the run or a checkpoint (run/requests.h).
  std::filesystem::path stop() const { return path_ / stop_file_name; }
  std::filesystem::path checkpoint_request() const { return path_ / checkpoint_file_name; }
  /// The folder of checkpoints, made with the first of them, and the name of one.
  std::filesystem::path checkpoints() const { return path_ / "checkpoints"; }
  std::filesystem::path checkpoint(std::int64_t step) const;
  /// The folder for the last good fields of a failed run. The first call makes it. Throws IoError.
  std::filesystem::path make_failure() const;

 private:
  RunFolder(std::filesystem::path path, FolderLock lock) : path_(std::move(path)), lock_(std::move(lock)) {}

  std::filesystem::path path_;
  FolderLock lock_;  ///< on the root
};

/// The checkpoints in the folder of a run, the newest first. Throws IoError if the folder cannot be read.
std::vector<std::filesystem::path> checkpoints_in(const std::filesystem::path& run);

}  // namespace tailwater
