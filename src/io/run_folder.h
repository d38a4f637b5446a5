// The folder a run writes into, and the names of what is in it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "parallel/communicator.h"

namespace tailwater {

inline constexpr std::string_view stop_file_name = "STOP";
inline constexpr std::string_view effective_case_name = "case.effective.toml";

class RunFolder {
 public:
  /// Makes the folder with its empty probes/ and fields/. Nothing is changed unless all of it can be.
  /// InputError: `path` is a file, or a folder that is not empty and `force` is not given. IoError: it cannot be made,
  /// read or written. With `force` the results of an earlier run go, and a request to stop it; what no run writes
  /// stays, wherever it lies.
  /// Collective: the root makes it, its error is thrown on all ranks.
  static RunFolder create(const std::filesystem::path& path, bool force, const Communicator& ranks = {});

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path effective_case() const { return path_ / effective_case_name; }
  std::filesystem::path steps() const { return path_ / "steps.csv"; }
  std::filesystem::path ranks() const { return path_ / "ranks.csv"; }
  std::filesystem::path summary() const { return path_ / "summary.json"; }
  std::filesystem::path probe(const std::string& name) const { return path_ / "probes" / (name + ".csv"); }
  std::filesystem::path fields() const { return path_ / "fields"; }
  /// The file by which a user asks the run to end (run/requests.h).
  std::filesystem::path stop() const { return path_ / stop_file_name; }
  /// Where a run that fails leaves its last good fields; made here, at the first call. Throws IoError.
  std::filesystem::path make_failure() const;

 private:
  explicit RunFolder(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path path_;
};

}  // namespace tailwater
