// Mutations that know that a text has lines, and lines have words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tailwater {

/// What a kind of text is made of.
struct Vocabulary {
  std::vector<std::string> lines;
  std::vector<std::string> words;
};

/// A mutator for LLVMFuzzerCustomMutator: adds, drops, doubles, moves and cuts lines, puts words in the place of
/// others, changes the bytes of a word, or (in one case of eight) any bytes.
std::size_t mutate_text(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed,
                        const Vocabulary& vocabulary);

}  // namespace tailwater
