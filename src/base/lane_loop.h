// Loops over the entries of a row that process as many entries at once as there are lanes (lanes.h), and their loads.
// Such a loop reads like a loop over single entries. Compilers do not vectorise that loop themselves, because it would
// change the order of sums. Gather instructions are not used, because on many processors they are slower than single
// loads.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "base/for_each.h"
#include "base/lanes.h"
#include "base/prefetch.h"

namespace tailwater {

/// Up to four numbers of a particle, which are loaded together.
struct alignas(16) Float4 {
  std::array<float, 4> at{};
};

/// Subtracts the vector of one particle in each lane.
template <int Dim>
VecLanes<Dim> operator-(VecLanes<Dim> vectors, const Float4& own) {
  for (int d = 0; d < Dim; ++d) vectors.at[d] -= own.at[d];
  return vectors;
}

/// A vector field in single precision.
template <int Dim>
std::vector<Float4> as_float4(std::span<const Vec<Dim>> field) {
  std::vector<Float4> fours(field.size());
  for_each(field.size(), [&](std::size_t i) {
    for (int d = 0; d < Dim; ++d) fours[i].at[d] = static_cast<float>(field[i][d]);
  });
  return fours;
}

/// Indices with which each lane reads an array, which may have several numbers per entry.
class LaneIndices {
 public:
  explicit LaneIndices(IntegerLanes indices) { std::memcpy(index_.data(), &indices, sizeof(indices)); }

  Lanes operator()(const float* array) const { return read(array, std::make_index_sequence<lane_count>()); }
  /// Values rounded to single precision.
  Lanes operator()(const double* array) const { return read(array, std::make_index_sequence<double_lane_count>()); }

  /// All numbers of entries that consist of numbers of four bytes and fill whole registers.
  template <class Entry>
  [[gnu::always_inline]] std::array<Lanes, sizeof(Entry) / 4> numbers(const Entry* entries) const {
    constexpr int count = sizeof(Entry) / 4;
    static_assert(count % 4 == 0);
    const auto* const numbers = reinterpret_cast<const float*>(entries);
    std::array<Lanes, count> lanes;
    for (int n = 0; n < count; n += 4) read_four<count>(numbers + n, &lanes[n]);
    return lanes;
  }

  template <int Dim>
  [[gnu::always_inline]] VecLanes<Dim> vectors(const Float4* field) const {
    const std::array<Lanes, 4> lanes = numbers(field);
    VecLanes<Dim> vectors;
    for (int d = 0; d < Dim; ++d) vectors.at[d] = lanes[d];
    return vectors;
  }

 private:
  template <std::size_t... Lane>
  Lanes read(const float* from, std::index_sequence<Lane...>) const {
    return Lanes{from[index_[Lane]]...};
  }
  template <std::size_t... Lane>
  Lanes read(const double* from, std::index_sequence<Lane...>) const {
    const DoubleLanes low{from[index_[Lane]]...};
    const DoubleLanes high{from[index_[Lane + double_lane_count]]...};
    using Half = float __attribute__((vector_size(4 * double_lane_count)));
    // Done in registers: a value that is written in halves and read as a whole would wait until both reach the cache.
    return __builtin_shufflevector(__builtin_convertvector(low, Half), __builtin_convertvector(high, Half), Lane...,
                                   (Lane + double_lane_count)...);
  }

