// Case files: reader, linked files and checks of the shapes.
#include <fstream>

#include "case/key_info.h"
#include "examine_case.h"
#include "harness.h"
#include "io/temporary_folder.h"
#include "text_mutator.h"

namespace {

using namespace tailwater;

/// A folder with the files that a case may name.
class Folder : public TemporaryFolder {
 public:
  Folder() {
    std::ofstream(path() / "bed.csv") << "x, z\n0, 2\n0, 0\n1, 0.2\n2, 0\n3, 0\n";
    std::ofstream(path() / "roll.csv") << "t [s], x [mm], angle [deg]\n0, 0, 0\n0.1, 5, 0.5\n1000, 0, 0\n";
    std::ofstream(path() / "way.csv") << "t [s], displacement [mm]\n0, 0\n0.1, 5\n1000, 300\n";
    std::ofstream(path() / "flood.csv") << "t [s], discharge [l/s]\n0, 10\n1000, 20\n";
    std::ofstream(path() / "tide.csv") << "t [s], level [m]\n0, 0.4\n1000, 0.45\n";
    std::ofstream(path() / "slope.obj") << "v -1 -1 0\nv 5 -1 0.37\nv 5 2 0.37\nv -1 2 0\nf 1 2 3\nf 1 3 4\n";
    std::ofstream(path() / "chamfer.obj")
        << "v 0 150 0\nv 0 450 0\nv 0 600 150\nv 0 600 600\nv 0 0 600\nv 0 0 150\n"
           "v 1000 150 0\nv 1000 450 0\nv 1000 600 150\nv 1000 600 600\nv 1000 0 600\nv 1000 0 150\n"
           "f 6 5 4 3 2 1\nf 7 8 9 10 11 12\nf 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n";
    std::ofstream(path() / "body.obj") << "v 1 1 0\nv 2 1 0\nv 1 2 0\nv 1 1 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  }
};

std::vector<std::string> quoted_words(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t begin = text.find('"'), end = 0; begin != std::string::npos; begin = text.find('"', end + 1)) {
    end = text.find('"', begin + 1);
    if (end == std::string::npos) break;
    words.push_back(text.substr(begin, end + 1 - begin));
  }
  return words;
}

/// The keys with their defaults and possible values.
Vocabulary make_vocabulary() {
  Vocabulary vocabulary;
  vocabulary.words = {
      "0",   "-1",      "1e308", "-1e308", "1e15", "1e-15", "nan",  "inf",    "-inf",    "0.05",
      "1e9", "1e400",   "2",     "3",      "dx",   "g",     "2*dx", "t",      "sin(t)",  "1/0",
      "x",   "sqrt(x)", "true",  "[]",     "[[]]", "{}",    "\"\"", "[0, 0]", "[0,0,0]", "9223372036854775807"};
  for (const TableInfo& table : case_tables()) {
    vocabulary.lines.push_back(table.heading());
    for (const KeyInfo& key : table.keys) {
      vocabulary.lines.push_back(std::string(key.key) + " = " + key.value);
      vocabulary.words.emplace_back(key.key);
      for (const std::string& choice : quoted_words(key.allowed)) {
        vocabulary.lines.push_back(std::string(key.key) + " = " + choice);
      }
    }
  }
  return vocabulary;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  const std::filesystem::path file = folder.path() / "case.toml";
  std::ofstream(file, std::ios::binary) << text_of_input(data, size);
  examine_case(file);
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed) {
  static const Vocabulary vocabulary = make_vocabulary();
  return mutate_text(data, size, room, seed, vocabulary);
}
