// Several numbers side by side, on which the processor works at once. A loop over the pairs of a row that takes them in
// lanes reads as the one pair by pair. Compilers do not turn one into the other: that would change the order of sums.
// Pairs are computed in single precision; what is conserved or nearly cancels is summed in double
// (docs/theory/neighbours.md).
// The instructions that gather are not used, because on many processors they are slower than single loads.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#if defined(__AVX__)
#include <immintrin.h>
#endif

#include "base/batch.h"
#include "base/for_each.h"
#include "base/prefetch.h"
#include "base/vec.h"

namespace tailwater {

#if defined(__AVX__)
inline constexpr int lane_count = 8;  // not sixteen with AVX-512, for which many processors lower their clock
#else
inline constexpr int lane_count = 4;
#endif

/// As wide as a register. Arithmetic, comparison and ?: act on each lane.
using Lanes = float __attribute__((vector_size(4 * lane_count)));
using LaneTruths = decltype(Lanes{} < Lanes{});
/// Integers modulo 2^32.
using IntegerLanes = std::uint32_t __attribute__((vector_size(4 * lane_count)));

/// The same in double precision, half as many.
inline constexpr int double_lane_count = lane_count / 2;
using DoubleLanes = double __attribute__((vector_size(8 * double_lane_count)));

/// a b + c. In a sum of two products the compiler may round either, and it chooses anew wherever a loop is compiled, as
/// for whole groups and for a row's rest. What must be the same for both particles of a pair says which.
inline Lanes fused(Lanes a, Lanes b, Lanes c) {
#if defined(__AVX__) && defined(__FMA__)
  return _mm256_fmadd_ps(a, b, c);
#else
  return a * b + c;
#endif
}

/// A vector in each lane.
template <int Dim>
struct VecLanes {
  Lanes at[Dim];

  Lanes dot(const VecLanes& other) const {
    Lanes sum = at[0] * other.at[0];
    for (int d = 1; d < Dim; ++d) sum = fused(at[d], other.at[d], sum);
    return sum;
  }
};

/// A matrix in each lane.
template <int Dim>
struct MatLanes {
  VecLanes<Dim> column[Dim];

  VecLanes<Dim> times(const VecLanes<Dim>& x) const {
    VecLanes<Dim> product;
    for (int a = 0; a < Dim; ++a) {
      product.at[a] = column[0].at[a] * x.at[0];
      for (int b = 1; b < Dim; ++b) product.at[a] = fused(column[b].at[a], x.at[b], product.at[a]);
    }
    return product;
  }
};

/// A symmetric matrix in each lane, packed as in operators/symmetric.h.
template <int Dim>
struct SymmetricLanes {
  std::array<Lanes, symmetric_size<Dim>> packed;

  /// Where entry (a, b) is.
  static constexpr int place(int a, int b) {
    return std::min(a, b) * (2 * Dim - 1 - std::min(a, b)) / 2 + std::max(a, b);
  }
  const Lanes& operator()(int a, int b) const { return packed[place(a, b)]; }

  VecLanes<Dim> times(const VecLanes<Dim>& x) const {
    VecLanes<Dim> product;
    for (int a = 0; a < Dim; ++a) {
      product.at[a] = packed[place(a, 0)] * x.at[0];
      for (int b = 1; b < Dim; ++b) product.at[a] = fused(packed[place(a, b)], x.at[b], product.at[a]);
    }
    return product;
  }
  /// Adds x y, of which the product is symmetric. Loops over a triangle would leave the sums in memory.
  void add(const VecLanes<Dim>& x, const VecLanes<Dim>& y) {
    for (int a = 0; a < Dim; ++a) {
      for (int b = 0; b < Dim; ++b) {
        if (b >= a) packed[place(a, b)] = fused(x.at[a], y.at[b], packed[place(a, b)]);
      }
    }
  }
};

inline Lanes in_all_lanes(double value) { return Lanes{} + static_cast<float>(value); }

#if defined(__AVX__)
inline constexpr LaneTruths lane_numbers{0, 1, 2, 3, 4, 5, 6, 7};
#else
inline constexpr LaneTruths lane_numbers{0, 1, 2, 3};
#endif

inline Lanes min_of(Lanes a, Lanes b) {
#if defined(__AVX__)
  return _mm256_min_ps(a, b);
#else
  return a < b ? a : b;
#endif
}
inline Lanes max_of(Lanes a, Lanes b) {
#if defined(__AVX__)
  return _mm256_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}
inline double max_of(double a, double b) { return a > b ? a : b; }

inline Lanes sqrt_of(Lanes lanes) {
#if defined(__AVX__)
  return _mm256_sqrt_ps(lanes);
#else
  for (int n = 0; n < lane_count; ++n) lanes[n] = std::sqrt(lanes[n]);
  return lanes;
#endif
}
inline double sqrt_of(double number) { return std::sqrt(number); }

/// Whether a comparison holds in some lane.
inline bool any_of(LaneTruths holds) { return bits_of(holds) != 0; }

/// A loop over lanes would leave them in memory, and with them what a loop over pairs adds up.
inline double sum_of(DoubleLanes lanes) {
#if defined(__AVX__)
  const __m128d halves = _mm256_castpd256_pd128(lanes) + _mm256_extractf128_pd(lanes, 1);
  return halves[0] + halves[1];
#else
  return lanes[0] + lanes[1];
#endif
}

/// The first and the second half of the lanes, in double precision.
inline std::pair<DoubleLanes, DoubleLanes> in_double_precision(Lanes lanes) {
#if defined(__AVX__)
  return {_mm256_cvtps_pd(_mm256_castps256_ps128(lanes)), _mm256_cvtps_pd(_mm256_extractf128_ps(lanes, 1))};
#else
  return {__builtin_convertvector(__builtin_shufflevector(lanes, lanes, 0, 1), DoubleLanes),
          __builtin_convertvector(__builtin_shufflevector(lanes, lanes, 2, 3), DoubleLanes)};
#endif
}

/// The sum of all lanes, added up in double precision.
inline double sum_of(Lanes lanes) {
  const auto [low, high] = in_double_precision(lanes);
  return sum_of(low + high);
}

inline double largest_of(Lanes lanes) {
  float largest = lanes[0];
  for (int n = 1; n < lane_count; ++n) largest = lanes[n] > largest ? lanes[n] : largest;
  return largest;
}

template <int Dim>
Vec<Dim> sum_of(const VecLanes<Dim>& lanes) {
  Vec<Dim> sum;
  for (int d = 0; d < Dim; ++d) sum[d] = sum_of(lanes.at[d]);
  return sum;
}

template <int Dim>
Mat<Dim> sum_of(const MatLanes<Dim>& lanes) {
  Mat<Dim> sum;
  for (int b = 0; b < Dim; ++b) sum.col(b) = sum_of(lanes.column[b]);
  return sum;
}

template <int Dim>
Mat<Dim> sum_of(const SymmetricLanes<Dim>& lanes) {
  Mat<Dim> sum;
  for (int b = 0; b < Dim; ++b) {
    for (int a = b; a < Dim; ++a) sum(a, b) = sum(b, a) = sum_of(lanes(a, b));
  }
  return sum;
}

/// A sum in double precision, for what is conserved and for what nearly cancels.
class LaneSum {
 public:
  void operator+=(Lanes terms) {
    const auto [low, high] = in_double_precision(terms);
    low_ += low;
    high_ += high;
  }
  void operator-=(Lanes terms) { *this += -terms; }

