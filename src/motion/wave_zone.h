// Zones in which the velocity of the water is relaxed to rest or to that of given waves, and an estimate of the waves
// that such a zone reflects (docs/theory/waves.md).
#pragma once

#include <algorithm>
#include <optional>

#include "base/vec.h"
#include "case/spec.h"
#include "motion/wave_field.h"

namespace tailwater {

/// A zone makes waves of its period that differ from the theory by `leak`, and sends back the fraction `reflection` of
/// waves that enter it. Both are amplitudes over those of the waves.
struct ZoneEstimate {
  double reflection;
  double leak;
  double worse() const { return std::max(reflection, leak); }
};

/// By the mild-slope equation for the deviation from the theory, with the complex wave number of water that loses its
/// velocity at the local rate, and a wall behind the zone.
ZoneEstimate estimate_zone(double omega, double gravity, double depth, double length, double strength);

/// The strength [1/s] of the least reflection. For a zone that makes waves: the largest with 2 % of reflection and
/// leak, or the one with the least of both.
double best_strength(double omega, double gravity, double depth, double length, bool makes_waves);

/// Waves that meet a zone of a case: its own, or those of the only period of its makers.
struct ZoneWaves {
  double omega;  ///< 1/s
  double depth;  ///< m
};

/// m; of a zone along the direction of its waves.
double length_of(const DampingTable& zone);

/// A zone with the waves that meet it.
struct ZoneForecast {
  ZoneWaves waves;
  double wave_number;  ///< 1/m
  double strength;     ///< 1/s; the zone's own, or the best one for its waves
  ZoneEstimate estimate;
};
/// None without gravity, or if the case does not have the period or the depth of the waves.
std::optional<ZoneForecast> forecast_zone(const CaseSpec& spec, const DampingTable& zone, double gravity);

template <int Dim>
class WaveZone {
 public:
  /// Throws CaseError for a zone without a strength, or whose waves break.
  WaveZone(const CaseSpec& spec, const DampingTable& table);

  /// The rate [1/s] at which water at `x` approaches the target.
  double rate_at(const Vec<Dim>& x) const;
  bool has_waves() const { return field_.has_value(); }
  /// False for a zone that brakes the water to rest.
  bool has_target() const { return has_waves() || !current_.isZero(0.0); }
  /// The velocity [m/s] of the zone's waves, or of its current.
  Vec<Dim> target(const Vec<Dim>& x, double time) const;

 private:
  Vec<Dim> low_, high_, up_;
  Vec<Dim> across_;  ///< 3D; level, towards the larger coordinate; 0 in 2D
  int axis_;
  bool grows_upwards_;
  double strength_;
  double bed_ = 0.0;  ///< m; along `up`
  Vec<Dim> current_;  ///< m/s; of a zone without waves
  std::optional<WaveField> field_;
};

}  // namespace tailwater
