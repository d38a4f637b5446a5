// The driver of a fuzz target as a test: FOLDER COUNT repeats all files of a corpus and COUNT mutations of them, which
// are always the same. PROGRAM.last_input holds the current input and remains after a finding.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "harness.h"

namespace {

namespace fs = std::filesystem;

std::minstd_rand bytes_random(1);

std::size_t below(std::size_t count) { return count == 0 ? 0 : bytes_random() % count; }

std::vector<std::string> read_corpus(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> inputs;
  for (const fs::path& path : paths) {
    std::ifstream file(path, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return inputs;
}

void try_input(const std::string& input, const fs::path& last) {
  std::ofstream(last, std::ios::binary) << input;
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
}

}  // namespace

// Default mutator, for targets that define none.
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                                     std::size_t room, unsigned) {
  return LLVMFuzzerMutate(data, size, room);
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t room) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t place = below(size);
  switch (below(5)) {
    case 0:
      bytes.insert(below(size + 1), 1, static_cast<char>(below(256)));
      break;
    case 1:
      bytes.erase(place, 1 + below(8));
      break;
    case 2:
      bytes.insert(below(size + 1), bytes.substr(place, 1 + below(16)));
      break;
    case 3:
      if (size > 0) bytes[place] = static_cast<char>(static_cast<unsigned char>(bytes[place]) ^ (1U << below(8)));
      break;
    default:
      if (size > 0) bytes[place] = static_cast<char>(below(256));
  }
  bytes.resize(std::min(bytes.size(), room));
  std::copy(bytes.begin(), bytes.end(), data);
  return bytes.size();
}

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s FOLDER COUNT\n", argv[0]);
    return 2;
  }
  const std::vector<std::string> corpus = read_corpus(argv[1]);
  if (corpus.empty()) {
    std::fprintf(stderr, "%s has no files\n", argv[1]);
    return 2;
  }
  const fs::path last = fs::path(argv[0]).concat(".last_input");
  for (const std::string& input : corpus) try_input(input, last);
  constexpr std::size_t room = 1 << 16;
  std::minstd_rand random(2);
  const int count = std::atoi(argv[2]);
  for (int k = 0; k < count; ++k) {
    std::string input = corpus[random() % corpus.size()];
    for (std::size_t changes = 1 + random() % 3; changes > 0; --changes) {
      const std::size_t size = input.size();
      input.resize(room);
      input.resize(LLVMFuzzerCustomMutator(reinterpret_cast<std::uint8_t*>(input.data()), std::min(size, room), room,
                                           static_cast<unsigned>(random())));
    }
    try_input(input, last);
  }
  fs::remove(last);
  std::printf("%zu files and %d mutations\n", corpus.size(), count);
  return 0;
}