  double total() const { return sum_of(low_ + high_); }

 private:
  DoubleLanes low_{};
  DoubleLanes high_{};
};

template <int Dim>
struct VecSum {
  LaneSum at[Dim];

  Vec<Dim> total() const {
    Vec<Dim> total;
    for (int d = 0; d < Dim; ++d) total[d] = at[d].total();
    return total;
  }
};

/// Up to four numbers of a particle, which are loaded together.
struct alignas(16) Four {
  std::array<float, 4> at{};
};

/// A vector field in single precision.
template <int Dim>
std::vector<Four> in_fours(std::span<const Vec<Dim>> field) {
  std::vector<Four> fours(field.size());
  for_each(field.size(), [&](std::size_t i) {
    for (int d = 0; d < Dim; ++d) fours[i].at[d] = static_cast<float>(field[i][d]);
  });
  return fours;
}

/// What each lane reads of an array that has several numbers per entry.
class LaneIndices {
 public:
  explicit LaneIndices(IntegerLanes indices) { std::memcpy(index_.data(), &indices, sizeof(indices)); }

  Lanes operator()(const float* array) const { return read(array, std::make_index_sequence<lane_count>()); }
  /// Rounded to single precision.
  Lanes operator()(const double* array) const { return read(array, std::make_index_sequence<double_lane_count>()); }

  /// The numbers of entries of nothing but numbers of four bytes, as many as fill whole registers.
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
  [[gnu::always_inline]] VecLanes<Dim> vectors(const Four* field) const {
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
    // In registers: what is written in halves and read as a whole has to wait for both to reach the cache.
    return __builtin_shufflevector(__builtin_convertvector(low, Half), __builtin_convertvector(high, Half), Lane...,
                                   (Lane + double_lane_count)...);
  }

  /// Four numbers that follow each other, of entries that have `Stride` of them. They are loaded together: loads are
  /// what loops over pairs have most of.
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

/// Some entries of a row: as many as there are lanes, or the rest of a row. Then lanes left over have the last entry's
/// neighbour, so that they hold numbers with which one can calculate, and 0 where a weight is loaded.
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
  /// 0 in lanes left over.
  Lanes load(const float* array) const {
    fetch_ahead(array + begin);
    return load<Lanes>(array);
  }
  /// `lanes` with 0 in those left over.
  Lanes only(Lanes lanes) const {
    if constexpr (!is_full) lanes = holds() ? lanes : Lanes{};
    return lanes;
  }
  /// Writes to `place` and behind it. Returns what was written, with 0 in lanes left over.
  Lanes store(Lanes lanes, float* place) const {
    if constexpr (is_full) {
      std::memcpy(place, &lanes, sizeof(lanes));
    } else {
      for (int n = 0; n < count; ++n) place[n] = lanes[n];
    }
    return only(lanes);
  }

 private:
  /// Of which lanes there are entries.
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

/// Calls body(range) for the entries begin .. end, in their order. Mark the body as always_inline: compilers do not
/// see by themselves that its sums then stay in registers, which halves the time of a loop.
template <class Body>
[[gnu::always_inline]] inline void for_each_lanes(std::size_t begin, std::size_t end, Body&& body) {
  constexpr std::size_t width = lane_count;
  for (; begin + width <= end; begin += width) body(LaneRange<true>{begin, lane_count});
  if (begin < end) body(LaneRange<false>{begin, static_cast<int>(end - begin)});
}

}  // namespace tailwater
