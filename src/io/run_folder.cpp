#include "io/run_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "io/write_file.h"
#include "parallel/together.h"

namespace tailwater {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> result_files{effective_case_name, "steps.csv",    "ranks.csv",
                                                       summary_name,        stop_file_name, checkpoint_file_name};
constexpr std::array<std::string_view, 4> result_folders{"probes", "fields", "failure", "checkpoints"};
/// Those that are made only when there is something to put into them.
constexpr std::array<std::string_view, 2> rare_folders{"failure", "checkpoints"};
constexpr std::string_view checkpoint_ending = ".h5";
/// Endings of the files a run writes into its folders.
constexpr std::array<std::string_view, 6> result_endings{".csv", ".vtp", ".pvd", ".txt", ".json", checkpoint_ending};

void require(const std::error_code& error, std::string_view what, const fs::path& path) {
  if (error) {
    throw IoError(fmt::format("cannot {} '{}': {}", what, path.string(), error.message()));
  }
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  require(error, "make the folder", path);
}

std::vector<fs::path> entries(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> paths;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    paths.push_back(entry->path());
  }
  require(error, "read the folder", folder);
  return paths;
}

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& list, const fs::path& name) {
  return std::find(list.begin(), list.end(), name.string()) != list.end();
}

/// The name without the ending of a temporary file.
fs::path final_name(const fs::path& path) {
  return path.extension() == temporary_ending ? path.stem() : path.filename();
}

bool is_result_folder(const fs::path& path) {
  return is_one_of(result_folders, path.filename()) && fs::is_directory(fs::symlink_status(path));
}

/// The files that an earlier run wrote into `folder`. Links are not followed.
std::vector<fs::path> earlier_results(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const fs::path& path : entries(folder)) {
    if (is_result_folder(path)) {
      for (const fs::path& inner : entries(path)) {
        if (is_one_of(result_endings, final_name(inner).extension()) &&
            fs::is_regular_file(fs::symlink_status(inner))) {
          found.push_back(inner);
        }
      }
    } else if (is_one_of(result_files, final_name(path)) && fs::is_regular_file(fs::symlink_status(path))) {
      found.push_back(path);
    }
  }
  return found;
}

void remove_earlier_results(const fs::path& folder) {
  std::error_code error;
  for (const fs::path& path : earlier_results(folder)) {
    // The new run replaces the case at once. A run that is killed in between can still be started again from it.
    if (path.filename() == effective_case_name) continue;
    fs::remove(path, error);
    require(error, "remove", path);
  }
  for (const std::string_view name : rare_folders) {
    const fs::path rare = folder / name;
    if (is_result_folder(rare) && entries(rare).empty()) {
      fs::remove(rare, error);
      require(error, "remove", rare);
    }
  }
}

/// What an earlier run has left and a run that goes on would not replace.
void remove_traces_of_the_end(const fs::path& folder) {
  std::error_code error;
  for (const fs::path& path : earlier_results(folder)) {
    const bool is_request = path.filename() == stop_file_name || path.filename() == checkpoint_file_name;
    if (!is_request && path.parent_path().filename() != "failure") continue;
    fs::remove(path, error);
    require(error, "remove", path);
  }
  const fs::path failure = folder / "failure";
  if (is_result_folder(failure) && entries(failure).empty()) fs::remove(failure, error);
}

/// Writes a file to find out. Permission bits do not tell: they do not bind root, and a file system may be read-only or
/// full.
void require_writable(const fs::path& folder) {
  const fs::path trial = folder / ".tailwater-write-test";
  write_text_file(trial, "can this folder be written?\n");
  std::error_code error;
  fs::remove(trial, error);
  require(error, "remove", trial);
}

void make_run_folder(const fs::path& path, bool force) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() != fs::file_type::not_found) {
    require(error, "read", path);
  }
  if (fs::exists(status) && !fs::is_directory(status)) {
    throw InputError(fmt::format("output folder '{}' is a file: name another folder", path.string()));
  }
  if (fs::is_directory(status) && !force && !entries(path).empty()) {
    throw InputError(
        fmt::format("output folder '{}' is not empty: name another one, or add --force to replace the "
                    "results in it",
                    path.string()));
  }
  make_folder(path);
  require_writable(path);
  make_folder(path / "probes");
  make_folder(path / "fields");
  remove_earlier_results(path);
}

}  // namespace

RunFolder RunFolder::create(const fs::path& path, bool force, const Communicator& ranks) {
  do_on_root(ranks, [&] { make_run_folder(path, force); });
  return RunFolder(path);
}

RunFolder RunFolder::open(const fs::path& path, const Communicator& ranks) {
  do_on_root(ranks, [&] {
    require_writable(path);
    remove_traces_of_the_end(path);
  });
  return RunFolder(path);
}

fs::path RunFolder::checkpoint(std::int64_t step) const {
  return checkpoints() / fmt::format("step_{:012}{}", step, checkpoint_ending);
}

fs::path RunFolder::make_failure() const {
  const fs::path failure = path_ / "failure";
  make_folder(failure);
  return failure;
}

std::vector<fs::path> checkpoints_in(const fs::path& run) {
  const fs::path folder = run / "checkpoints";
  std::vector<fs::path> found;
  if (!is_result_folder(folder)) return found;
  for (const fs::path& path : entries(folder)) {
    if (path.extension() == checkpoint_ending) found.push_back(path);
  }
  std::sort(found.begin(), found.end(), std::greater<>());  // names have their steps in equally many digits
  return found;
}

}  // namespace tailwater
