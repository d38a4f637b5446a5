// Several numbers side by side, on which the processor works at once. A loop over the pairs of a row that takes them in
// lanes reads as the one pair by pair. Compilers do not turn one into the other: that would change the order of sums.
// The instructions that gather are not used, because on many processors they are slower than single loads.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#if defined(__AVX__)
#include <immintrin.h>
#endif

#include "base/vec.h"

namespace tailwater {

#if defined(__AVX__)
inline constexpr int lane_count = 4;  // also with AVX-512, for which many processors lower their clock
#else
inline constexpr int lane_count = 2;
#endif

/// As wide as a register. Arithmetic, comparison and ?: act on each lane.
using Lanes = double __attribute__((vector_size(8 * lane_count)));

/// A vector in each lane.
template <int Dim>
struct VecLanes {
  Lanes at[Dim];

  Lanes dot(const VecLanes& other) const {
    Lanes sum = at[0] * other.at[0];
    for (int d = 1; d < Dim; ++d) sum += at[d] * other.at[d];
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
      for (int b = 1; b < Dim; ++b) product.at[a] += column[b].at[a] * x.at[b];
    }
    return product;
  }
};

inline Lanes in_all_lanes(double value) { return Lanes{} + value; }

#if defined(__AVX__)
inline constexpr Lanes lane_numbers{0.0, 1.0, 2.0, 3.0};
#else
inline constexpr Lanes lane_numbers{0.0, 1.0};
#endif

inline Lanes min_of(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes max_of(Lanes a, Lanes b) { return a > b ? a : b; }
inline double max_of(double a, double b) { return a > b ? a : b; }

inline Lanes sqrt_of(Lanes lanes) {
#if defined(__AVX__)
  return _mm256_sqrt_pd(lanes);
#else
  for (int n = 0; n < lane_count; ++n) lanes[n] = std::sqrt(lanes[n]);
  return lanes;
#endif
}
inline double sqrt_of(double number) { return std::sqrt(number); }

/// Numbers in single precision, as arrays that are read often may keep them.
using SingleLanes = float __attribute__((vector_size(4 * lane_count)));

using LaneTruths = decltype(Lanes{} < Lanes{});

/// Bit n is set where a comparison holds in lane n.
inline unsigned bits_of(LaneTruths holds) {
#if defined(__AVX__)
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(holds)));
#else
  unsigned bits = 0;
  for (int n = 0; n < lane_count; ++n) bits |= static_cast<unsigned>(holds[n] != 0) << n;
  return bits;
#endif
}

/// Whether a comparison holds in some lane.
inline bool any_of(LaneTruths holds) { return bits_of(holds) != 0; }

