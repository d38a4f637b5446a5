#include "run/inflow_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/box.h"
#include "motion/channel_end.h"

namespace tailwater {
namespace {

constexpr int moments = 1000;  ///< number of times in the run that are evaluated

/// The basin that replaces the case.
struct Basin {
  double floor = 0.0;    ///< m; the lowest point of walls and open ends, upwards
  double surface = 1.0;  ///< m^(Dim-1); area

  double level(double volume) const { return floor + volume / surface; }
  double volume(double at_level) const { return surface * std::max(0.0, at_level - floor); }
};

template <int Dim>
Basin basin_of(const Boundary<Dim>& boundary, const std::vector<ChannelEnd<Dim>>& ends, const Vec<Dim>& up) {
  Box<Dim> box;
  for (const WallFace<Dim>& face : boundary.faces) {
    if (!boundary.walls[face.wall].is_duct) box.extend(face.box());
  }
  for (const ChannelEnd<Dim>& end : ends) box.extend(end.on_mouth(end.low));
  int axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  Vec<Dim> sides = box.sizes();
  sides[axis] = 1.0;
  return {.floor = up[axis] > 0.0 ? box.min()[axis] : -box.max()[axis], .surface = std::max(sides.prod(), 1e-12)};
}

/// Discharge into the case, m^Dim/s.
template <int Dim>
double discharge_of(const ChannelEnd<Dim>& end, const Basin& basin, double volume, double time) {
  const double level = basin.level(volume);
  const double beyond = end.flow.level ? end.flow.level->at(time) : -std::numeric_limits<double>::infinity();
  if (end.flow.feeds()) {
    const double depth =
        end.flow.level ? end.depth_at_level(beyond) : std::max(end.depth_at_level(level), 0.1 * end.height);
    return end.width * end.discharge_per_width(time, depth);
  }
  const double depth = end.depth_at_level(std::max(level, beyond));
  const double critical = end.width * std::sqrt(end.gravity) * std::pow(2.0 / 3.0 * depth, 1.5);
  return beyond > level ? critical : -critical;
}

}  // namespace

template <int Dim>
WaterEstimate estimate_water(const CaseSpec& spec, const Boundary<Dim>& boundary, double start) {
  WaterEstimate estimate{.mean = start, .largest = start};
  const std::vector<ChannelEnd<Dim>> ends = make_channel_ends<Dim>(spec);
  if (ends.empty() || ends.front().up.isZero()) return estimate;
  const Basin basin = basin_of(boundary, ends, ends.front().up);
  const double dt = spec.time.end / moments;
  double volume = start, sum = 0.0;
  for (int k = 0; k < moments; ++k) {
    const double time = k * dt;
    for (const ChannelEnd<Dim>& end : ends) {
      const double discharge = discharge_of(end, basin, volume, time);
      if (!std::isfinite(discharge)) continue;
      double change = dt * discharge;
      if (!end.flow.feeds()) {
        const double goal = basin.volume(end.flow.level ? end.flow.level->at(time) : end.floor);
        change = discharge > 0.0 ? std::min(change, std::max(0.0, goal - volume))
                                 : std::max(change, std::min(0.0, goal - volume));
      }
      volume = std::max(0.0, volume + change);
      const double fall = std::max(0.0, end.floor - basin.level(volume));
      const double speed =
          std::hypot(end.largest_speed(time, spec.particles.spacing), std::sqrt(2.0 * end.gravity * fall));
      if (discharge > 0.0 && std::isfinite(speed)) estimate.largest_speed = std::max(estimate.largest_speed, speed);
    }
    sum += volume;
    estimate.largest = std::max(estimate.largest, volume);
  }
  estimate.mean = sum / moments;
  return estimate;
}

TAILWATER_IN_2D_AND_3D(estimate_water);

}  // namespace tailwater
