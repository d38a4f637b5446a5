// An exported page: the page of the program with the data of runs in it.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "base/error.h"
#include "base/json.h"
#include "io/base64.h"
#include "io/deflate.h"
#include "results/run_info.h"
#include "server/frame_index.h"
#include "server/page.h"
#include "server/run_watch.h"
#include "server/view_server.h"
#include "view/coarse_frames.h"

namespace tailwater {
namespace {

/// The place of the data in an exported page.
constexpr std::string_view marker = "<!-- tailwater-data -->";

constexpr int smallest = 9;  ///< compression level of zlib

/// Number of digits to which numbers are rounded.
constexpr std::size_t digits = 7;

/// The frames of a run in the order of time, decoded.
class FrameReader {
 public:
  explicit FrameReader(const FrameIndex& index) : index_(index) {}

  /// Empty if the frame cannot be read, or follows one that could not. Call for each frame.
  std::optional<Frame> next(std::uint32_t k) {
    const std::optional<std::string> bytes = index_.bytes_of(k);
    if (!bytes) return lose();
    try {
      if (is_lost_ && read_frame_head(*bytes).head.order > 0) return std::nullopt;
      Frame frame = decode_frame(*bytes, before_);
      is_lost_ = false;
      before_.last_but_one = std::exchange(before_.last, frame.particles);
      return frame;
    } catch (const IoError&) {
      return lose();
    }
  }

 private:
  std::optional<Frame> lose() {
    is_lost_ = true;
    return std::nullopt;
  }

  const FrameIndex& index_;
  FramesBefore before_;
  bool is_lost_ = false;
};

/// Adds frames as a key frame and its successors; consumes them.
void add_frames(Json& list, std::vector<Frame>& frames, double spacing) {
  const auto first = static_cast<std::uint32_t>(list.size());
  const std::vector<std::string> encoded = encode_coarsely(frames, first, spacing);
  for (std::size_t k = 0; k < encoded.size(); ++k) {
    list.push_back(
        {{"index", first + k}, {"time", frames[k].head.time}, {"key", k == 0}, {"data", base64(encoded[k])}});
  }
  frames.clear();
}

Json frames_of(FrameIndex& index, double spacing) {
  Json list = Json::array();
  index.look();
  if (index.frames().empty()) return list;
  const std::size_t stride = stride_of_sent(index.frames().size());
  const std::uint32_t last = index.frames().rbegin()->first;
  FrameReader reader(index);
  std::vector<Frame> group;
  for (const auto& [k, entry] : index.frames()) {
    const bool is_sent = k % stride == 0 || k == last;
    if (!is_sent && !entry.field_file.empty()) continue;  // no frame follows from it
    std::optional<Frame> frame = reader.next(k);
    if (!frame || !is_sent) continue;
    group.push_back(std::move(*frame));
    if (group.size() == frames_per_key_sent) add_frames(list, group, spacing);
  }
  add_frames(list, group, spacing);
  return list;
}

/// A number rounded for the page; other words unchanged.
std::string rounded_cell(std::string_view cell) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
  const bool is_number = error == std::errc{} && end == cell.data() + cell.size();
  return is_number && cell.size() > digits ? fmt::format("{:.{}g}", number, digits) : std::string(cell);
}

/// A table with its numbers rounded for the page.
std::string rounded_table(std::string_view text) {
  std::string table;
  while (!text.empty()) {
    const std::size_t size = std::min(text.find_first_of(",\n"), text.size());
    table += rounded_cell(text.substr(0, size));
    if (size < text.size()) table += text[size];
    text.remove_prefix(std::min(text.size(), size + 1));
  }
  return table;
}

Json run_for_export(const std::filesystem::path& path) {
  const FolderReader folder(path);
  FrameIndex index(folder);
  Json files = Json::object();
  for (const std::string& name : tables_of(folder)) {
    if (!name.starts_with("probes/")) continue;  // the page shows no other tables
    files[name] = base64(deflated(rounded_table(folder.text_of(names_of_readable_file(name))), smallest));
  }
  Json info = run_info(path);
  info["controls"] = Json::array();  // no process serves them
  Json scene = scene_of_run(path);
  Json frames = frames_of(index, scene.at("spacing"));
  if (frames.empty()) {
    throw IoError("'{}' has no frames and no field files: there is nothing to show yet", path.string());
  }
  return {{"scene", std::move(scene)},
          {"info", std::move(info)},
          {"files", std::move(files)},
          {"frames", std::move(frames)}};
}

}  // namespace

std::string exported_page(const ViewContent& content, const std::string& version) {
  Json state{{"mode", content.mode},
             {"runs", Json::array()},
             {"case", nullptr},
             {"report", content.report},
             {"version", version}};
  Json runs = Json::object();
  for (std::size_t k = 0; k < content.runs.size(); ++k) {
    const ViewedRun& run = content.runs[k];
    const std::string id = std::to_string(k);
    Json shown{{"id", id}, {"name", run.name}, {"path", run.path.string()}};
    if (!run.parameters.is_null()) shown["parameters"] = run.parameters;
    state["runs"].push_back(std::move(shown));
    runs[id] = run_for_export(run.path);
  }
  const std::string data =
      Json{{"state", std::move(state)}, {"runs", std::move(runs)}}.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string_view page = view_page();
  const std::size_t place = page.find(marker);
  if (place == page.npos) throw IoError("the page of this program has no place for data; remedy: build it again");
  std::string text(page.substr(0, place));
  text += R"(<script type="application/json" id="tailwater-data">)";
  for (const char c : data) {
    if (c == '<') {
      text += "\\u003c";  // no text in the data ends the element
    } else {
      text += c;
    }
  }
  text += "</script>";
  return text.append(page.substr(place + marker.size()));
}

}  // namespace tailwater
