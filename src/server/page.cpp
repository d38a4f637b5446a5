// The page in the program: the bytes of web/dist/view.html (TAILWATER_PAGE), and what an exported one has in it.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "case/reader.h"
#include "geometry/boundary.h"
#include "io/base64.h"
#include "io/run_folder.h"
#include "run/run_info.h"
#include "server/frame_index.h"
#include "server/run_watch.h"
#include "server/view_server.h"
#include "view/scene.h"

// clang-format off
__asm__(".pushsection .rodata\n"
        "tailwater_page_begin:\n"
        ".incbin \"" TAILWATER_PAGE "\"\n"
        "tailwater_page_end:\n"
        ".byte 0\n"
        ".popsection\n");
// clang-format on
extern "C" const char tailwater_page_begin[];
extern "C" const char tailwater_page_end[];

namespace tailwater {
namespace {

using Json = nlohmann::ordered_json;

/// Where an exported page holds its data.
constexpr std::string_view marker = "<!-- tailwater-data -->";

/// Field files are large: of a run without a stream no more of them go into a page.
constexpr std::size_t most_field_frames = 100;

Json frames_of(FrameIndex& index) {
  Json frames = Json::array();
  index.look();
  const std::size_t stride = std::max<std::size_t>(1, index.frames().size() / most_field_frames);
  for (const auto& [k, entry] : index.frames()) {
    if (!entry.field_file.empty() && k % stride != 0) continue;
    const std::optional<std::string> bytes = index.bytes_of(k);
    if (!bytes) continue;
    frames.push_back({{"index", k}, {"time", entry.time}, {"key", entry.is_key}, {"data", base64(*bytes)}});
  }
  return frames;
}

Json run_for_export(const std::filesystem::path& path) {
  const FolderReader folder(path);
  FrameIndex index(folder);
  Json files = Json::object();
  for (const std::string& table : tables_of(folder)) files[table] = folder.text_of(names_of_readable_file(table));
  Json info = run_info(path);
  info["controls"] = Json::array();  // there is nobody to do it
  Json frames = frames_of(index);
  if (frames.empty()) {
    throw IoError(fmt::format("'{}' has no frames and no field files: there is nothing to show yet", path.string()));
  }
  return {{"scene", scene_of_run(path)},
          {"info", std::move(info)},
          {"files", std::move(files)},
          {"frames", std::move(frames)}};
}

template <int Dim>
Json scene_from_case(const CaseSpec& spec) {
  try {
    return scene_json<Dim>(spec, make_boundary<Dim>(spec));
  } catch (const InputError&) {  // a mesh that is no longer there
    return scene_json<Dim>(spec, Boundary<Dim>());
  }
}

}  // namespace

std::string_view view_page() {
  return {tailwater_page_begin, static_cast<std::size_t>(tailwater_page_end - tailwater_page_begin)};
}

Json scene_of_run(const std::filesystem::path& run) {
  const Json written = Json::parse(FolderReader(run).text_of({"view", std::string(scene_name)}), nullptr, false);
  if (written.is_object()) return written;
  const CaseSpec spec = read_effective_case(run / effective_case_name);
  return spec.general.dimension == 2 ? scene_from_case<2>(spec) : scene_from_case<3>(spec);
}

std::string exported_page(const ViewContent& content, const std::string& version) {
  Json state{{"mode", content.mode}, {"runs", Json::array()}, {"case", nullptr}, {"version", version}};
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
      text += "\\u003c";  // nothing in the data ends the element
    } else {
      text += c;
    }
  }
  text += "</script>";
  return text.append(page.substr(place + marker.size()));
}

}  // namespace tailwater
