// Depth of the water along a line against gravity: probes "depth" and "profile".
//
// The bed is the highest upward-facing wall face on the line with water above it. From there c (water_share.h) is
// sampled every dx/4, up to the next downward-facing face or past the highest particle. Surfaces are where the
// piecewise linear curve passes 1/2. The bed counts as water below a layer that fills most of the free space at the
// bed, else as wall. With particles on the wall itself, as published, the top row of the starting
// lattice is on the surface, not dx/2 below it, and depths come out dx/2 too large.
#pragma once

#include <memory>
#include <vector>

#include "case/spec.h"
#include "motion/wall_motion.h"
#include "probes/context.h"

namespace tailwater {

struct WaterColumn {
  double bed = 0.0;        ///< m; height of the bed above the origin
  double connected = 0.0;  ///< m; from the bed to the first surface
  double highest = 0.0;    ///< m; from the bed to the last surface
  double wet = 0.0;        ///< m; length of the line that is under water, the reading of a wire gauge
};

/// A wall face that an upright line crosses.
template <int Dim>
struct Crossing {
  double height;  ///< m; along the line from its foot
  Vec<Dim> normal;
  int wall;  ///< index into Boundary::walls
};

/// A line and the walls on it at one instant.
template <int Dim>
struct UprightLine {
  Vec<Dim> foot;                         ///< its point at height 0
  Vec<Dim> up;                           ///< unit vector along it
  std::vector<Crossing<Dim>> crossings;  ///< highest first
};

/// A line against gravity, as drawn. If its bed is a wall that moves on a path, as in a shaken tank, the line moves and
/// turns with the bed. Heights are then relative to the tank. Other moving walls count at their present place.
template <int Dim>
class UprightGauge {
 public:
  /// Throws InputError, which names the probe, if there is no gravity, no bed on the line, or a bed whose motion
  /// depends on the water.
  UprightGauge(const ProbeTable& probe, const Vec<Dim>& at, const CaseSpec& spec, const Boundary<Dim>& boundary);

  const UprightLine<Dim>& drawn() const { return drawn_; }
  double highest_bed() const;  ///< m; as drawn
  UprightLine<Dim> now(const ProbeContext<Dim>& context) const;
  Region<Dim> region(double time) const;

 private:
  AffineMap<Dim> displacement(double time) const { return path_ ? path_->at(time) : AffineMap<Dim>{}; }

  Vec<Dim> at_;
  double spacing_;
  UprightLine<Dim> drawn_;
  std::vector<Crossing<Dim>> resting_;  ///< the crossings with walls at rest
  bool has_moving_walls_;
  std::shared_ptr<const WallPath<Dim>> path_;  ///< path of its bed; null: the bed rests
};

/// The direction against gravity. Throws InputError, which names the probe, if there is no gravity.
template <int Dim>
Vec<Dim> upwards(const ProbeTable& probe, const CaseSpec& spec);

/// The water at one instant, for measurements on upright lines.
template <int Dim>
class WaterColumns {
 public:
  explicit WaterColumns(const ProbeContext<Dim>& context);
  WaterColumn on(const UprightLine<Dim>& line) const;

 private:
  const ProbeContext<Dim>& context_;
  Vec<Dim> low_, high_;  ///< m; corners of the box around all water
};

/// The region around all gauges.
template <int Dim>
Region<Dim> region_of(const std::vector<UprightGauge<Dim>>& gauges, double time) {
  Region<Dim> region = gauges.front().region(time);
  region.to = gauges.back().region(time).to;
  for (const UprightGauge<Dim>& gauge : gauges) {
    region.margin = std::max(region.margin, region.distance(gauge.region(time).from));
  }
  return region;
}

/// A depth probe. Throws InputError if there is no gravity or no bed below the
/// place.
template <int Dim>
Reading<Dim> depth_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

/// A profile: a row per place from `from` to `to`, dx apart. Throws InputError if there is no gravity or a place has no
/// bed.
template <int Dim>
Reading<Dim> profile_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
