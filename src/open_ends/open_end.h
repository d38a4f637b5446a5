// Inlets and outlets (motion/channel_end.h) in a step: docs/theory/open_ends.md.
//
// The stretch of the channel at the end, one dx longer than the kernel's support, is the buffer zone. For their
// neighbours its particles are part of the flow, but they are not solved for: their pressure and their velocity follow
// from the prescribed level or discharge and from the water inside. So water inside has full support and no free
// surface or wall where the case ends. Particles that have passed the opening outwards are removed; where the buffer
// moves inwards, new ones stand in the rows of a lattice at the opening. Both are counted.
//
// The section of the opening is divided into cells of about dx x dx. The line of water before and behind a cell, along
// the opening's normal, is its fibre. Where no discharge is prescribed, each fibre has a velocity of its own, that of
// the water before the buffer continued to it.
#pragma once

#include <cstdint>
#include <vector>

#include "flow/water_amount.h"
#include "motion/channel_end.h"

namespace tailwater {

/// Error of a prescribed level.
struct LevelError {
  double mean = 0.0;    ///< m; of the water before the buffer, above the height that the level prescribes
  double lasts = 0.0;   ///< s; for which that has been more than a spacing
  double since = -1.0;  ///< s; when it began, the first time that it lasted long; below 0: it never did
  double total = 0.0;   ///< s; of all times that lasted long
  double most = 0.0;    ///< m; the largest mean in them
};

/// The wave that leaves through an end that absorbs it.
struct LeavingWave {
  double height = 0.0;      ///< m; above the level beyond, as far as it is absorbed
  double number = 0.0;      ///< 1/m; wave number; 0: a long one
  double swing = 0.0;       ///< m^2/s^2; mean square of the speed, less its mean
  double swing_rate = 0.0;  ///< m^2/s^4; mean square of its rate, over the same time
};

/// The flow before the buffer, and the assumed or prescribed flow beyond.
struct OpenEndState {
  // The water before the buffer.
  bool is_wet = false;
  double wet_time = 0.0;        ///< s; time since it became wet
  double speed = 0.0;           ///< m/s; mean along the normal
  double delayed_speed = 0.0;   ///< m/s; `speed`, a mean over the time of a wave from the gauge into the buffer
  double acceleration = 0.0;    ///< m/s^2; of `speed` over that time
  double mean_speed = 0.0;      ///< m/s; `speed`, its long waves only
  double mean_discharge = 0.0;  ///< m^Dim/s; out, likewise
  double invariant = 0.0;       ///< m/s; u - 2 sqrt(g h), which comes from beyond where the channel goes on
  double surface = 0.0;         ///< m; of the water there above the floor; found anew in each step
  // The buffer.
  double depth = 0.0;                ///< m; of its water above the floor
  double level = 0.0;                ///< m; beyond, where one is prescribed: with what lets waves out
  bool is_full = false;              ///< whether that is above the top of the opening
  double depth_rate = 0.0;           ///< m/s; of `depth`, where a discharge is prescribed
  double entry_speed = 0.0;          ///< m/s; mean over the opening, into the case, likewise
  std::vector<double> fibre_speeds;  ///< m/s; out; elsewhere
  double stretching = 0.0;           ///< 1/s; rate at which the water there becomes deeper; elsewhere
  std::vector<std::int64_t> rows;    ///< of the lattice on which particles enter, in each column
  LeavingWave wave;
  // Water that has passed.
  LevelError miss;
  double asked = 0.0;        ///< m^Dim; prescribed volume, in less out; where a discharge is prescribed
  double asked_total = 0.0;  ///< m^Dim; prescribed volume in both directions together
  double filling = 0.0;      ///< m^Dim; growth of the buffer's volume with its depth; where a discharge is prescribed
  WaterAmount departed;
  WaterAmount arrived;
  std::int64_t short_steps = 0;  ///< steps in which more would have entered than waited to circulate

  /// m^Dim; net volume that the inlet owes: the prescribed volume and that of the buffer, less the volume that came.
  double missing() const { return asked + filling - (arrived.volume - departed.volume); }
};

/// An open end as the steps need it.
template <int Dim>
struct OpenEnd : ChannelEnd<Dim> {
  /// `support` [m] is the kernel's radius.
  OpenEnd(ChannelEnd<Dim> end, const Vec<Dim>& gravity_of_case, double particle_spacing, double support);

  Vec<Dim> full_gravity;  ///< m/s^2
  double spacing;         ///< m; dx
  double stretch;         ///< m; length of the buffer
  double gauge;           ///< m; half the length of the gauge, the stretch before it where the flow is measured
  double reach = 0.0;     ///< m; length of the case along the opening's normal
  std::vector<std::size_t> first_fibre;  ///< of each column, from its bottom upwards; and the number of all

  bool holds(const Vec<Dim>& x) const {
    return !this->air() && this->opening.beyond(x) > -stretch && this->opening.spans(x);
  }
  /// Distance [m] from the gauge to the middle of the buffer.
  double distance() const { return 0.5 * stretch + gauge; }
  /// Index of the column that holds a place.
  std::size_t column_at(const Vec<Dim>& x) const;
  /// Height [m] of a place above the bottom of a column.
  double height_in(std::size_t column, const Vec<Dim>& x) const;
  /// Height [m] of a cell of the section in a column.
  double fibre_height(std::size_t column) const;
  /// Distance [m] beyond the border of the buffer.
  double behind_border(const Vec<Dim>& x) const { return this->opening.beyond(x) + stretch; }
  /// Depth [m] of the water in a column.
  double depth_in(std::size_t column, const OpenEndState& state) const;
  /// Pressure [Pa] of the water assumed or prescribed, at a place in the buffer where the water has a velocity and
  /// pores slow it down [m/s^2].
  double pressure_at(const OpenEndState& state, const Vec<Dim>& x, const Vec<Dim>& velocity,
                     const Vec<Dim>& deceleration, double density) const;
  /// Velocity [m/s] at a place in the buffer.
  Vec<Dim> velocity_at(const OpenEndState& state, const Vec<Dim>& x) const;

 private:
  Vec<Dim> inflow_at(const OpenEndState& state, const Vec<Dim>& x) const;
  double fibre_speed_at(const OpenEndState& state, const Vec<Dim>& x) const;
  Vec<Dim> fall_at(const OpenEndState& state, const Vec<Dim>& x) const;
};

}  // namespace tailwater
