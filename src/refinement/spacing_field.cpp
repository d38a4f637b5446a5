#include "refinement/spacing_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "base/box.h"
#include "geometry/from_spec.h"

namespace tailwater {
namespace {

double smooth_step(double q) {
  const double s = std::clamp(q, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

/// Derivative of the logarithm of the smooth step.
double log_slope_of_step(double q) { return q > 0.0 && q < 1.0 ? 6.0 * (1.0 - q) / (q * (3.0 - 2.0 * q)) : 0.0; }

}  // namespace

template <int Dim>
SpacingField<Dim>::SpacingField(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double dx = spec.particles.spacing;
  Box<Dim> bounds = box_around(boundary.faces);
  periodic_.min().setZero();
  periodic_.max().setZero();
  if (bounds.isEmpty()) bounds = {Vec<Dim>::Constant(-infinity), Vec<Dim>::Constant(infinity)};
  for (int axis = 0; axis < Dim; ++axis) {
    const std::vector<double>& range = periodic_range(spec.domain, axis);
    if (range.empty()) continue;
    periodic_.min()[axis] = bounds.min()[axis] = range[0];
    periodic_.max()[axis] = bounds.max()[axis] = range[1];
  }
  for (const RefinementTable& table : spec.refinement) {
    const CaseLabel owner("refinement", table.name);
    Zone zone{{to_vec<Dim>(table.min, owner, "min"), to_vec<Dim>(table.max, owner, "max")},
              table.level,
              border_per_level * table.level * dx};
    for (int axis = 0; axis < Dim; ++axis) {
      const double tolerance = corner_tolerance * dx;
      if (zone.box.min()[axis] <= bounds.min()[axis] + tolerance) zone.box.min()[axis] = -infinity;
      if (zone.box.max()[axis] >= bounds.max()[axis] - tolerance) zone.box.max()[axis] = infinity;
    }
    zones_.push_back(zone);
  }
}

template <int Dim>
Vec<Dim> SpacingField<Dim>::wrapped(Vec<Dim> x) const {
  const Vec<Dim> period = periodic_.sizes();
  for (int axis = 0; axis < Dim; ++axis) {
    if (period[axis] > 0.0) x[axis] -= period[axis] * std::floor((x[axis] - periodic_.min()[axis]) / period[axis]);
  }
  return x;
}

template <int Dim>
double SpacingField<Dim>::at(const Vec<Dim>& x) const {
  const Vec<Dim> inside = wrapped(x);
  double least = 1.0;
  for (const Zone& zone : zones_) {
    if (!zone.box.contains(inside)) continue;
    double steps = 1.0;
    for (int axis = 0; axis < Dim; ++axis) {
      steps *= smooth_step((inside[axis] - zone.box.min()[axis]) / zone.border);
      steps *= smooth_step((zone.box.max()[axis] - inside[axis]) / zone.border);
    }
    least = std::min(least, std::exp2(-zone.level * steps));
  }
  return least;
}

template <int Dim>
Vec<Dim> SpacingField<Dim>::slope(const Vec<Dim>& x) const {
  const Vec<Dim> inside = wrapped(x);
  double least = 1.0;
  Vec<Dim> slope = Vec<Dim>::Zero();
  for (const Zone& zone : zones_) {
    if (!zone.box.contains(inside)) continue;
    double steps = 1.0;
    Vec<Dim> log_slope = Vec<Dim>::Zero();  // of `steps`
    for (int axis = 0; axis < Dim; ++axis) {
      const double low = (inside[axis] - zone.box.min()[axis]) / zone.border;
      const double high = (zone.box.max()[axis] - inside[axis]) / zone.border;
      steps *= smooth_step(low) * smooth_step(high);
      log_slope[axis] = (log_slope_of_step(low) - log_slope_of_step(high)) / zone.border;
    }
    const double h = std::exp2(-zone.level * steps);
    if (h >= least) continue;
    least = h;
    slope = -zone.level * std::numbers::ln2 * h * steps * log_slope;
  }
  return slope;
}

template <int Dim>
typename SpacingField<Dim>::NearestBorder SpacingField<Dim>::nearest_border(const Vec<Dim>& x) const {
  const Vec<Dim> inside = wrapped(x);
  const Vec<Dim> period = periodic_.sizes();
  NearestBorder nearest{-1, std::numeric_limits<double>::infinity()};
  for (std::size_t n = 0; n < zones_.size(); ++n) {
    const Zone& zone = zones_[n];
    double depth = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < Dim; ++axis) {
      double along = -std::numeric_limits<double>::infinity();
      for (const double image : {0.0, period[axis], -period[axis]}) {
        const double at = inside[axis] + image;
        along = std::max(along, std::min(at - zone.box.min()[axis], zone.box.max()[axis] - at));
      }
      depth = std::min(depth, along);
    }
    const double distance = std::max({-depth, depth - zone.border, 0.0});
    if (distance < nearest.distance) nearest = {static_cast<int>(n), distance};
  }
  return nearest;
}

template <int Dim>
double SpacingField<Dim>::finest() const {
  int level = 0;
  for (const Zone& zone : zones_) level = std::max(level, zone.level);
  return std::exp2(-level);
}

template <int Dim>
bool SpacingField<Dim>::varies_around(Vec<Dim>& x, double reach) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  x = wrapped(x);
  const Vec<Dim> period = periodic_.sizes();
  bool varies = false;
  for (int axis = 0; axis < Dim; ++axis) {
    bool varies_along = false;
    double below = -infinity;  // the nearest end of a range where h varies within the reach
    double above = infinity;
    const auto see = [&](double begin, double end) {
      for (const double image : {0.0, period[axis], -period[axis]}) {
        varies_along = varies_along || (x[axis] > begin + image && x[axis] < end + image);
        for (const double at : {begin + image, end + image}) {
          if (at <= x[axis]) below = std::max(below, at);
          if (at >= x[axis]) above = std::min(above, at);
        }
      }
    };
    for (const Zone& zone : zones_) {
      const double low = zone.box.min()[axis];
      const double high = zone.box.max()[axis];
      if (std::isfinite(low)) see(low - reach, low + zone.border + reach);
      if (std::isfinite(high)) see(high - zone.border - reach, high + reach);
    }
    varies = varies || varies_along;
    if (varies_along) continue;
    x[axis] = std::isfinite(below) ? below : std::isfinite(above) ? above : 0.0;
  }
  return varies;
}

template <int Dim>
double particles_of_full_zone(const SpacingField<Dim>& field, std::size_t zone, double spacing, const Box<Dim>& box) {
  constexpr int pieces = 64;  // along each edge
  const Box<Dim> inside = field.zones()[zone].box.intersection(box);
  if (inside.isEmpty()) return 0.0;
  const double all = power<Dim>(pieces);
  double count = 0.0;
  for (std::int64_t n = 0; n < static_cast<std::int64_t>(all); ++n) {
    Vec<Dim> x;
    std::int64_t rest = n;
    for (int axis = 0; axis < Dim; ++axis, rest /= pieces) {
      x[axis] = inside.min()[axis] + (static_cast<double>(rest % pieces) + 0.5) / pieces * inside.sizes()[axis];
    }
    count += inside.volume() / all / power<Dim>(spacing * field.at(x));
  }
  return count;
}

TAILWATER_IN_2D_AND_3D(particles_of_full_zone);
template class SpacingField<2>;
template class SpacingField<3>;

}  // namespace tailwater
