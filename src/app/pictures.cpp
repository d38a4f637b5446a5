#include "app/pictures.h"

#include <fmt/format.h>

#include <cerrno>
#include <string>
#include <vector>

#include "app/python_package.h"
#include "app/temporary_folder.h"
#include "base/error.h"
#include "io/messages.h"
#include "io/vtp_writer.h"
#include "io/write_file.h"
#include "results/field_output.h"

namespace tailwater {

void draw_pictures(const std::filesystem::path& run, int count, const Communicator& ranks) {
  if (!ranks.is_root()) return;
  tell("drawing pictures");
  try {
    run_python("tailwater.pictures", {"--count", fmt::format("{}", count), run.string()});
  } catch (const IoError& error) {
    warn("pictures-skipped", "no pictures: {}; later: tailwater pictures {}", error.what(), run.string());
  }
}

void draw_start(const std::filesystem::path& image, const std::string& title, double spacing,
                const Boundary<3>& boundary, std::span<const Vec<3>> water, std::span<const Vec<3>> marks) {
  const TemporaryFolder folder;
  if (folder.path().empty()) throw_io_error("make a folder in", std::filesystem::temp_directory_path(), errno);
  const auto write = [&](const char* name, const ParticleFields<3>& fields) {
    const std::filesystem::path path = folder.path() / name;
    write_vtp(path, 0.0, encode_piece(fields, 0), 0);
    return path.string();
  };
  const WallFields<3> walls(boundary);
  std::vector<std::string> options{"--title=" + title,
                                   "--walls",
                                   write("walls.vtp", walls.view()),
                                   "--water",
                                   write("water.vtp", {.position = water, .fields = {}}),
                                   "--spacing",
                                   fmt::format("{}", spacing),
                                   "--image",
                                   image.string()};
  for (const Vec<3>& x : marks) {
    options.push_back(fmt::format("--mark={},{},{}", x[0], x[1], x[2]));
  }
  run_python("tailwater.start_picture", options);
}

}  // namespace tailwater
