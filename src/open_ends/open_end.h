// What happens at inlets and outlets (motion/channel_end.h): docs/theory/open_ends.md.
//
// The stretch of the channel at the end, one dx longer than the kernel's support, is the end stretch. For their
// neighbours its particles are part of the flow, but they are not solved for: how they move, and their pressure, follow
// from what is prescribed, or are those of a channel that continues. So water inside has full support and sees no brink
// and no wall. Particles that have passed the opening outwards are removed; where the end stretch moves inwards, new
// ones stand in the rows of a lattice at the opening. Both are counted.
#pragma once

#include <cstdint>

#include "flow/water_amount.h"
#include "motion/channel_end.h"

namespace tailwater {

/// How well a prescribed level is held.
struct LevelError {
  double mean = 0.0;    ///< m; of the water before the end stretch, above what the level asks for
  double lasts = 0.0;   ///< s; for which that has been more than a spacing
  double since = -1.0;  ///< s; when it began, the first time that it lasted long; below 0: it never did
  double total = 0.0;   ///< s; of all times that lasted long
  double most = 0.0;    ///< m; the largest mean in them
};

/// The flow before the end stretch, and what is assumed or prescribed beyond.
struct OpenEndState {
  bool is_wet = false;
  double wet_time = 0.0;      ///< s; time since it became wet
  double speed = 0.0;         ///< m/s; mean along the normal
  double speed_beyond = 0.0;  ///< m/s; `speed` with the delay of a wave to the middle of the end stretch
  double invariant = 0.0;     ///< m/s; u - 2 sqrt(g h), which comes from beyond where flow is subcritical
  double mean_speed = 0.0;    ///< m/s; `speed`, its long waves only; where a level is prescribed
  // Where something is prescribed.
  double depth = 0.0;        ///< m; of the water in the end stretch
  double depth_rate = 0.0;   ///< m/s; of `depth`
  double entry_speed = 0.0;  ///< m/s; mean over the opening, into the case
  // Where a level is prescribed.
  double depth_at_gauge = 0.0;   ///< m; that the pressure there stands for
  double depth_in_middle = 0.0;  ///< m; the same in the middle of the end stretch
  double border_speed = 0.0;     ///< m/s; out, where the end stretch begins
  double gain = 0.0;             ///< m/s; from the gauge to there, of the water's speed
  LevelError miss;
  double asked = 0.0;     ///< m^Dim; what should have come in less what should have left; where that is prescribed
  std::int64_t rows = 0;  ///< of the lattice on which particles enter
  WaterAmount departed;
  WaterAmount arrived;
  std::int64_t short_steps = 0;  ///< steps in which more would have entered than waited to circulate
};

/// An open end as the steps need it.
template <int Dim>
struct OpenEnd : ChannelEnd<Dim> {
  /// `support` [m] is the kernel's radius.
  OpenEnd(ChannelEnd<Dim> end, double spacing, double support);

  double stretch;      ///< m; length of the end stretch
  double gauge;        ///< m; half the length of the gauge, the stretch before it where the flow is measured
  double reach = 0.0;  ///< m; length of the case along the opening's normal
  int columns;         ///< of the lattice on which particles enter, across the opening

  bool holds(const Vec<Dim>& x) const { return this->opening.beyond(x) > -stretch && this->opening.spans(x); }
  /// Distance [m] from the gauge to the middle of the end stretch.
  double distance() const { return 0.5 * stretch + gauge; }
  /// Hydrostatic pressure [Pa] of the water assumed or prescribed, at a place in the end stretch.
  double pressure_at(const OpenEndState& state, const Vec<Dim>& x, double density) const;
  /// Velocity [m/s] at a place in the end stretch, where a discharge or a velocity is prescribed.
  Vec<Dim> inflow_at(const OpenEndState& state, const Vec<Dim>& x) const;
};

/// Depth [m] of a flow with speed u and the invariant that comes from beyond.
double depth_at_speed(double invariant, double gravity, double u);

}  // namespace tailwater
