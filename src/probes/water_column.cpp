#include "probes/water_column.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/for_each.h"
#include "geometry/from_spec.h"
#include "probes/places.h"
#include "probes/water_share.h"
#include "probes/wave_record.h"

namespace tailwater {
namespace {

/// The faces that the line through `place` along `up` meets, highest first.
template <int Dim>
std::vector<Crossing<Dim>> find_crossings(const Boundary<Dim>& boundary, const Vec<Dim>& place, const Vec<Dim>& up,
                                          double spacing) {
  std::vector<Crossing<Dim>> crossings;
  for (const WallFace<Dim>& face : boundary.faces) {
    const double slope = face.normal.dot(up);
    if (std::abs(slope) < 1e-6) continue;  // the line is parallel to the face
    const Vec<Dim> hit = place - face.height(place) / slope * up;
    if ((closest_point(face, hit) - hit).norm() <= corner_tolerance * spacing) {
      crossings.push_back({hit.dot(up), face.normal});
    }
  }
  std::sort(crossings.begin(), crossings.end(), [](const auto& a, const auto& b) { return a.height > b.height; });
  return crossings;
}

/// dx; a level that trembles by less about its mean has no waves.
constexpr double wave_band = 0.125;

/// dx; a drop that was thrown higher above the bed is not looked for.
constexpr double tallest_column = 1e4;

/// Where the straight line from (0, `low`) to (`step`, `high`) passes the surface share.
double passage(double low, double high, double step) { return step * (surface_share - low) / (high - low); }

/// The water column on `bed`; c is sampled up to the height `top`.
template <int Dim>
WaterColumn column_on(const ProbeContext<Dim>& context, const UprightLine<Dim>& line, const Crossing<Dim>& bed,
                      double top) {
  top = std::min(top, bed.height + tallest_column * context.spacing);
  const Vec<Dim> bed_point = line.foot + bed.height * line.up;
  const bool bed_is_wet = water_share(context, bed_point) > surface_share;
  const auto share_at = [&](double depth) {
    const Vec<Dim> x = bed_point + depth * line.up;
    return bed_is_wet ? water_share_above_wet_bed(context, x, bed_point, bed.normal) : water_share(context, x);
  };

  WaterColumn column{.bed = bed.height};
  const double end = top - bed.height;
  bool is_connected = bed_is_wet;
  double depth = 0.0;
  double share = bed_is_wet ? 1.0 : 0.0;
  double wet_from = 0.0;  // where the water that the line is in begins
  while (depth < end) {
    const double step = std::min(0.25 * context.spacing, end - depth);
    const double next_share = share_at(depth + step);
    if (share <= surface_share && next_share > surface_share) wet_from = depth + passage(share, next_share, step);
    if (share > surface_share && next_share <= surface_share) {
      column.highest = depth + passage(share, next_share, step);
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
  return column;
}

}  // namespace

template <int Dim>
WaterColumn read_column(const ProbeContext<Dim>& context, const UprightLine<Dim>& line, double top) {
  WaterColumn column;
  double ceiling = top;
  bool found_bed = false;
  for (const Crossing<Dim>& crossing : line.crossings) {
    if (crossing.normal.dot(line.up) < 0.0) {
      ceiling = std::min(top, crossing.height);
      continue;
    }
    const WaterColumn candidate = column_on(context, line, crossing, ceiling);
    // A dry line has depth 0 above its highest bed.
    if (!found_bed || candidate.highest > 0.0) column = candidate;
    found_bed = true;
    if (candidate.highest > 0.0) break;
  }
  return column;
}

template <int Dim>
double top_of_water(const ProbeContext<Dim>& context, const Vec<Dim>& up) {
  constexpr double nowhere = -std::numeric_limits<double>::max();
  const double highest = largest_over(context.particles.size(), nowhere, [&](std::size_t i) {
    return context.particles.is_fluid(i) ? context.particles.position[i].dot(up) : nowhere;
  });
  return highest + kernel_radius(context.kernel);
}

template <int Dim>
Vec<Dim> upwards(const ProbeTable& probe, const CaseSpec& spec) {
  const Vec<Dim> gravity = to_vec<Dim>(spec.physics.gravity, "physics", "gravity");
  if (gravity.norm() == 0.0) {
    throw InputError(
        fmt::format("{} measures depths against gravity, but physics.gravity is 0: set gravity or remove "
                    "the probe",
                    label(probe)));
  }
  return -gravity.normalized();
}

template <int Dim>
UprightLine<Dim>::UprightLine(const ProbeTable& probe, const Vec<Dim>& at, const Vec<Dim>& direction,
                              const Boundary<Dim>& boundary, double spacing)
    : foot(at - at.dot(direction) * direction), up(direction), crossings(find_crossings(boundary, at, up, spacing)) {
  const bool has_bed = std::any_of(crossings.begin(), crossings.end(),
                                   [&](const Crossing<Dim>& crossing) { return crossing.normal.dot(up) > 0.0; });
  if (!has_bed) {
    throw InputError(fmt::format("{}: the vertical line through {} meets no wall that looks up: move it over a bed",
                                 label(probe), place(at)));
  }
}

template <int Dim>
Reading<Dim> depth_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const Vec<Dim> at = to_vec<Dim>(probe.at, label(probe), "at");
  const UprightLine<Dim> line(probe, at, upwards<Dim>(probe, spec), boundary, spec.particles.spacing);
  Reading<Dim> reading;
  const auto waves = std::make_shared<WaveRecord>(wave_band * spec.particles.spacing);
  reading.memory = waves->memory();
  reading.memory_grows = true;
  reading.columns = {"connected_m", "highest_m", "wet_m"};
  reading.take = [line, waves](const ProbeContext<Dim>& context) -> std::vector<Row> {
    const WaterColumn column = read_column(context, line, top_of_water(context, line.up));
    waves->add(context.time, column.highest);
    return {{column.connected, column.highest, column.wet}};
  };
  reading.region = [line](double) { return Region<Dim>{line.foot, line.foot, line.up}; };
  reading.summary = [waves] { return waves->summary(); };
  return reading;
}

template <int Dim>
Reading<Dim> profile_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const Vec<Dim> up = upwards<Dim>(probe, spec);
  std::vector<Vec<Dim>> places;
  std::vector<UprightLine<Dim>> lines;
  for (const Vec<Dim>& at : places_between<Dim>(probe, spec.particles.spacing)) {
    places.push_back(at);
    lines.emplace_back(probe, at, up, boundary, spec.particles.spacing);
  }
  std::vector<std::string> columns{"x_m", "bed_m", "connected_m", "highest_m"};
  if (Dim == 3) columns.insert(columns.begin() + 1, "y_m");
  return {columns,
          [up, places, lines](const ProbeContext<Dim>& context) {
            const double top = top_of_water(context, up);
            std::vector<Row> rows;
            for (std::size_t k = 0; k < lines.size(); ++k) {
              const WaterColumn column = read_column(context, lines[k], top);
              Row row(places[k].begin(), places[k].begin() + (Dim - 1));
              row.insert(row.end(), {column.bed, column.connected, column.highest});
              rows.push_back(std::move(row));
            }
            return rows;
          },
          [region = Region<Dim>{places.front(), places.back(), up}](double) { return region; }};
}

template struct UprightLine<2>;
template struct UprightLine<3>;
template Vec<2> upwards<2>(const ProbeTable&, const CaseSpec&);
template Vec<3> upwards<3>(const ProbeTable&, const CaseSpec&);
template double top_of_water<2>(const ProbeContext<2>&, const Vec<2>&);
template double top_of_water<3>(const ProbeContext<3>&, const Vec<3>&);
template WaterColumn read_column<2>(const ProbeContext<2>&, const UprightLine<2>&, double);
template WaterColumn read_column<3>(const ProbeContext<3>&, const UprightLine<3>&, double);
template Reading<2> depth_reading<2>(const ProbeTable&, const CaseSpec&, const Boundary<2>&);
template Reading<3> depth_reading<3>(const ProbeTable&, const CaseSpec&, const Boundary<3>&);
template Reading<2> profile_reading<2>(const ProbeTable&, const CaseSpec&, const Boundary<2>&);
template Reading<3> profile_reading<3>(const ProbeTable&, const CaseSpec&, const Boundary<3>&);

}  // namespace tailwater
