// Selects among numbers eight at a time, without a branch. If the choice is as good as random, the processor would
// mispredict a branch every other time.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace tailwater {

/// Bit n is set where a comparison holds in lane n, for lanes of any kind and number.
template <class Truths>
unsigned bits_of(Truths holds) {
#if defined(__AVX__)
  if constexpr (sizeof(Truths) == 32 && sizeof(holds[0]) == 4) {
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(holds)));
  }
  if constexpr (sizeof(Truths) == 32 && sizeof(holds[0]) == 8) {
    return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(holds)));
  }
#endif
  constexpr int count = sizeof(Truths) / sizeof(holds[0]);
  unsigned bits = 0;
  for (int n = 0; n < count; ++n) bits |= static_cast<unsigned>(holds[n] != 0) << n;
  return bits;
}

/// Numbers per batch, for any width of a register.
inline constexpr int batch_size = 8;
using IndexBatch = std::int32_t __attribute__((vector_size(4 * batch_size)));
using FloatBatch = float __attribute__((vector_size(4 * batch_size)));

/// The first `count` bits, or all bits if there are more numbers than in a batch.
inline unsigned first_bits(std::size_t count) { return (1U << std::min<std::size_t>(count, batch_size)) - 1U; }

/// The numbers of a batch.
template <class Batch, class Number>
Batch batch_at(const Number* numbers) {
  Batch all;
  std::memcpy(&all, numbers, sizeof(all));
  return all;
}

#if defined(__AVX2__)
/// For each set of numbers, as bits: their places in the batch, moved to the front, a byte each.
inline constexpr std::array<std::uint64_t, 1 << batch_size> places_of_bits = [] {
  std::array<std::uint64_t, 1 << batch_size> places{};
  for (unsigned bits = 0; bits < places.size(); ++bits) {
    int count = 0;
    for (unsigned n = 0; n < batch_size; ++n) {
      if ((bits >> n & 1U) != 0) places[bits] |= static_cast<std::uint64_t>(n) << (8 * count++);
    }
  }
  return places;
}();
#endif

/// Writes the numbers of four bytes of a batch whose bit is set, one behind the other; it may overwrite as many entries
/// as a batch has. Returns the end of the selected numbers.
template <class Number>
Number* write_chosen(const Number* numbers, unsigned bits, Number* chosen) {
  static_assert(sizeof(Number) == 4);
#if defined(__AVX2__)
  const __m256i places = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<std::int64_t>(places_of_bits[bits])));
  const __m256i ordered = _mm256_permutevar8x32_epi32(batch_at<__m256i>(numbers), places);
  std::memcpy(chosen, &ordered, sizeof(ordered));
  return chosen + std::popcount(bits);
#else
  for (; bits != 0; bits &= bits - 1) *chosen++ = numbers[std::countr_zero(bits)];
  return chosen;
#endif
}

}  // namespace tailwater
