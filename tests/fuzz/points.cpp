// CSV files of points, as the bed of a basin.
#include <fstream>

#include "examine_case.h"
#include "harness.h"
#include "io/temporary_folder.h"
#include "text_mutator.h"

namespace {

using namespace tailwater;

/// With a case that names the points.
class Folder : public TemporaryFolder {
 public:
  Folder() {
    std::ofstream(path() / "case.toml")
        << "[particles]\nspacing = 0.1\n[[fluid]]\nmin = [0, 0]\nmax = [1, 0.5]\n[[wall]]\n"
           "points_file = \"bed.csv\"\n[time]\nend = 1\n";
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  std::ofstream(folder.path() / "bed.csv", std::ios::binary) << text_of_input(data, size);
  examine_case(folder.path() / "case.toml");
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed) {
  static const Vocabulary vocabulary{
      {"x [m], z [m]", "station_mm;level_ft", "# a remark", "0.5, 0.25", "1 2 3", ",", "\"x\"\t\"y\"\t\"z\""},
      {"0",       "-1",        "1e308", "1e15", "nan", "inf", "+1", "0,5",          "x",      "z",
       "station", "elevation", "(km)",  "[cm]", "_mm", ";",   "\t", "\xef\xbb\xbf", "1e-320", "0x10"}};
  return mutate_text(data, size, room, seed, vocabulary);
}
