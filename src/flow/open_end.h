// What happens at an outlet (geometry/outlet.h): docs/theory/outlets.md.
//
// The last stretch before it, one dx longer than the kernel's support, is the end stretch. For their neighbours its
// particles are part of the flow, but they are not solved for: they move along the outlet's normal, and their pressure
// is that of a channel that continues. So water upstream has full support and sees no brink and no wall. Particles that
// have passed the outlet are removed and booked.
#pragma once

#include <cstdint>

#include "geometry/outlet.h"

namespace tailwater {

/// What left through one outlet since the start.
struct Departed {
  std::int64_t particles = 0;
  double volume = 0.0;  ///< m^Dim
  double energy = 0.0;  ///< J; kinetic and potential, on leaving

  Departed& operator+=(const Departed& other);
};

/// The flow before the end stretch, and what is assumed to come from beyond.
struct OpenEndState {
  bool is_wet = false;
  double wet_time = 0.0;      ///< s; time since it became wet
  double speed = 0.0;         ///< m/s; mean along the normal
  double speed_beyond = 0.0;  ///< m/s; `speed` with the delay of its way to the middle of the end stretch
  double invariant = 0.0;     ///< m/s; u - 2 sqrt(g h), which comes from beyond where flow is subcritical
  Departed departed;
};

/// The place of an open end, which does not change.
template <int Dim>
struct OpenEnd {
  /// `support` [m] is the kernel's radius.
  OpenEnd(const Outlet<Dim>& place, const Vec<Dim>& full_gravity, double spacing, double support);

  Outlet<Dim> outlet;
  double stretch;  ///< m; length of the end stretch
  double gauge;    ///< m; half the length of the gauge, the stretch before it where the flow is measured
  double gravity;  ///< m/s^2; the part of gravity along the outlet's plane
  Vec<Dim> up;     ///< opposite to that part; 0 if there is none
  double floor;    ///< m; height of the outlet's lowest point along `up`
  double width;    ///< m; of the outlet across `up`; 1 in 2D

  bool holds(const Vec<Dim>& x) const { return outlet.beyond(x) > -stretch && outlet.spans(x); }
  /// Pressure [Pa] of a channel that continues, at a place in the end stretch.
  double pressure_at(const OpenEndState& state, const Vec<Dim>& x, double density) const;
};

}  // namespace tailwater
