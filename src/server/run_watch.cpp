#include "server/run_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "base/json.h"
#include "io/run_folder.h"
#include "results/run_info.h"

namespace tailwater {
namespace {

constexpr auto min_time_between_infos = std::chrono::seconds(1);
/// Pause after each info, as a multiple of the time that it took: with long tables it takes a while.
constexpr int rest_over_work = 20;

std::string event(std::string_view name, const Json& data) {
  return fmt::format("event: {}\ndata: {}\n\n", name, data.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

RunWatch::RunWatch(const std::filesystem::path& run, std::uint32_t first_frame)
    : folder_(run), index_(folder_), first_frame_(first_frame) {}

std::string RunWatch::look() {
  if (!folder_.exists()) {
    if (is_gone_) return "";
    is_gone_ = true;
    return event("gone", Json::object());
  }
  is_gone_ = false;
  return info() + frames() + tables();
}

std::string RunWatch::frames() {
  const FrameIndex::News news = index_.look();
  std::string events;
  if (news.is_cut) events += event("cut", {{"time", news.cut_time}});
  for (const std::uint32_t k : news.added) {
    if (k < first_frame_ && !news.is_cut) continue;
    const FrameEntry& frame = index_.frames().at(k);
    events += event("frame", {{"index", k}, {"time", frame.time}, {"key", frame.is_key}, {"bytes", frame.bytes}});
  }
  return events;
}

std::string RunWatch::tables() {
  std::string events;
  for (const std::string& path : tables_of(folder_)) {
    const std::optional<FileMark> mark = folder_.mark_of(names_of_readable_file(path));
    if (!mark || (table_sizes_.contains(path) && table_sizes_[path] == mark->size)) continue;
    table_sizes_[path] = mark->size;
    events += event("table", {{"path", path}, {"bytes", mark->size}});
  }
  return events;
}

std::string RunWatch::info() {
  const auto begin = Clock::now();
  if (begin < next_info_time_) return "";
  const std::string told = event("info", run_info(folder_.path()));
  const auto end = Clock::now();
  next_info_time_ = std::max<Clock::time_point>(begin + min_time_between_infos, end + rest_over_work * (end - begin));
  if (told == last_info_) return "";
  last_info_ = told;
  return told;
}

std::vector<std::string> tables_of(const FolderReader& folder) {
  std::vector<std::string> paths{"steps.csv"};
  for (const std::string& name : folder.names_in("probes")) {
    if (name.ends_with(".csv")) paths.push_back("probes/" + name);
  }
  return paths;
}

std::vector<std::string> names_of_readable_file(std::string_view path) {
  constexpr std::array<std::string_view, 5> files{"steps.csv", "ranks.csv", "log.txt", summary_name,
                                                  effective_case_name};
  if (std::find(files.begin(), files.end(), path) != files.end()) return {std::string(path)};
  constexpr std::string_view folder = "probes/";
  if (!path.starts_with(folder) || !path.ends_with(".csv")) return {};
  return {"probes", std::string(path.substr(folder.size()))};
}

}  // namespace tailwater
