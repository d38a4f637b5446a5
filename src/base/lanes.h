// Several numbers side by side, on which the processor works at once. A loop over the pairs of a row that takes them in
// lanes reads as the one pair by pair. Compilers do not turn one into the other: that would change the order of sums.
// The instructions that gather are not used, because on many processors they are slower than single loads.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

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

inline Lanes min_of(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes max_of(Lanes a, Lanes b) { return a > b ? a : b; }

/// Whether a comparison holds in some lane.
inline bool any_of(decltype(Lanes{} < Lanes{}) holds) {
  auto any = holds[0];
  for (int n = 1; n < lane_count; ++n) any |= holds[n];
  return any != 0;
}

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

  Lanes operator()(const double* array) const { return read<1>(array, std::make_index_sequence<lane_count>()); }

  template <int Dim>
  VecLanes<Dim> operator()(const Vec<Dim>* array) const {
    VecLanes<Dim> lanes;
    for (int d = 0; d < Dim; ++d) {
      lanes.at[d] = read<Dim>(reinterpret_cast<const double*>(array) + d, std::make_index_sequence<lane_count>());
    }
    return lanes;
  }

  template <int Dim>
  MatLanes<Dim> operator()(const Mat<Dim>* array) const {
    MatLanes<Dim> lanes;
    for (int b = 0; b < Dim; ++b) {
      for (int a = 0; a < Dim; ++a) lanes.column[b].at[a] = entry<Dim>(array, a, b);
    }
    return lanes;
  }
  /// The same of symmetric matrices.
  template <int Dim>
  MatLanes<Dim> symmetric(const Mat<Dim>* array) const {
    MatLanes<Dim> lanes;
    for (int b = 0; b < Dim; ++b) {
      for (int a = b; a < Dim; ++a) lanes.column[b].at[a] = lanes.column[a].at[b] = entry<Dim>(array, a, b);
    }
    return lanes;
  }

 private:
  template <int Dim>
  Lanes entry(const Mat<Dim>* array, int a, int b) const {
    const auto* const numbers = reinterpret_cast<const double*>(array);  // column by column
    return read<Dim * Dim>(numbers + Dim * b + a, std::make_index_sequence<lane_count>());
  }
  template <int Stride, std::size_t... Lane>
  Lanes read(const double* from, std::index_sequence<Lane...>) const {
    return Lanes{from[Stride * index_[Lane]]...};
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
    if constexpr (!is_full) {
      for (int n = count; n < lane_count; ++n) lanes[n] = 0.0;
    }
    return lanes;
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
