// The bound waves of second order of many sines that travel in one direction over an even bed: M.S. Longuet-Higgins
// (1962) Resonant interactions between two trains of gravity waves, J. Fluid Mech. 12, 321-332; J.N. Sharma, R.G. Dean
// (1981) Second-order directional seas and associated wave forces, SPE J. 21, 129-140. docs/theory/waves.md.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "motion/wave_theory.h"

namespace tailwater {

/// A wave of first order, of elevation a cos(theta) with theta = omega t - k x + phase.
struct TravellingWave {
  double omega;        ///< 1/s
  double wave_number;  ///< 1/m
  double amplitude;    ///< m
};

/// The velocity of all sums and differences of two waves. The sums of a wave with itself count, but not its difference,
/// a current. The amplitudes over all pairs are a symmetric matrix, of which the largest eight eigenvalues are kept:
/// 99 % of the root of the sum of squares for a spectrum of kh = 0.5 to 10. The cost grows with the number of waves.
class BoundWaves {
 public:
  /// `waves` in ascending order of frequency.
  BoundWaves(std::span<const TravellingWave> waves, double gravity, double depth);

 private:
  friend class BoundFlow;
  static constexpr std::size_t terms = 8;
  using Terms = std::array<double, terms>;
  /// Eigenvectors, of one wave.
  struct Parts {
    Terms of_sums, of_differences;
  };

  double depth_;
  std::vector<double> wave_number_;
  std::vector<Parts> parts_;
  Terms sums_{}, differences_{};  ///< m/s; eigenvalues
};

/// The bound waves at one place and time.
class BoundFlow {
 public:
  /// At a height [m] above the bed.
  BoundFlow(const BoundWaves& waves, double height);
  /// Adds the next wave, from the first one on, with the shape at this height.
  void add(double cos_theta, double sin_theta, const DepthShape& shape);
  /// m/s; along the waves, and upward.
  std::array<double, 2> velocity() const;

 private:
  using Terms = BoundWaves::Terms;
  struct ComplexTerms {
    Terms real{}, imag{};
  };

  const BoundWaves& waves_;
  double below_surface_, above_bed_image_;  ///< m
  std::size_t next_ = 0;
  ComplexTerms cosh_, sinh_;                      ///< sums over the waves of both factors of a sum's shape
  ComplexTerms from_surface_, from_image_;        ///< of the waves so far, decayed from the last one
  ComplexTerms differences_, image_differences_;  ///< sums over the pairs
};

}  // namespace tailwater
