#include "probes/water_column.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/for_each.h"
#include "base/number_range.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"
#include "probes/places.h"
#include "probes/water_share.h"
#include "probes/wave_record.h"

namespace tailwater {
namespace {

/// Adds the crossings of the line through `place` with the faces of walls for which counts() is true.
template <int Dim, class Counts>
void add_crossings(const Boundary<Dim>& boundary, const Vec<Dim>& place, double spacing, Counts&& counts,
                   UprightLine<Dim>& line) {
  for (const WallFace<Dim>& face : boundary.faces) {
    if (!counts(face.wall)) continue;
    const double slope = face.normal.dot(line.up);
    if (std::abs(slope) < 1e-6) continue;  // the line is parallel to the face
    const Vec<Dim> hit = place - face.height(place) / slope * line.up;
    if ((closest_point(face, hit) - hit).norm() <= corner_tolerance * spacing) {
      line.crossings.push_back({(hit - line.foot).dot(line.up), face.normal, face.wall});
    }
  }
  // Both faces of a plate are at the same height, and the water above it is not below its underside.
  std::ranges::sort(line.crossings, std::ranges::greater(), [&](const Crossing<Dim>& crossing) {
    const bool is_top = boundary.walls[crossing.wall].is_plate && crossing.normal.dot(line.up) > 0.0;
    return crossing.height + (is_top ? corner_tolerance * spacing : 0.0);
  });
}

/// The path of the wall that is the bed of a gauge; null if it rests. Throws InputError if no path is known.
template <int Dim>
std::shared_ptr<const WallPath<Dim>> path_of_bed(const ProbeTable& probe, const CaseSpec& spec,
                                                 const Boundary<Dim>& boundary, int wall) {
  if (!boundary.walls[wall].moves()) return nullptr;
  const Drive& drive = spec.walls[wall].drive;
  const bool gives_way =
      drive.by == Drive::By::wave_maker && spec.wave_makers[drive.index].absorption == Absorption::active;
  if (gives_way || drive.by == Drive::By::body) {
    throw CaseError("probe-bed-moves",
                    {"{}: its bed is {}, which the water moves, and a probe cannot follow it", label(probe),
                     wall_label(boundary, wall)},
                    {"move the probe"});
  }
  return std::make_shared<WallPath<Dim>>(spec, spec.walls[wall], wall_label(boundary, wall));
}

/// dx; a level with smaller oscillations about its mean has no waves.
constexpr double wave_band = 0.125;

/// dx; water that begins lower than this stands on the bed. No air is so thin; in a narrow valley no particle is lower.
constexpr double thinnest_air = 1.0;

/// dx; the search for drops above the bed ends at this height.
constexpr double tallest_column = 1e4;

/// The position where the straight line from (0, `low`) to (`step`, `high`) crosses the surface fraction.
double passage(double low, double high, double step) { return step * (surface_share - low) / (high - low); }

/// The water column on `bed`; c is sampled up to the height `top`. A liquid that lies on others is connected with the
/// bed through them.
template <int Dim>
WaterColumn column_on(const ProbeContext<Dim>& context, const UprightLine<Dim>& line, const Crossing<Dim>& bed,
                      double top) {
  top = std::min(top, bed.height + tallest_column * context.spacing);
  const Vec<Dim> bed_point = line.foot + bed.height * line.up;
  const Vec<Dim> eye = in_front_of(context.boundary, bed.wall, bed.normal, bed_point, context.spacing);
  const bool bed_is_wet = water_share(context, eye) > surface_share;
  const auto share_at = [&](double depth) {
    const Vec<Dim> x = bed_point + depth * line.up;
    return bed_is_wet ? water_share_above_wet_bed(context, x, bed_point, bed.normal) : water_share(context, x);
  };

  WaterColumn column{.bed = bed.height};
  const double end = top - bed.height;
  bool is_connected = bed_is_wet;
  double depth = 0.0;
  double share = bed_is_wet ? 1.0 : 0.0;
  double wet_from = 0.0;  // begin of the present water on the line
  double first = 0.0;     // the first surface
  while (depth < end) {
    const double step = std::min(0.25 * context.spacing, end - depth);
    const double next_share = share_at(depth + step);
    if (share <= surface_share && next_share > surface_share) {
      wet_from = depth + passage(share, next_share, step);
      is_connected = is_connected || wet_from < thinnest_air * context.spacing;
    }
    if (share > surface_share && next_share <= surface_share) {
      column.highest = depth + passage(share, next_share, step);
      if (first == 0.0) first = column.highest;
      column.wet += column.highest - wet_from;
      if (is_connected) column.connected = column.highest;
      is_connected = false;
    }
    depth += step;
    share = next_share;
  }
  if (share > surface_share) {  // up to a ceiling
    column.highest = depth;
    column.wet += depth - wet_from;
    if (is_connected) column.connected = depth;
  }
  if (first == 0.0) first = column.highest;
  if (context.liquid >= 0 && !bed_is_wet && first > 0.0) {
    ProbeContext<Dim> of_all = context;
    of_all.liquid = -1;
    const bool is_above_others = column_on(of_all, line, bed, top).connected > first - 0.5 * context.spacing;
    if (is_above_others) column.connected = first;
  }
  return column;
}

}  // namespace

template <int Dim>
WaterColumns<Dim>::WaterColumns(const ProbeContext<Dim>& context) : context_(context) {
  const Particles<Dim>& particles = context.particles;
  const auto farthest = [&](int axis, double side) {
    return side * largest_over(particles.size(), -largest_number, [&](std::size_t i) {
             return context.is_measured(i) ? side * particles.position[i][axis] : -largest_number;
           });
  };
  for (int axis = 0; axis < Dim; ++axis) {
    low_[axis] = farthest(axis, -1.0);
    high_[axis] = farthest(axis, 1.0);
  }
}

template <int Dim>
WaterColumn WaterColumns<Dim>::on(const UprightLine<Dim>& line) const {
  // Above the highest corner of the box there is no water.
  const bool is_dry = low_[0] > high_[0];
  const double highest =
      is_dry ? -largest_number : line.up.cwiseProduct(low_).cwiseMax(line.up.cwiseProduct(high_)).sum();
  const double top = highest + kernel_radius(context_.kernel) - line.foot.dot(line.up);
  WaterColumn column;
  double ceiling = top;
  bool found_bed = false;
  for (const Crossing<Dim>& crossing : line.crossings) {
    if (crossing.normal.dot(line.up) < 0.0) {
      const bool is_plate = context_.boundary.walls[crossing.wall].is_plate;  // with other water on its upper side
      ceiling = std::min(top, crossing.height - (is_plate ? corner_tolerance * context_.spacing : 0.0));
      continue;
    }
    const WaterColumn candidate = column_on(context_, line, crossing, ceiling);
    // A dry line has depth 0 above its highest bed.
    if (!found_bed || candidate.highest > 0.0) column = candidate;
    found_bed = true;
    if (candidate.highest > 0.0) break;
  }
  return column;
}

template <int Dim>
Vec<Dim> upwards(const ProbeTable& probe, const CaseSpec& spec) {
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  if (gravity.norm() == 0.0) {
    throw CaseError("depth-without-gravity",
                    {"{} measures depths against gravity, but physics.gravity is 0", label(probe)},
                    {"set gravity or remove the probe"});
  }
  return -gravity.normalized();
}

template <int Dim>
UprightGauge<Dim>::UprightGauge(const ProbeTable& probe, const Vec<Dim>& at, const CaseSpec& spec,
                                const Boundary<Dim>& boundary)
    : at_(at), spacing_(spec.particles.spacing) {
  drawn_.up = upwards<Dim>(probe, spec);
  drawn_.foot = at - at.dot(drawn_.up) * drawn_.up;
  add_crossings(
      boundary, at, spacing_, [](int) { return true; }, drawn_);
  const auto is_bed = [&](const Crossing<Dim>& crossing) { return crossing.normal.dot(drawn_.up) > 0.0; };
  const auto bed = std::find_if(drawn_.crossings.rbegin(), drawn_.crossings.rend(), is_bed);  // the lowest
  if (bed == drawn_.crossings.rend()) {
    throw CaseError("depth-without-bed",
                    {"{}: the vertical line through {} meets no wall that faces up", label(probe), place(at)},
                    {"move it over a bed"});
  }
  path_ = path_of_bed(probe, spec, boundary, bed->wall);
  has_moving_walls_ = std::ranges::any_of(boundary.walls, &WallProperties::moves);
  std::ranges::copy_if(drawn_.crossings, std::back_inserter(resting_),
                       [&](const Crossing<Dim>& crossing) { return !boundary.walls[crossing.wall].moves(); });
}

template <int Dim>
double UprightGauge<Dim>::highest_bed() const {
  return std::ranges::find_if(drawn_.crossings, [&](const auto& c) { return c.normal.dot(drawn_.up) > 0.0; })->height;
}

template <int Dim>
UprightLine<Dim> UprightGauge<Dim>::now(const ProbeContext<Dim>& context) const {
  if (!has_moving_walls_) return drawn_;
  const AffineMap<Dim> map = displacement(context.time);
  UprightLine<Dim> line{map(drawn_.foot), map.linear * drawn_.up, {}};
  if (!path_) line.crossings = resting_;
  const auto counts = [&](int wall) { return path_ || context.boundary.walls[wall].moves(); };
  add_crossings(context.boundary, map(at_), spacing_, counts, line);
  return line;
}

template <int Dim>
Region<Dim> UprightGauge<Dim>::region(double time) const {
  const AffineMap<Dim> map = displacement(time);
  const Vec<Dim> foot = map(drawn_.foot);
  return {foot, foot, map.linear * drawn_.up};
}

template <int Dim>
Reading<Dim> depth_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const Vec<Dim> at = to_vec<Dim>(probe.at, label(probe), "at");
  const UprightGauge<Dim> gauge(probe, at, spec, boundary);
  Reading<Dim> reading;
  const auto waves = std::make_shared<WaveRecord>(wave_band * spec.particles.spacing);
  reading.memory = waves->memory();
  reading.memory_grows = true;
  reading.columns = columns_of(probe, Dim);
  reading.take = [gauge, waves](const ProbeContext<Dim>& context) -> std::vector<Row> {
    const WaterColumn column = WaterColumns<Dim>(context).on(gauge.now(context));
    waves->add(context.time, column.highest);
    return {{column.connected, column.highest, column.wet}};
  };
  reading.region = [gauge](double time) { return gauge.region(time); };
  reading.totals = [waves] { return waves->totals(); };
  return reading;
}

template <int Dim>
Reading<Dim> profile_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const std::vector<Vec<Dim>> places = places_between<Dim>(probe, spec.particles.spacing);
  std::vector<UprightGauge<Dim>> gauges;
  for (const Vec<Dim>& at : places) gauges.emplace_back(probe, at, spec, boundary);
  return {columns_of(probe, Dim),
          [places, gauges](const ProbeContext<Dim>& context) {
            const WaterColumns<Dim> water(context);
            std::vector<Row> rows;
            for (std::size_t k = 0; k < gauges.size(); ++k) {
              const WaterColumn column = water.on(gauges[k].now(context));
              Row row(places[k].begin(), places[k].begin() + (Dim - 1));
              row.insert(row.end(), {column.bed, column.connected, column.highest});
              rows.push_back(std::move(row));
            }
            return rows;
          },
          [gauges](double time) { return region_of(gauges, time); }};
}

template class UprightGauge<2>;
template class UprightGauge<3>;
template class WaterColumns<2>;
template class WaterColumns<3>;
TAILWATER_IN_2D_AND_3D(upwards);
TAILWATER_IN_2D_AND_3D(depth_reading);
TAILWATER_IN_2D_AND_3D(profile_reading);

}  // namespace tailwater