  /// Four consecutive numbers of entries with `Stride` numbers each. They are loaded together, because most
  /// instructions of loops over pairs are loads.
  template <int Stride>
  [[gnu::always_inline]] void read_four(const float* from, Lanes* lanes) const {
    using Quarter = float __attribute__((vector_size(16)));
    const auto load = [&](int n) {
      Quarter four;
      std::memcpy(&four, from + Stride * static_cast<std::ptrdiff_t>(index_[n]), sizeof(four));
      return four;
    };
#if defined(__AVX__)
    __m256 rows[4];
    for (int n = 0; n < 4; ++n) rows[n] = _mm256_insertf128_ps(_mm256_castps128_ps256(load(n)), load(n + 4), 1);
    const __m256 low_even = _mm256_unpacklo_ps(rows[0], rows[1]);
    const __m256 high_even = _mm256_unpackhi_ps(rows[0], rows[1]);
    const __m256 low_odd = _mm256_unpacklo_ps(rows[2], rows[3]);
    const __m256 high_odd = _mm256_unpackhi_ps(rows[2], rows[3]);
    lanes[0] = _mm256_shuffle_ps(low_even, low_odd, 0x44);
    lanes[1] = _mm256_shuffle_ps(low_even, low_odd, 0xEE);
    lanes[2] = _mm256_shuffle_ps(high_even, high_odd, 0x44);
    lanes[3] = _mm256_shuffle_ps(high_even, high_odd, 0xEE);
#else
    const Quarter low_even = __builtin_shufflevector(load(0), load(1), 0, 4, 1, 5);
    const Quarter high_even = __builtin_shufflevector(load(0), load(1), 2, 6, 3, 7);
    const Quarter low_odd = __builtin_shufflevector(load(2), load(3), 0, 4, 1, 5);
    const Quarter high_odd = __builtin_shufflevector(load(2), load(3), 2, 6, 3, 7);
    lanes[0] = __builtin_shufflevector(low_even, low_odd, 0, 1, 4, 5);
    lanes[1] = __builtin_shufflevector(low_even, low_odd, 2, 3, 6, 7);
    lanes[2] = __builtin_shufflevector(high_even, high_odd, 0, 1, 4, 5);
    lanes[3] = __builtin_shufflevector(high_even, high_odd, 2, 3, 6, 7);
#endif
  }

  std::array<std::int32_t, lane_count> index_;
};

/// A range of entries of a row: as many as there are lanes, or the rest of a row. In the latter case unused lanes have
/// the neighbour of the last entry, so that they hold valid numbers, and 0 as weight.
template <bool is_full>
struct LaneRange {
  std::size_t begin;
  int count;

  std::size_t entry(int n) const { return begin + (is_full ? n : std::min(n, count - 1)); }

  /// The neighbours of the entries.
  LaneIndices neighbours(const std::int32_t* j) const {
    fetch_ahead(j + begin);
    auto indices = load<IntegerLanes>(j);
    if constexpr (!is_full)
      indices = holds() ? indices : IntegerLanes{} + static_cast<std::uint32_t>(j[entry(count - 1)]);
    return LaneIndices(indices);
  }
  /// 0 in unused lanes.
  Lanes load(const float* array) const {
    fetch_ahead(array + begin);
    return load<Lanes>(array);
  }
  /// `lanes` with 0 in unused lanes.
  Lanes only(Lanes lanes) const {
    if constexpr (!is_full) lanes = holds() ? lanes : Lanes{};
    return lanes;
  }
  /// Writes to `place` and behind it. Returns the written values, with 0 in unused lanes.
  Lanes store(Lanes lanes, float* place) const {
    if constexpr (is_full) {
      std::memcpy(place, &lanes, sizeof(lanes));
    } else {
      for (int n = 0; n < count; ++n) place[n] = lanes[n];
    }
    return only(lanes);
  }

 private:
  /// Whether each lane has an entry.
  LaneTruths holds() const { return lane_numbers < count; }

  template <class Wide, class Number>
  Wide load(const Number* array) const {
    Wide lanes{};
    if constexpr (is_full) {
      std::memcpy(&lanes, array + begin, sizeof(lanes));
    } else {
#if defined(__AVX__)
      lanes = reinterpret_cast<Wide>(
          _mm256_maskload_ps(reinterpret_cast<const float*>(array + begin), reinterpret_cast<__m256i>(holds())));
#else
      std::memcpy(&lanes, array + begin, sizeof(Number) * count);
#endif
    }
    return lanes;
  }
};

/// Calls body(range) for the entries begin .. end, in their order. The body and all its callees are compiled into the
/// loop (flatten): its sums then stay in registers, which halves the time. Compilers do not do this by themselves.
template <class Body>
[[gnu::always_inline, gnu::flatten]] inline void for_each_lanes(std::size_t begin, std::size_t end, Body&& body) {
  constexpr std::size_t width = lane_count;
  for (; begin + width <= end; begin += width) body(LaneRange<true>{begin, lane_count});
  if (begin < end) body(LaneRange<false>{begin, static_cast<int>(end - begin)});
}

}  // namespace tailwater
