#include "refinement/spacing_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/box.h"
#include "geometry/from_spec.h"

namespace tailwater {
namespace {

double smooth_step(double q) {
  const double s = std::clamp(q, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

}  // namespace

double spacing_behind_face(int level, double depth) { return std::exp2(-level * smooth_step(depth)); }

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
double SpacingField<Dim>::finest() const {
  int level = 0;
  for (const Zone& zone : zones_) level = std::max(level, zone.level);
  return std::exp2(-level);
}

template <int Dim>
SpacingNearby<Dim> SpacingField<Dim>::nearby(const Vec<Dim>& x, double reach) const {
  using Kind = typename SpacingNearby<Dim>::Kind;
  const Vec<Dim> inside = wrapped(x);
  SpacingNearby<Dim> nearby;
  const Vec<Dim> period = periodic_.sizes();
  bool is_inside_another = false;  // where a zone has its finest spacing
  for (const Zone& zone : zones_) {
    SpacingNearby<Dim> own;
    bool is_outside = false;
    bool is_near_image = false;
    for (int axis = 0; axis < Dim; ++axis) {
      const double low = zone.box.min()[axis];
      const double high = zone.box.max()[axis];
      // Beside the end of a period a zone at the other end is near.
      const double from_end = std::min(inside[axis] - periodic_.min()[axis], periodic_.max()[axis] - inside[axis]);
      is_near_image = is_near_image || (period[axis] > 0.0 && std::isfinite(low) && from_end < reach);
      for (const double sign : {1.0, -1.0}) {
        const double depth = sign > 0.0 ? inside[axis] - low : high - inside[axis];
        is_outside = is_outside || depth <= -reach;
        if (depth >= zone.border + reach) continue;
        own.kind = own.kind == Kind::uniform ? Kind::one_face : Kind::any;
        own.level = zone.level;
        own.depth = depth;
        own.inwards = sign * Vec<Dim>::Unit(axis);
      }
    }
    if (is_outside && !is_near_image) continue;
    if (is_near_image) own.kind = Kind::any;
    if (own.kind == Kind::uniform) is_inside_another = true;
    if (own.kind != Kind::uniform && nearby.kind != Kind::uniform) own.kind = Kind::any;
    if (own.kind != Kind::uniform) nearby = own;
  }
  if (is_inside_another && nearby.kind == Kind::one_face) nearby.kind = Kind::any;
  return nearby;
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
template struct SpacingNearby<2>;
template struct SpacingNearby<3>;
template class SpacingField<2>;
template class SpacingField<3>;

}  // namespace tailwater
