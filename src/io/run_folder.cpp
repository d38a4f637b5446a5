#include "io/run_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/input_file.h"
#include "io/write_file.h"
#include "parallel/together.h"

namespace tailwater {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 7> result_files{
    effective_case_name, "steps.csv", "ranks.csv", summary_name, "log.txt", stop_file_name, checkpoint_file_name};
constexpr std::array<std::string_view, 2> failure_files{"last_good.vtp", "report.txt"};
/// The series of field files that a run, or its pictures, may write: NAME.pvd and NAME_00000.vtp, ...
constexpr std::array<std::string_view, 3> series_names{"fields", "walls", "surface"};
constexpr std::array<std::string_view, 2> usual_folders{"probes", "fields"};
/// Folders that are made only with their first file.
constexpr std::array<std::string_view, 4> rare_folders{"failure", "checkpoints", "pictures", "view"};
constexpr std::string_view checkpoint_start = "step_";
constexpr std::string_view checkpoint_ending = ".h5";

void require(const std::error_code& error, std::string_view what, const fs::path& path) {
  if (error) throw_io_error(what, path, error.value());
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

bool is_folder(const fs::path& path) { return fs::is_directory(fs::symlink_status(path)); }

void remove_if_empty(const fs::path& folder) {
  if (is_folder(folder) && entries(folder).empty()) remove_file(folder);
}

/// Whether a name has the form START012.
bool is_numbered(std::string_view stem, std::string_view start, std::size_t min_digits) {
  return stem.starts_with(start) && stem.size() >= start.size() + min_digits &&
         stem.find_first_not_of("0123456789", start.size()) == stem.npos;
}

/// Whether a name has the form FIELDS.pvd or FIELDS_00012.vtp.
bool is_field_file(const fs::path& name) {
  const std::string stem = name.stem();
  const bool is_list = name.extension() == ".pvd";
  return std::any_of(series_names.begin(), series_names.end(), [&](std::string_view series) {
    if (is_list) return stem == series;
    return name.extension() == ".vtp" && is_numbered(stem, fmt::format("{}_", series), 5);
  });
}

/// Whether a name has the form picture_00012.png.
bool is_picture(const fs::path& name) {
  return name.extension() == ".png" && is_numbered(name.stem().string(), "picture_", 5);
}

/// Whether a name has the form scene.json or 00012.frame.
bool is_view_file(const fs::path& name) {
  return name == scene_name || (name.extension() == frame_ending && is_numbered(name.stem().string(), "", 5));
}

/// Whether a name has the form step_000000000012.h5.
bool is_checkpoint(const fs::path& name) {
  return name.extension() == checkpoint_ending && is_numbered(name.stem().string(), checkpoint_start, 1);
}

/// The files of the probes of the run that has left its effective case in `folder`. Only this case distinguishes them
/// from tables that a user has put beside them.
std::vector<std::string> probe_files(const fs::path& folder) {
  std::ifstream effective_case = open_input_file(folder / effective_case_name);
  constexpr std::string_view key = "name = \"";
  std::vector<std::string> names;
  bool is_in_probe = false;
  for (std::string line; std::getline(effective_case, line);) {
    if (line.starts_with('[')) is_in_probe = line == "[[probe]]";
    if (is_in_probe && line.starts_with(key)) {
      const std::string name = line.substr(key.size(), line.find('"', key.size()) - key.size());
      for (const char* ending : {".csv", ".vtp", ".map.csv"}) names.push_back(name + ending);
    }
  }
  return names;
}

/// Adds the regular files in `folder` for whose final name `is_ours` is true. Links are not followed.
template <class IsOurs>
void add_files(const fs::path& folder, const IsOurs& is_ours, std::vector<fs::path>& found) {
  if (!is_folder(folder)) return;
  for (const fs::path& path : entries(folder)) {
    if (is_ours(final_name(path)) && fs::is_regular_file(fs::symlink_status(path))) found.push_back(path);
  }
}

/// The files that an earlier run wrote into `folder`.
std::vector<fs::path> earlier_results(const fs::path& folder) {
  std::vector<fs::path> found;
  const std::vector<std::string> probes = probe_files(folder);
  add_files(
      folder / "probes",
      [&](const fs::path& name) { return std::find(probes.begin(), probes.end(), name.string()) != probes.end(); },
      found);
  add_files(folder / "fields", is_field_file, found);
  add_files(folder / "view", is_view_file, found);
  add_files(
      folder / "failure", [](const fs::path& name) { return is_one_of(failure_files, name); }, found);
  add_files(folder / "checkpoints", is_checkpoint, found);
  add_files(folder / "pictures", is_picture, found);
  add_files(
      folder, [](const fs::path& name) { return is_one_of(result_files, name); }, found);
  return found;
}

void remove_earlier_results(const fs::path& folder) {
  for (const fs::path& path : earlier_results(folder)) {
    // The new run replaces the case at once. A run that is killed in between can still be started again from it.
    if (path.filename() != effective_case_name) remove_file(path);
  }
  for (const std::string_view name : rare_folders) remove_if_empty(folder / name);
}

/// Removes files of an earlier run that a resumed run would not replace.
void remove_traces_of_the_end(const fs::path& folder) {
  for (const fs::path& path : earlier_results(folder)) {
    const bool is_request = path.filename() == stop_file_name || path.filename() == checkpoint_file_name;
    if (is_request || path.parent_path().filename() == "failure") remove_file(path);
  }
  remove_if_empty(folder / "failure");
}

/// Whether the folder is empty, apart from the lock of a run that was killed at its very start.
bool is_free(const fs::path& folder) {
  const std::vector<fs::path> found = entries(folder);
  return std::all_of(found.begin(), found.end(),
                     [](const fs::path& path) { return path.filename() == lock_file_name; });
}

/// A run writes through no link, and does not replace devices or pipes. Objects in folders inside are detected when
/// their files are written.
void require_no_links(const fs::path& run) {
  const auto refuse_if = [](bool is_other, const fs::path& path) {
    if (!is_other) return;
    throw InputError("'{}' is a link, a device or a pipe, which no run writes into: remove it, or name another folder",
                     path.string());
  };
  for (const std::string_view name : result_files) {
    std::error_code error;
    const fs::file_status status = fs::symlink_status(run / name, error);
    refuse_if(fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status), run / name);
  }
  const auto refuse_linked_folder = [&](std::string_view name) {
    std::error_code error;
    refuse_if(fs::is_symlink(fs::symlink_status(run / name, error)), run / name);
  };
  for (const std::string_view name : usual_folders) refuse_linked_folder(name);
  for (const std::string_view name : rare_folders) refuse_linked_folder(name);
}

FolderLock make_run_folder(const fs::path& path, bool force) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() != fs::file_type::not_found) require(error, "read", path);
  if (fs::exists(status) && !fs::is_directory(status)) {
    throw InputError("output folder '{}' is a file: name another folder", path.string());
  }
  if (fs::is_directory(status) && !force && !is_free(path)) {
    FolderLock::require_free(path);
    throw InputError("output folder '{}' is not empty: name another one, or add --force to replace the results in it",
                     path.string());
  }
  require_no_links(path);
  make_folder(path);
  FolderLock lock(path);  // also tests whether files can be written: permission bits do not restrict root
  for (const std::string_view name : usual_folders) make_folder(path / name);
  remove_earlier_results(path);
  return lock;
}

}  // namespace

