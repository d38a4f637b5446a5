// Depth of the water along a line against gravity: probes "depth" and "profile".
//
// The bed is the highest upward-facing wall face on the line with water above it. From there c (water_share.h) is
// sampled every dx/4, up to the next downward-facing face or past the highest particle. Surfaces are where the
// piecewise linear curve passes 1/2. The bed counts as water below a layer that fills most of the free space at the
// bed, else as wall. With particles on the wall itself (scheme.walls other than "dummies") the top row of the starting
// lattice is on the surface, not dx/2 below it, and depths come out dx/2 too large.
#pragma once

#include <vector>

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

struct WaterColumn {
  double bed = 0.0;        ///< m; height of the bed above the origin
  double connected = 0.0;  ///< m; from the bed to the first surface
  double highest = 0.0;    ///< m; from the bed to the last surface
  double wet = 0.0;        ///< m; length of the line that is under water, which is what a wire gauge reads
};

/// A wall face that an upright line crosses.
template <int Dim>
struct Crossing {
  double height;  ///< m above the origin
  Vec<Dim> normal;
};

/// A line against gravity and the walls on it.
template <int Dim>
struct UprightLine {
  Vec<Dim> foot;  ///< its point at height 0
  Vec<Dim> up;
  std::vector<Crossing<Dim>> crossings;  ///< highest first

  /// Throws InputError, which names the probe, if there is no bed on the line.
  UprightLine(const ProbeTable& probe, const Vec<Dim>& at, const Vec<Dim>& direction, const Boundary<Dim>& boundary,
              double spacing);
};

/// Against gravity. Throws InputError, which names the probe, if there is none.
template <int Dim>
Vec<Dim> upwards(const ProbeTable& probe, const CaseSpec& spec);

/// A height [m] above all water in the context.
template <int Dim>
double top_of_water(const ProbeContext<Dim>& context, const Vec<Dim>& up);

/// The water on the line; `top` [m] is a height above all water.
template <int Dim>
WaterColumn read_column(const ProbeContext<Dim>& context, const UprightLine<Dim>& line, double top);

/// A depth probe: columns connected_m, highest_m, wet_m. Throws InputError if there is no gravity or no bed below the
/// place.
template <int Dim>
Reading<Dim> depth_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

/// A profile: a row per place from `from` to `to`, dx apart, with columns x_m (y_m), bed_m, connected_m, highest_m.
/// Throws InputError if there is no gravity or a place has no bed.
template <int Dim>
Reading<Dim> profile_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
