// Several numbers side by side, which the processor handles at once. Pairs are computed in single precision; conserved
// sums and sums that nearly cancel are in double (docs/theory/neighbours.md).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

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

/// Double precision, with half as many lanes.
inline constexpr int double_lane_count = lane_count / 2;
using DoubleLanes = double __attribute__((vector_size(8 * double_lane_count)));

/// a b + c. In a sum of two products the compiler may round either product. It may choose differently wherever a loop
/// is compiled, as for whole groups and for the rest of a row. Where both particles of a pair must have the same value,
/// the code chooses with this function.
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

  VecLanes& operator+=(const VecLanes& other) {
    for (int d = 0; d < Dim; ++d) at[d] += other.at[d];
    return *this;
  }
  VecLanes& operator-=(const VecLanes& other) {
    for (int d = 0; d < Dim; ++d) at[d] -= other.at[d];
    return *this;
  }
  friend VecLanes operator-(VecLanes a, const VecLanes& b) { return a -= b; }
  friend VecLanes operator*(Lanes weight, VecLanes vector) {
    for (int d = 0; d < Dim; ++d) vector.at[d] *= weight;
    return vector;
  }

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

  /// The index of entry (a, b).
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
  /// Adds x y, whose product is symmetric. Loops over a triangle would leave the sums in memory.
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

/// Written without a loop over lanes, which would leave them in memory, and with them the sums of a loop over pairs.
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
  for (int b = 0; b < Dim; ++b) sum.put_column(b, sum_of(lanes.column[b]));
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

/// A sum in double precision, for conserved quantities and sums that nearly cancel.
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

  void operator+=(const VecLanes<Dim>& terms) {
    for (int d = 0; d < Dim; ++d) at[d] += terms.at[d];
  }

  Vec<Dim> total() const {
    Vec<Dim> total;
    for (int d = 0; d < Dim; ++d) total[d] = at[d].total();
    return total;
  }
};

}  // namespace tailwater
