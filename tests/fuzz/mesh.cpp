// Mesh files, as a body in a tank. The first letter of an input selects the format of the rest: s STL, o OBJ, p PLY.
#include <algorithm>
#include <cstring>
#include <fstream>

#include "examine_case.h"
#include "harness.h"
#include "io/temporary_folder.h"
#include "text_mutator.h"

namespace {

using namespace tailwater;

const char* kind_of(std::uint8_t letter) { return letter == 'o' ? "obj" : letter == 'p' ? "ply" : "stl"; }

/// A folder with a case for each mesh format.
class Folder : public TemporaryFolder {
 public:
  Folder() {
    for (const std::string kind : {"stl", "obj", "ply"}) {
      std::ofstream(path() / (kind + ".toml"))
          << "[case]\ndimension = 3\n[particles]\nspacing = 0.12\n[[fluid]]\nmin = [0, 0, 0]\nmax = [1, 1, 0.6]\n"
             "[[wall]]\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nopen = [\"+z\"]\n"
             "[[wall]]\nshape = \"mesh\"\nfluid_side = \"outside\"\nfile = \"body."
          << kind << "\"\n[time]\nend = 1\n";
    }
  }
};

/// Number of bytes of a binary STL file before its first triangle, and of each triangle.
constexpr std::size_t stl_head = 84, stl_triangle = 50;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  if (size == 0) return 0;
  const std::string kind = kind_of(data[0]);
  std::ofstream(folder.path() / ("body." + kind), std::ios::binary) << text_of_input(data + 1, size - 1);
  examine_case(folder.path() / (kind + ".toml"));
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed) {
  static const Vocabulary vocabulary{{"facet normal 0 0 1",
                                      "outer loop",
                                      "vertex 0.2 0.2 0.2",
                                      "endloop",
                                      "endfacet",
                                      "endsolid",
                                      "v 0.8 0.2 0.4",
                                      "f 1 2 3",
                                      "f 1/1/1 2//2 3 4",
                                      "f -1 -2 -3",
                                      "element face 12",
                                      "element vertex 8",
                                      "property float x",
                                      "property list uchar int vertex_indices",
                                      "property double w",
                                      "end_header",
                                      "format ascii 1.0",
                                      "format binary_little_endian 1.0",
                                      "3 0 1 2",
                                      "4 0 1 2 3"},
                                     {"0",
                                      "1",
                                      "2",
                                      "-1",
                                      "0.5",
                                      "1e308",
                                      "1e-320",
                                      "nan",
                                      "inf",
                                      "999999999999",
                                      "-9223372036854775808",
                                      "uchar",
                                      "double",
                                      "float32",
                                      "int16",
                                      "list",
                                      "face",
                                      "vertex",
                                      "vertex_index",
                                      "x",
                                      "y",
                                      "z",
                                      "ascii"}};
  const bool is_binary = std::any_of(data, data + size, [](std::uint8_t byte) { return byte == 0; });
  if (!is_binary) return mutate_text(data, size, room, seed, vocabulary);
  const std::size_t new_size = LLVMFuzzerMutate(data, size, room);
  if (new_size > 1 + stl_head && data[0] == 's' && seed % 2 == 0) {  // correct the number of triangles
    const auto count = static_cast<std::uint32_t>((new_size - 1 - stl_head) / stl_triangle);
    std::memcpy(data + 1 + stl_head - sizeof(count), &count, sizeof(count));
  }
  return new_size;
}
