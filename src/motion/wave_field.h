// The flow of given waves over an even bed at any place and time: regular waves of finite height (regular_wave.h), or a
// sum of sines of first order.
#pragma once

#include <Eigen/Core>
#include <variant>
#include <vector>

#include "case/spec.h"
#include "motion/regular_wave.h"

namespace tailwater {

class WaveField {
 public:
  /// Throws CaseError, about the table `owner`, for waves that break.
  WaveField(const WaveKeys& waves, const CaseLabel& owner, double depth, double gravity, double transport);

  /// The velocity [m/s] (along the waves, upward) at a distance [m] along the waves from their origin, a height [m]
  /// above the bed and a time [s]. Sines of first order have the velocity of the still water's level above this level,
  /// less the mean current that balances the discharge of their crests.
  Eigen::Vector2d velocity(double distance, double height, double time) const;
  /// The elevation [m] above the still water.
  double elevation(double distance, double time) const;

 private:
  struct Sine {
    double omega, wave_number, amplitude, phase;
    double speed;  ///< m/s; a omega/tanh(kh)
  };

  double growth(double time) const;

  double start_, ramp_, depth_;
  double current_ = 0.0;  ///< m/s; of the sines
  std::variant<std::vector<Sine>, RegularWave> waves_;
};

}  // namespace tailwater
