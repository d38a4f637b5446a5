// Mutations of the lines and words of a text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tailwater {

/// Lines and words that a kind of text consists of.
struct Vocabulary {
  std::vector<std::string> lines;
  std::vector<std::string> words;
};

/// A mutator for LLVMFuzzerCustomMutator: adds, removes, duplicates, moves and cuts lines, replaces words, changes the
/// bytes of a word, or (in one of eight cases) any bytes.
std::size_t mutate_text(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed,
                        const Vocabulary& vocabulary);

}  // namespace tailwater
