#include "text_mutator.h"

#include <algorithm>
#include <random>
#include <string_view>

#include "harness.h"

namespace tailwater {
namespace {

using Random = std::minstd_rand;

std::size_t below(Random& random, std::size_t count) { return count == 0 ? 0 : random() % count; }

template <class Value>
const Value& one_of(const std::vector<Value>& values, Random& random) {
  return values[below(random, values.size())];
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

struct Word {
  std::size_t begin, size;
};

std::vector<Word> words_of(std::string_view line) {
  constexpr std::string_view between = " \t,;=[](){}\"'";
  std::vector<Word> words;
  for (std::size_t begin = line.find_first_not_of(between); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(between, begin), line.size());
    words.push_back({begin, end - begin});
    begin = line.find_first_not_of(between, end);
  }
  return words;
}

std::string mutated_bytes(std::string text, Random& random) {
  const std::size_t size = text.size();
  text.resize(size + 1 + below(random, 8));
  text.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(text.data()), size, text.size()));
  return text;
}

/// Another word in the place of one of `line`: from the vocabulary, from `other`, or with other bytes.
void change_word(std::string& line, const std::string& other, Random& random, const Vocabulary& vocabulary) {
  const std::vector<Word> words = words_of(line), others = words_of(other);
  if (words.empty()) return;
  const Word old = one_of(words, random);
  std::string text = line.substr(old.begin, old.size);
  switch (below(random, 3)) {
    case 0:
      text = mutated_bytes(text, random);
      break;
    case 1:
      if (!others.empty()) {
        const Word word = one_of(others, random);
        text = other.substr(word.begin, word.size);
        break;
      }
      [[fallthrough]];
    default:
      text = one_of(vocabulary.words, random);
  }
  line.replace(old.begin, old.size, text);
}

/// Puts what stands behind the first = of `other` behind that of `line`.
void change_value(std::string& line, const std::string& other) {
  const std::size_t here = line.find('='), there = other.find('=');
  if (here != std::string::npos && there != std::string::npos) line = line.substr(0, here) + other.substr(there);
}

void change_lines(std::vector<std::string>& lines, Random& random, const Vocabulary& vocabulary) {
  const auto place = [&] { return lines.begin() + static_cast<std::ptrdiff_t>(below(random, lines.size())); };
  const std::string some_line = one_of(lines, random);
  switch (below(random, 12)) {
    case 0:
      lines.erase(place());
      break;
    case 1:
      lines.insert(place(), some_line);
      break;
    case 2:
      std::swap(*place(), *place());
      break;
    case 3: {  // a stretch of lines once more
      const std::size_t first = below(random, lines.size());
      const std::size_t count = 1 + below(random, std::min<std::size_t>(lines.size() - first, 8));
      const std::vector<std::string> stretch(lines.begin() + static_cast<std::ptrdiff_t>(first),
                                             lines.begin() + static_cast<std::ptrdiff_t>(first + count));
      lines.insert(lines.end(), stretch.begin(), stretch.end());
      break;
    }
    case 4:
      lines.resize(1 + below(random, lines.size()));
      break;
    case 5:
      change_value(*place(), some_line);
      break;
    case 6:
      if (!vocabulary.lines.empty()) change_value(*place(), one_of(vocabulary.lines, random));
      break;
    case 7:
    case 8:
      if (!vocabulary.lines.empty()) lines.insert(place() + 1, one_of(vocabulary.lines, random));
      break;
    default:
      change_word(*place(), some_line, random, vocabulary);
  }
}

}  // namespace

std::size_t mutate_text(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed,
                        const Vocabulary& vocabulary) {
  Random random(seed);
  std::vector<std::string> lines = lines_of(text_of_input(data, size));
  if (lines.empty() || below(random, 8) == 0) return LLVMFuzzerMutate(data, size, room);
  for (std::size_t k = 1 + below(random, 3); k > 0 && !lines.empty(); --k) change_lines(lines, random, vocabulary);
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  text.resize(std::min(text.size(), room));
  std::copy(text.begin(), text.end(), data);
  return text.size();
}

}  // namespace tailwater
