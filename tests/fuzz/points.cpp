// CSV files of points, as the bed of a basin, and of quantities over time: the motion of a wall, a discharge, a
// measurement of a gauge. Each input is read as all of these.
#include <array>
#include <fstream>
#include <utility>

#include "examine_case.h"
#include "harness.h"
#include "io/temporary_folder.h"
#include "text_mutator.h"

namespace {

using namespace tailwater;

constexpr std::array cases{
    std::pair{"bed.toml", "[[wall]]\npoints_file = \"input.csv\"\n"},
    std::pair{"motion.toml", "[[wall]]\npoints = [[0, 1], [0, 0], [1, 0], [1, 1]]\nmotion = \"input.csv\"\n"},
    std::pair{"inflow.toml",
              "[[wall]]\npoints = [[0, 0], [1, 0], [1, 1]]\n[[inlet]]\nfrom = [0, 0]\nto = [0, 1]\n"
              "file = \"input.csv\"\n"},
    std::pair{"gauge.toml",
              "[[wall]]\npoints = [[0, 1], [0, 0], [1, 0], [1, 1]]\n[[probe]]\nname = \"gauge\"\n"
              "type = \"depth\"\nat = [0.5, 0]\n[[measurement]]\nprobe = \"gauge\"\n"
              "file = \"input.csv\"\n"}};

/// A folder with cases that name the input.
class Folder : public TemporaryFolder {
 public:
  Folder() {
    for (const auto& [name, tables] : cases) {
      std::ofstream(path() / name) << "[particles]\nspacing = 0.1\n[time]\nend = 1\n"
                                      "[[fluid]]\nmin = [0, 0]\nmax = [1, 0.5]\n"
                                   << tables;
    }
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  std::ofstream(folder.path() / "input.csv", std::ios::binary) << text_of_input(data, size);
  for (const auto& [name, tables] : cases) examine_case(folder.path() / name);
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed) {
  static const Vocabulary vocabulary{
      {"x [m], z [m]", "station_mm;level_ft", "# a remark", "0.5, 0.25", "1 2 3", ",", "\"x\"\t\"y\"\t\"z\"",
       "t [s], x [mm], angle [deg]", "time_min;discharge_l/s;level_cm", "t [s], depth [mm]", "gauge [m], t [ms]"},
      {"0",       "-1",        "1e308", "1e15",  "nan",       "inf",      "+1",    "0,5",          "x",      "z",
       "station", "elevation", "(km)",  "[cm]",  "_mm",       ";",        "\t",    "\xef\xbb\xbf", "1e-320", "0x10",
       "t",       "time",      "angle", "level", "discharge", "velocity", "depth", "value",        "[deg]",  "[l/s]"}};
  return mutate_text(data, size, room, seed, vocabulary);
}
