// The flow of given waves over an even bed at any place and time: regular waves of finite height (regular_wave.h), or a
// sum of sines. Sines of one direction have their bound waves of second order (bound_waves.h), those of many have not.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "base/vec.h"
#include "case/spec.h"
#include "motion/bound_waves.h"
#include "motion/regular_wave.h"

namespace tailwater {

/// Directions of waves, as angles from the axis along which distances are measured.
struct WaveDirections {
  double mean = 0.0;       ///< radians
  double spreading = 0.0;  ///< s of cos^2s of half the angle from the mean; 0: all waves have the mean direction
  /// m; period of the case across that axis, or 0. Directions are changed until whole waves fit into it.
  double period_across = 0.0;
};

class WaveField {
 public:
  /// Throws CaseError, about the table `owner`, for waves that break.
  WaveField(const WaveKeys& waves, const CaseLabel& owner, double depth, double gravity, double transport,
            const WaveDirections& directions = {});

  /// The velocity [m/s] (along the axis, upward, across) at a distance [m] along the axis from the waves' origin, a
  /// height [m] above the bed, a time [s] and a place [m] across. Sines have the velocity of the still water's
  /// level above this level, less the mean current that balances the discharge of their crests.
  Vec<3> velocity(double distance, double height, double time, double across = 0.0) const;
  /// The elevation [m] above the still water; of sines to first order.
  double elevation(double distance, double time, double across = 0.0) const;

 private:
  /// Cosine and sine of the angle from the axis.
  struct Direction {
    double along, across;
    double way(double distance, double off) const { return along * distance + across * off; }
  };
  struct Sine {
    double omega, wave_number, amplitude, phase;
    double speed;  ///< m/s; a omega/tanh(kh)
    Direction direction;
  };

  double growth(double time) const;
  static Direction direction_of(double angle, double wave_number, double period_across);

  double start_, ramp_, depth_;
  Direction direction_{1.0, 0.0};    ///< of regular waves, and of sines of one direction
  Vec<3> current_ = Vec<3>::Zero();  ///< m/s; of the sines
  std::variant<std::vector<Sine>, RegularWave> waves_;
  std::optional<BoundWaves> bound_;  ///< of sines of one direction
};

}  // namespace tailwater
