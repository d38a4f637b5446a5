#include "refinement/spacing_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "base/box.h"
#include "base/fp_traps.h"
#include "case/named_numbers.h"
#include "geometry/from_spec.h"
#include "geometry/mesh_surface.h"
#include "refinement/zone_depth.h"
#include "refinement/zone_words.h"

namespace tailwater {
namespace {

double smooth_step(double q) {
  const double s = std::clamp(q, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

/// Derivative of the logarithm of the smooth step.
double log_slope_of_step(double q) { return q > 0.0 && q < 1.0 ? 6.0 * (1.0 - q) / (q * (3.0 - 2.0 * q)) : 0.0; }

double slope_of_step(double q) { return q > 0.0 && q < 1.0 ? 6.0 * q * (1.0 - q) : 0.0; }

/// m; the highest point of the water at the start.
template <int Dim>
double initial_surface(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  double highest = std::numeric_limits<double>::lowest();
  for (std::size_t b = 0; b < spec.fluid.size(); ++b) {
    const FluidTable& block = spec.fluid[b];
    if (block.shape == BlockShape::fill) highest = std::max(highest, block.level);
    if (block.shape == BlockShape::box) highest = std::max(highest, block.max.back());
    for (const Coordinates& point : block.points) highest = std::max(highest, point.back());
    if constexpr (Dim == 3) {
      if (block.shape == BlockShape::mesh) highest = std::max(highest, boundary.water[b]->high()[Dim - 1]);
    }
  }
  return highest;
}

/// Whether the surface at the start is perpendicular to the last axis. Boxes and fills have such a surface also where
/// the axes are turned along a sloping bed; polygons and meshes are then most likely drawn level.
bool surface_is_across(const CaseSpec& spec) {
  constexpr double upright = 1.0 - 1e-12;  // cosine between gravity and the way down along that axis
  if (spec.physics.gravity.back() <= -upright * gravity_magnitude(spec.physics)) return true;
  return gravity_points_down(spec.physics) && std::ranges::all_of(spec.fluid, [](const FluidTable& block) {
           return block.shape == BlockShape::box || block.shape == BlockShape::fill;
         });
}

/// The box of a zone that is one, as it is given.
template <int Dim>
Box<Dim> box_of(const CaseSpec& spec, const RefinementTable& table, const Boundary<Dim>& boundary, double border) {
  const CaseLabel owner("refinement", table.name);
  if (table.shape == ZoneShape::box) {
    return {to_vec<Dim>(table.min, owner, "min"), to_vec<Dim>(table.max, owner, "max")};
  }
  if (spec.fluid.empty()) {
    throw CaseError("zone-without-surface",
                    {"{} follows the surface of the water, and there is no water at the start", owner},
                    {"give shape = \"box\""});
  }
  if (!surface_is_across(spec)) {
    throw CaseError("zone-surface-not-level",
                    {"{} follows a level water surface, and gravity does not act along -{}", owner, "xyz"[Dim - 1]},
                    {"give shape = \"polygon\", or turn the case"});
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Box<Dim> box(Vec<Dim>::Constant(-infinity), Vec<Dim>::Constant(infinity));
  box.min()[Dim - 1] = initial_surface(spec, boundary) - table.distance - border;
  return box;
}

}  // namespace

template <int Dim>
SpacingField<Dim>::SpacingField(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double dx = spec.particles.spacing;
  Box<Dim> outermost = box_around(boundary.faces);
  periodic_.min().setZero();
  periodic_.max().setZero();
  if (outermost.isEmpty()) outermost = {Vec<Dim>::Constant(-infinity), Vec<Dim>::Constant(infinity)};
  for (int axis = 0; axis < Dim; ++axis) {
    const std::vector<double>& range = periodic_range(spec.domain, axis);
    if (range.empty()) continue;
    periodic_.min()[axis] = outermost.min()[axis] = range[0];
    periodic_.max()[axis] = outermost.max()[axis] = range[1];
  }
  for (const RefinementTable& table : spec.refinement) {
    Zone zone{{}, table.level, border_per_level * table.level * dx, nullptr};
    for (std::size_t w = 0; table.shape == ZoneShape::walls && carrier_ < 0 && w < boundary.walls.size(); ++w) {
      const WallProperties& wall = boundary.walls[w];
      if (wall.moves() && std::ranges::count(table.walls, wall.name) > 0) carrier_ = static_cast<int>(w);
    }
    Box<Dim> bounds = outermost;
    if (is_displaced(table)) {
      require_dimension<Dim>(table.displacement.size(), CaseLabel("refinement", table.name).with_key("displacement"));
      displacement_.clear();
      for (int axis = 0; axis < Dim; ++axis) {
        displacement_.emplace_back(table.displacement[axis], named_numbers(spec));
        if (table.displacement[axis] == Varying(0.0) || periodic_.sizes()[axis] > 0.0) continue;
        bounds.min()[axis] = -infinity;
        bounds.max()[axis] = infinity;
      }
    }
    if (table.shape == ZoneShape::polygon || table.shape == ZoneShape::walls) {
      zone.depth = std::make_shared<ZoneDepth<Dim>>(table, boundary, bounds, periodic_.sizes(), zone.border, dx);
      zone.box = zone.depth->box();
      has_depths_ = true;
    } else {
      zone.box = box_of(spec, table, boundary, zone.border);
    }
    for (int axis = 0; axis < Dim; ++axis) {
      const double tolerance = corner_tolerance * dx;
      const bool has_images = zone.depth != nullptr && periodic_.sizes()[axis] > 0.0;
      if (has_images || zone.box.min()[axis] <= bounds.min()[axis] + tolerance) zone.box.min()[axis] = -infinity;
      if (has_images || zone.box.max()[axis] >= bounds.max()[axis] - tolerance) zone.box.max()[axis] = infinity;
    }
    zones_.push_back(zone);
  }
  if (carrier_ >= 0 || !displacement_.empty()) motion_ = std::make_shared<Motion>();
  if (!displacement_.empty()) carry(Mat<Dim>::Identity(), displacement(0.0));
  are_prisms_ = Dim == 3 && std::ranges::all_of(spec.refinement, [](const RefinementTable& table) {
                  return table.shape == ZoneShape::polygon;
                });
}

template <int Dim>
void SpacingField<Dim>::carry(const Mat<Dim>& turn, const Vec<Dim>& shift) const {
  *motion_ = {turn, shift};
}

template <int Dim>
Vec<Dim> SpacingField<Dim>::displacement(double time) const {
  const SuspendFpTraps suspended;  // the values may not be finite
  Vec<Dim> moved = Vec<Dim>::Zero();
  for (std::size_t axis = 0; axis < displacement_.size(); ++axis) moved[axis] = displacement_[axis].at(time);
  return moved;
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
double SpacingField<Dim>::at_drawn(const Vec<Dim>& x) const {
  const Vec<Dim> inside = wrapped(x);
  double least = 1.0;
  for (const Zone& zone : zones_) least = std::min(least, in_zone(zone, inside));
  return least;
}

template <int Dim>
double SpacingField<Dim>::in_zone(const Zone& zone, const Vec<Dim>& inside) {
  if (!zone.box.contains(inside)) return 1.0;
  if (zone.depth != nullptr) return std::exp2(-zone.level * smooth_step(zone.depth->depth(inside) / zone.border));
  double steps = 1.0;
  for (int axis = 0; axis < Dim; ++axis) {
    steps *= smooth_step((inside[axis] - zone.box.min()[axis]) / zone.border);
    steps *= smooth_step((zone.box.max()[axis] - inside[axis]) / zone.border);
  }
  return std::exp2(-zone.level * steps);
}

template <int Dim>
Vec<Dim> SpacingField<Dim>::slope(const Vec<Dim>& x) const {
  return motion_ == nullptr ? slope_drawn(x) : Vec<Dim>(motion_->turn * slope_drawn(drawn(x)));
}

template <int Dim>
Vec<Dim> SpacingField<Dim>::slope_drawn(const Vec<Dim>& x) const {
  const Vec<Dim> inside = wrapped(x);
  double least = 1.0;
  Vec<Dim> slope = Vec<Dim>::Zero();
  for (const Zone& zone : zones_) {
    if (!zone.box.contains(inside)) continue;
    if (zone.depth != nullptr) {
      const auto [depth, slope_of_depth] = zone.depth->at(inside);
      const double h = std::exp2(-zone.level * smooth_step(depth / zone.border));
      if (h >= least) continue;
      least = h;
      slope = -zone.level * std::numbers::ln2 * h * slope_of_step(depth / zone.border) / zone.border * slope_of_depth;
      continue;
    }
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
typename SpacingField<Dim>::NearestBorder SpacingField<Dim>::nearest_border_drawn(const Vec<Dim>& x) const {
  const Vec<Dim> inside = wrapped(x);
  NearestBorder nearest{-1, std::numeric_limits<double>::infinity()};
  for (std::size_t n = 0; n < zones_.size(); ++n) {
    const double depth = depth_in(zones_[n], inside);
    const double distance = std::max({-depth, depth - zones_[n].border, 0.0});
    if (distance < nearest.distance) nearest = {static_cast<int>(n), distance};
  }
  return nearest;
}

template <int Dim>
double SpacingField<Dim>::depth_in(const Zone& zone, const Vec<Dim>& x) const {
  if (zone.depth != nullptr) return zone.depth->depth(x);
  const Vec<Dim> period = periodic_.sizes();
  double depth = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < Dim; ++axis) {
    double along = -std::numeric_limits<double>::infinity();
    for (const double image : {0.0, period[axis], -period[axis]}) {
      const double at = x[axis] + image;
      along = std::max(along, std::min(at - zone.box.min()[axis], zone.box.max()[axis] - at));
    }
    depth = std::min(depth, along);
  }
  return depth;
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
  if constexpr (Dim == 3) {
    if (are_prisms_) x[2] = 0.0;
  }
  if (has_depths_) return nearest_border_drawn(x).distance <= reach;
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

namespace {

/// Particles of a spacing in a zone that is full of water, moved by `shift` [m] from where it is drawn.
template <int Dim>
double count_in_zone(const SpacingField<Dim>& field, const typename SpacingField<Dim>::Zone& zone, double spacing,
                     const Vec<Dim>& shift, const Box<Dim>& box, const Boundary<Dim>& boundary) {
  constexpr int pieces = Dim == 2 ? 64 : 32;  // along each edge
  const Box<Dim> inside = Box<Dim>(zone.box.min() + shift, zone.box.max() + shift).intersection(box);
  if (inside.isEmpty()) return 0.0;
  const double all = power<Dim>(pieces);
  double count = 0.0;
  for (std::int64_t n = 0; n < static_cast<std::int64_t>(all); ++n) {
    Vec<Dim> x;
    std::int64_t rest = n;
    for (int axis = 0; axis < Dim; ++axis, rest /= pieces) {
      x[axis] = inside.min()[axis] + (static_cast<double>(rest % pieces) + 0.5) / pieces * inside.sizes()[axis];
    }
    const Vec<Dim> drawn = x - shift;
    if (zone.depth != nullptr && zone.depth->depth(drawn) <= 0.0) continue;
    const NearestWall<Dim> wall = boundary.nearest(x, std::numeric_limits<double>::infinity());
    if (wall.face >= 0 && wall.signed_distance < 0.0) continue;
    count += inside.volume() / all / power<Dim>(spacing * field.at_drawn(drawn));
  }
  return count;
}

}  // namespace

template <int Dim>
double particles_of_full_zone(const SpacingField<Dim>& field, std::size_t number, const CaseSpec& spec,
                              const Box<Dim>& box, const Boundary<Dim>& boundary) {
  constexpr int looks = 10;  // at the way of a zone that moves
  double most = 0.0;
  Vec<Dim> before = Vec<Dim>::Constant(std::numeric_limits<double>::infinity());
  for (int k = 0; k <= looks; ++k) {
    const Vec<Dim> shift = field.displacement(spec.time.end * k / looks);
    if (!shift.allFinite() || shift == before) continue;
    most = std::max(most, count_in_zone(field, field.zones()[number], spec.particles.spacing, shift, box, boundary));
    before = shift;
  }
  return most;
}

TAILWATER_IN_2D_AND_3D(particles_of_full_zone);
template class SpacingField<2>;
template class SpacingField<3>;

}  // namespace tailwater
