// Regular waves of finite height over an even bed: the steady flow of a wave of permanent form, by a Fourier series of
// its stream function. J.D. Fenton (1988) The numerical solution of steady water wave problems, Comput. Geosci. 14,
// 357-368; J.D. Fenton (1999) Numerical methods for nonlinear waves, Adv. Coastal Ocean Eng. 5, 241-324. The series
// contains Stokes and cnoidal waves of any order. docs/theory/waves.md has the equations.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace tailwater {

struct RegularWaveRequest {
  double height;           ///< m; from trough to crest
  double period;           ///< s; at a fixed place
  double depth;            ///< m; mean
  double gravity;          ///< m/s^2
  double transport = 0.0;  ///< m/s; mean discharge over depth; 0 in a flume with closed ends
};

class RegularWave {
 public:
  /// None if no such wave was found, because it breaks.
  static std::optional<RegularWave> solve(const RegularWaveRequest& request);

  double wave_number() const { return wave_number_; }  ///< 1/m
  double celerity() const { return celerity_; }        ///< m/s
  /// m/s; mean horizontal velocity at a place that is always under water
  double mean_velocity() const { return mean_velocity_; }
  /// The elevation [m] above the mean level at a phase k(x - c t), 0 under the crest.
  double elevation(double phase) const;
  /// The velocity [m/s] along and against gravity's vertical: (horizontal, upward), at a height [m] above the bed.
  Eigen::Vector2d velocity(double phase, double height) const;
  /// Amplitude [m] of the harmonic `n` of the elevation.
  double amplitude(int n) const { return elevations_[static_cast<std::size_t>(n)]; }
  /// m/s; the rms over a period of the difference between both sides of the Bernoulli equation on the surface, between
  /// the points at which the solution satisfies it, as a velocity.
  double residual() const;

 private:
  RegularWave() = default;

  double depth_ = 0.0;
  double gravity_ = 0.0;
  double wave_number_ = 0.0;
  double celerity_ = 0.0;
  double mean_velocity_ = 0.0;
  double bernoulli_ = 0.0;          ///< m^2/s^2; constant on the surface
  std::vector<double> elevations_;  ///< m; of cos(j phase), j = 0, 1, ...
  std::vector<double> velocities_;  ///< m/s; of cosh(j k z)/cosh(j k h) cos(j phase), j = 1, 2, ...
};

}  // namespace tailwater