RunFolder RunFolder::create(const fs::path& path, bool force, const Communicator& ranks) {
  FolderLock lock;
  do_on_root(ranks, [&] { lock = make_run_folder(path, force); });
  return {path, std::move(lock)};
}

RunFolder RunFolder::open(const fs::path& path, const Communicator& ranks) {
  FolderLock lock;
  do_on_root(ranks, [&] {
    require_no_links(path);
    lock = FolderLock(path);
    remove_traces_of_the_end(path);
  });
  return {path, std::move(lock)};
}

fs::path RunFolder::checkpoint(std::int64_t step) const {
  return checkpoints() / fmt::format("{}{:012}{}", checkpoint_start, step, checkpoint_ending);
}

fs::path RunFolder::make_failure() const {
  const fs::path failure = path_ / "failure";
  make_folder(failure);
  return failure;
}

std::vector<fs::path> checkpoints_in(const fs::path& run) {
  const fs::path folder = run / "checkpoints";
  std::vector<fs::path> found;
  if (!is_folder(folder)) return found;
  for (const fs::path& path : entries(folder)) {
    if (is_checkpoint(path.filename())) found.push_back(path);
  }
  std::sort(found.begin(), found.end(), std::greater<>());  // names have equally many digits
  return found;
}

}  // namespace tailwater