/// The sum of all lanes, in their order.
inline double sum_of(Lanes lanes) {
  double sum = lanes[0];
  for (int n = 1; n < lane_count; ++n) sum += lanes[n];
  return sum;
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

/// The same of symmetric matrices of which only the entries on and below the diagonal were summed up.
template <int Dim>
Mat<Dim> sum_of_lower(const MatLanes<Dim>& lanes) {
  Mat<Dim> sum;
  for (int b = 0; b < Dim; ++b) {
    for (int a = b; a < Dim; ++a) sum(a, b) = sum(b, a) = sum_of(lanes.column[b].at[a]);
  }
  return sum;
}

/// What each lane reads of an array that has several numbers per entry.
class LaneIndices {
 public:
  template <class Index>
  explicit LaneIndices(Index&& index) {
    for (int n = 0; n < lane_count; ++n) index_[n] = static_cast<std::ptrdiff_t>(index(n));
  }

  Lanes operator()(const double* array) const { return read<1>(array); }

  /// Where holds(index) is true.
  template <class Condition>
  LaneTruths where(Condition&& holds) const {
    LaneTruths truths;
    for (int n = 0; n < lane_count; ++n) truths[n] = holds(index_[n]) ? -1 : 0;
    return truths;
  }

  /// The numbers of entries that have `Size` of them one behind the other, a multiple of four.
  template <int Size>
  [[gnu::always_inline]] std::array<Lanes, Size> record(const double* numbers) const {
    static_assert(Size % 4 == 0);
    std::array<Lanes, Size> lanes;
    for (int n = 0; n < Size; n += 4) read_four<Size>(numbers + n, &lanes[n]);
    return lanes;
  }

  template <int Dim>
  VecLanes<Dim> operator()(const Vec<Dim>* array) const {
    const auto* const numbers = reinterpret_cast<const double*>(array);
    VecLanes<Dim> lanes;
    read_two<Dim>(numbers, lanes.at[0], lanes.at[1]);
    if constexpr (Dim == 3) lanes.at[2] = read<Dim>(numbers + 2);
    return lanes;
  }

  template <int Dim>
  MatLanes<Dim> operator()(const Mat<Dim>* array) const {
    const auto* const numbers = reinterpret_cast<const double*>(array);  // column by column
    MatLanes<Dim> lanes;
    for (int b = 0; b < Dim; ++b) {
      VecLanes<Dim>& column = lanes.column[b];
      read_two<Dim * Dim>(numbers + Dim * b, column.at[0], column.at[1]);
      if constexpr (Dim == 3) column.at[2] = read<Dim * Dim>(numbers + Dim * b + 2);
    }
    return lanes;
  }
  /// The same of symmetric matrices.
  template <int Dim>
  MatLanes<Dim> symmetric(const Mat<Dim>* array) const {
    const auto* const numbers = reinterpret_cast<const double*>(array);
    MatLanes<Dim> lanes;
    read_two<Dim * Dim>(numbers, lanes.column[0].at[0], lanes.column[0].at[1]);
    if constexpr (Dim == 2) {
      lanes.column[1].at[1] = read<Dim * Dim>(numbers + 3);
    } else {
      lanes.column[0].at[2] = read<Dim * Dim>(numbers + 2);
      read_two<Dim * Dim>(numbers + 4, lanes.column[1].at[1], lanes.column[1].at[2]);
      lanes.column[2].at[2] = read<Dim * Dim>(numbers + 8);
    }
    for (int b = 1; b < Dim; ++b) {
      for (int a = 0; a < b; ++a) lanes.column[b].at[a] = lanes.column[a].at[b];
    }
    return lanes;
  }

 private:
  /// One number of each entry of an array whose entries have `Stride` numbers.
  template <int Stride>
  Lanes read(const double* from) const {
    return read<Stride>(from, std::make_index_sequence<lane_count>());
  }
  template <int Stride, std::size_t... Lane>
  Lanes read(const double* from, std::index_sequence<Lane...>) const {
    return Lanes{from[Stride * index_[Lane]]...};
  }

  /// A number of each entry and the one that follows it. They are loaded together: loads are what loops over pairs
  /// have most of.
  template <int Stride>
  void read_two(const double* from, Lanes& first, Lanes& second) const {
    using Two = double __attribute__((vector_size(16)));
    Two two[lane_count];
    for (int n = 0; n < lane_count; ++n) std::memcpy(&two[n], from + Stride * index_[n], sizeof(Two));
#if defined(__AVX__)
    const Lanes even = __builtin_shufflevector(two[0], two[2], 0, 1, 2, 3);
    const Lanes odd = __builtin_shufflevector(two[1], two[3], 0, 1, 2, 3);
    first = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
    second = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
#else
    first = __builtin_shufflevector(two[0], two[1], 0, 2);
    second = __builtin_shufflevector(two[0], two[1], 1, 3);
#endif
  }

  /// The same of four numbers.
  template <int Stride>
  void read_four(const double* from, Lanes* lanes) const {
#if defined(__AVX__)
    Lanes four[lane_count];
    for (int n = 0; n < lane_count; ++n) std::memcpy(&four[n], from + Stride * index_[n], sizeof(Lanes));
    const Lanes low_even = __builtin_shufflevector(four[0], four[1], 0, 4, 2, 6);
    const Lanes low_odd = __builtin_shufflevector(four[0], four[1], 1, 5, 3, 7);
    const Lanes high_even = __builtin_shufflevector(four[2], four[3], 0, 4, 2, 6);
    const Lanes high_odd = __builtin_shufflevector(four[2], four[3], 1, 5, 3, 7);
    lanes[0] = __builtin_shufflevector(low_even, high_even, 0, 1, 4, 5);
    lanes[1] = __builtin_shufflevector(low_odd, high_odd, 0, 1, 4, 5);
    lanes[2] = __builtin_shufflevector(low_even, high_even, 2, 3, 6, 7);
    lanes[3] = __builtin_shufflevector(low_odd, high_odd, 2, 3, 6, 7);
#else
    for (int n = 0; n < 4; ++n) lanes[n] = read<Stride>(from + n);
#endif
  }

  std::array<std::ptrdiff_t, lane_count> index_;
};

/// Some entries of a row: as many as there are lanes, or the rest of a row. Then the last entry is in the lanes left
/// over too, so that they hold numbers with which one can calculate.
template <bool is_full>
struct LaneRange {
  std::size_t begin;
  int count;

  std::size_t entry(int n) const { return begin + (is_full ? n : std::min(n, count - 1)); }

  LaneIndices entries() const {
    return LaneIndices([this](int n) { return entry(n); });
  }
  /// The neighbours of the entries.
  LaneIndices neighbours(const std::int32_t* j) const {
    return LaneIndices([this, j](int n) { return j[entry(n)]; });
  }
  Lanes load(const double* array) const {
    if constexpr (!is_full) return entries()(array);
    Lanes lanes;
    std::memcpy(&lanes, array + begin, sizeof(lanes));
    return lanes;
  }
  /// `lanes` with 0 in those left over.
  Lanes only(Lanes lanes) const {
    if constexpr (!is_full) lanes = lane_numbers < in_all_lanes(count) ? lanes : Lanes{};
    return lanes;
  }
  /// Writes to `place` and behind it.
  void store(Lanes lanes, double* place) const {
    if constexpr (is_full) {
      std::memcpy(place, &lanes, sizeof(lanes));
    } else {
      for (int n = 0; n < count; ++n) place[n] = lanes[n];
    }
  }
  /// The same in single precision. Returns the numbers as they are kept, with 0 in lanes left over.
  Lanes store(Lanes lanes, float* place) const {
    const auto kept = __builtin_convertvector(lanes, SingleLanes);
    if constexpr (is_full) {
      std::memcpy(place, &kept, sizeof(kept));
    } else {
      for (int n = 0; n < count; ++n) place[n] = kept[n];
    }
    return only(__builtin_convertvector(kept, Lanes));
  }
  template <int Dim>
  void store(const VecLanes<Dim>& lanes, Vec<Dim>* array) const {
    for (int n = 0; n < (is_full ? lane_count : count); ++n) {
      for (int d = 0; d < Dim; ++d) array[begin + n][d] = lanes.at[d][n];
    }
  }
};

/// Calls body(range) for the entries begin .. end, in their order.
template <class Body>
void for_each_lanes(std::size_t begin, std::size_t end, Body&& body) {
  constexpr std::size_t width = lane_count;
  for (; begin + width <= end; begin += width) body(LaneRange<true>{begin, lane_count});
  if (begin < end) body(LaneRange<false>{begin, static_cast<int>(end - begin)});
}

}  // namespace tailwater
