// The folder a run writes into, and the names of its contents.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/folder_lock.h"
#include "parallel/communicator.h"

namespace tailwater {

inline constexpr std::string_view stop_file_name = "STOP";
inline constexpr std::string_view effective_case_name = "case.effective.toml";

class RunFolder {
 public:
  /// Makes the folder with probes/ and fields/, and holds its lock while this object lives. Changes nothing unless it
  /// can do all of it.
  /// InputError: `path` is a file, a folder that is not empty and `force` is not given, or the folder of a run that is
  /// still going. IoError: it cannot be made, read or written. `force` removes the results of an earlier run and a
  /// request to stop it. Files that no run has written stay, wherever they are.
  /// Collective: the root makes the folder; its error is thrown on all ranks.
  static RunFolder create(const std::filesystem::path& path, bool force, const Communicator& ranks = {});

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path effective_case() const { return path_ / effective_case_name; }
  std::filesystem::path steps() const { return path_ / "steps.csv"; }
  std::filesystem::path log() const { return path_ / "log.txt"; }
  std::filesystem::path ranks() const { return path_ / "ranks.csv"; }
  std::filesystem::path summary() const { return path_ / "summary.json"; }
  std::filesystem::path probe(const std::string& name) const { return path_ / "probes" / (name + ".csv"); }
  std::filesystem::path fields() const { return path_ / "fields"; }
  /// The file by which a user asks the run to end (run/requests.h).
  std::filesystem::path stop() const { return path_ / stop_file_name; }
  /// The folder for the last good fields of a failed run. The first call makes it. Throws IoError.
  std::filesystem::path make_failure() const;

 private:
  RunFolder(std::filesystem::path path, FolderLock lock) : path_(std::move(path)), lock_(std::move(lock)) {}

  std::filesystem::path path_;
  FolderLock lock_;  ///< on the root
};

}  // namespace tailwater
