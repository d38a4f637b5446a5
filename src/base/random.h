// Random numbers without a state: the same on every machine and rank, and in every order of evaluation.
#pragma once

#include <cstdint>

namespace tailwater {

/// Number in [-1, 1) that depends only on the arguments (SplitMix64, Steele, Lea & Flood 2014). The standard library's
/// distributions differ between machines. `which` is one of three numbers that belong to `item`.
inline double random_number(std::uint64_t seed, std::uint64_t item, int which) {
  std::uint64_t z = (seed * 0x9e3779b97f4a7c15) ^ (item * 3 + static_cast<std::uint64_t>(which));
  for (int round = 0; round < 2; ++round) {
    z += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    z ^= z >> 31;
  }
  return static_cast<double>(z >> 11) * 0x1p-52 - 1.0;
}

}  // namespace tailwater
