// Parts of a fuzz target. Each target is a file with LLVMFuzzerTestOneInput, and with LLVMFuzzerCustomMutator where
// random bytes would not reach much code. With libFuzzer (preset `fuzz`) a target searches for inputs that reach new
// code. With the driver of replay.cpp it is a test, which repeats the corpus and a few mutations of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

extern "C" {
/// Tests one input; aborts on a finding.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
/// Changes the input in its place, to at most `room` bytes; returns its new size.
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed);
/// Mutates bytes: libFuzzer's function, or that of replay.cpp.
std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t room);
}

namespace tailwater {

inline std::string text_of_input(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Ends the fuzzer with a finding.
[[noreturn]] inline void finding(std::string_view what, std::string_view about) {
  std::fprintf(stderr, "finding: %.*s\n%.*s\n", static_cast<int>(what.size()), what.data(),
               static_cast<int>(about.size()), about.data());
  std::abort();
}

}  // namespace tailwater
