#include "app/pictures.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <vector>

#include "app/python_package.h"
#include "io/messages.h"
#include "io/vtp_writer.h"
#include "io/write_file.h"
#include "run/field_output.h"

namespace tailwater {
namespace {

/// Is there while it lives.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "tailwater_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw_io_error("make the folder", name, errno);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace

void add_pictures_option(CLI::App& command, int& pictures) {
  command
      .add_option("--pictures", pictures,
                  "Draw so many pictures of the run when it ends, and in 3D the water's surface as a mesh from every "
                  "field file, as `tailwater pictures DIR` does")
      ->check(CLI::Range(1, 100000))
      ->type_name("N");
}

void draw_pictures(const std::filesystem::path& run, int count, const Communicator& ranks) {
  if (!ranks.is_root()) return;
  tell("drawing pictures");
  try {
    run_python("tailwater.pictures", {"--count", fmt::format("{}", count), run.string()});
  } catch (const IoError& error) {
    warn(fmt::format("no pictures: {}; later: tailwater pictures {}", error.what(), run.string()));
  }
}

void draw_start(const std::filesystem::path& image, const std::string& title, double spacing,
                const Boundary<3>& boundary, std::span<const Vec<3>> water, std::span<const Vec<3>> marks) {
  const TemporaryFolder folder;
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
