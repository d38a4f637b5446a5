// The scenes that the page draws.
#include "base/error.h"
#include "base/json.h"
#include "case/reader.h"
#include "geometry/boundary.h"
#include "io/run_folder.h"
#include "server/folder_reader.h"
#include "server/view_server.h"
#include "view/scene.h"

namespace tailwater {
namespace {

template <int Dim>
Json scene_from_case(const CaseSpec& spec) {
  try {
    return scene_json<Dim>(spec, make_boundary<Dim>(spec));
  } catch (const InputError&) {  // a mesh that no longer exists
    return scene_json<Dim>(spec, Boundary<Dim>());
  }
}

}  // namespace

Json scene_of_run(const std::filesystem::path& run) {
  const Json written = Json::parse(FolderReader(run).text_of({"view", std::string(scene_name)}), nullptr, false);
  if (written.is_object()) return written;
  const CaseSpec spec = read_effective_case(run / effective_case_name);
  return spec.general.dimension == 2 ? scene_from_case<2>(spec) : scene_from_case<3>(spec);
}

}  // namespace tailwater
