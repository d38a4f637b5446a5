// Makes a wrong checkpoint with a valid checksum: mutate_checkpoint FROM TO SEED. Prints the changes. The mutations
// follow the structure of a checkpoint, since the checksum detects damaged bytes before anything is read.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "io/hdf5_image.h"
#include "io/sealed_file.h"
#include "support/checkpoint_sets.h"

namespace tailwater {
namespace {

constexpr std::array strange_numbers{0.0,
                                     -0.0,
                                     -1.0,
                                     1.0,
                                     3.0,
                                     1e-308,
                                     1e-15,
                                     1e9,
                                     1e15,
                                     1e300,
                                     -1e300,
                                     std::numeric_limits<double>::infinity(),
                                     std::numeric_limits<double>::quiet_NaN()};

using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t count) { return static_cast<std::size_t>(random() % count); }

template <class Value>
Value strange(Random& random) {
  if constexpr (std::is_same_v<Value, double>) {
    return strange_numbers[below(random, strange_numbers.size())];
  } else {
    using Limits = std::numeric_limits<Value>;
    const std::array<Value, 6> values{Limits::min(), Limits::max(), Value(0), Value(1), Value(-1), Value(100)};
    return values[below(random, values.size())];
  }
}

/// Changes some values, or their number.
template <class Value>
std::string mutate(std::vector<Value>& values, Random& random) {
  const std::size_t what = below(random, 8);
  if (what == 6) {
    values.resize(below(random, 2) == 0 ? values.size() / 2 : values.size() + 1);
    return fmt::format("has {} values", values.size());
  }
  if (what == 7 || values.empty()) {
    values.clear();
    return "is empty";
  }
  std::string told;
  for (std::size_t k = what < 3 ? 1 : values.size() / 10 + 1; k > 0; --k) {
    const std::size_t at = below(random, values.size());
    values[at] = strange<Value>(random);
    told = fmt::format("[{}] = {}", at, values[at]);
  }
  return told;
}

/// Replaces a number in a text, changes some bytes, or cuts off the end.
std::string mutate_text(std::string& text, Random& random) {
  if (text.empty()) return "is empty";
  const std::size_t what = below(random, 5);
  if (what == 4) {
    text.resize(below(random, text.size()));
    return fmt::format("has {} bytes", text.size());
  }
  if (what == 3) {
    const std::size_t at = below(random, text.size());
    text[at] = static_cast<char>(below(random, 256));
    return fmt::format("byte {} = {}", at, static_cast<int>(text[at]));
  }
  constexpr std::array numbers{"0",
                               "-1",
                               "1e300",
                               "-1e300",
                               "9223372036854775807",
                               "-9223372036854775808",
                               "1e-308",
                               "null",
                               "\"text\"",
                               "[]",
                               "{}",
                               "true",
                               "1",
                               "17"};
  constexpr std::string_view digits = "0123456789.e+-";
  const std::size_t begin = text.find_first_of("0123456789", below(random, text.size()));
  if (begin == std::string::npos) return "is as it was";
  const std::size_t end = std::min(text.find_first_not_of(digits, begin), text.size());
  const char* number = numbers[below(random, numbers.size())];
  text.replace(begin, end - begin, number);
  return fmt::format("byte {}: {}", begin, number);
}

/// Copies a dataset, writes it with another type, or omits it.
template <class Value>
std::string copy(const Hdf5Reader& from, Hdf5Writer& to, const Dataset& set, bool is_mutated, Random& random) {
  std::vector<Value> values = from.get<Value>(set.name);
  std::size_t columns = set.columns;
  std::string told;
  if (is_mutated) {
    const std::size_t what = below(random, 10);
    if (what == 0) return "is missing";
    if (what == 1) {
      to.put(set.name, "text");
      return "is a text";
    }
    if (what == 2) {
      to.put<double>(set.name, std::span<const double>(std::vector<double>(values.begin(), values.end())), columns);
      return "is of real numbers";
    }
    told = mutate(values, random);
    if (values.size() % columns != 0) columns = 1;
  }
  to.put(set.name, std::span<const Value>(values), columns);
  return told;
}

std::string copy_set(const Hdf5Reader& from, Hdf5Writer& to, const Dataset& set, bool is_mutated, Random& random) {
  switch (set.type) {
    case Type::real:
      return copy<double>(from, to, set, is_mutated, random);
    case Type::whole64:
      return copy<std::int64_t>(from, to, set, is_mutated, random);
    case Type::whole32:
      return copy<std::int32_t>(from, to, set, is_mutated, random);
    case Type::byte:
      return copy<std::uint8_t>(from, to, set, is_mutated, random);
    case Type::text:
      break;
  }
  std::string text = from.text(set.name);
  const std::string told = is_mutated ? mutate_text(text, random) : "";
  to.put(set.name, text);
  return told;
}

void mutate_checkpoint(const char* from, const char* to, std::uint64_t seed) {
  const SealedFile file = read_sealed_file(from);
  const Hdf5Reader reader(file.body);
  Hdf5Writer writer;
  Random random(seed);
  const std::size_t first = below(random, datasets.size());
  const std::size_t second = below(random, 4) == 0 ? below(random, datasets.size()) : first;
  for (std::size_t k = 0; k < datasets.size(); ++k) {
    const bool is_mutated = k == first || k == second;
    const std::string told = copy_set(reader, writer, datasets[k], is_mutated, random);
    if (is_mutated) fmt::print("'{}' {}\n", datasets[k].name, told);
  }
  write_sealed_file(to, file, writer.image());
}

}  // namespace
}  // namespace tailwater

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "usage: mutate_checkpoint FROM TO SEED\n");
    return 2;
  }
  tailwater::mutate_checkpoint(argv[1], argv[2], std::strtoull(argv[3], nullptr, 10));
  return 0;
}
