#include "probes/wall_pressure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "base/for_each.h"
#include "case/formulation.h"
#include "geometry/rotation.h"
#include "geometry/wall_label.h"
#include "motion/wall_motion.h"
#include "probes/places.h"
#include "probes/water_share.h"

namespace tailwater {
namespace {

/// e; relative weight with which the walls impose no acceleration. It matters only in directions that no wall blocks.
constexpr double weight_of_rest = 1e-3;

/// dx; distance from a plate at which only the water of one side is seen.
constexpr double beside_plate = 0.01;

/// A point of a wall, which moves with the wall.
template <int Dim>
struct PointOnWall {
  Vec<Dim> drawn;
  std::shared_ptr<const WallPath<Dim>> path;  ///< null: the wall rests

  Vec<Dim> at(double time) const { return path ? path->at(time)(drawn) : drawn; }
};

template <int Dim>
PointOnWall<Dim> point_on_wall(const ProbeTable& probe, const Vec<Dim>& x, const CaseSpec& spec,
                               const Boundary<Dim>& boundary) {
  const double support = traits_of(spec).support * spec.particles.spacing;
  const NearestWall<Dim> nearest = boundary.nearest(x, support);
  if (nearest.face < 0) {
    throw CaseError("probe-off-wall",
                    {"{}: no wall within {:.4g} m (the kernel's support) of {}", label(probe), support, place(x)},
                    {"move it onto a wall"});
  }
  const int wall = boundary.faces[nearest.face].wall;
  const double dx = spec.particles.spacing;
  if (boundary.walls[wall].is_plate && nearest.signed_distance <= corner_tolerance * dx) {
    throw CaseError(
        "probe-on-plate",
        {"{}: {} is on {}, a plate that has water on both sides", label(probe), place(x), wall_label(boundary, wall)},
        {"move it by a millimetre to the side that it is to read"});
  }
  const Vec<Dim> point = in_front_of(boundary, wall, boundary.faces[nearest.face].normal, nearest.point, dx);
  if (!boundary.walls[wall].moves()) return {point, nullptr};
  const Drive& drive = spec.walls[wall].drive;
  if (drive.by == Drive::By::wave_maker && spec.wave_makers[drive.index].absorption == Absorption::active) {
    throw CaseError(
        "probe-on-absorbing-wall",
        {"{}: {} absorbs waves by moving, and a probe cannot follow it", label(probe), wall_label(boundary, wall)},
        {"move the probe, or give absorption = \"none\""});
  }
  if (drive.by == Drive::By::body) {
    throw CaseError("probe-on-body",
                    {"{}: {} belongs to body '{}', which the water moves, and a probe cannot follow it", label(probe),
                     wall_label(boundary, wall), spec.bodies[drive.index].name},
                    {"move the probe, or take type = \"force\" with a region"});
  }
  return {point, std::make_shared<WallPath<Dim>>(spec, spec.walls[wall], wall_label(boundary, wall))};
}

/// The region around the points, which may lie on several lines.
template <int Dim>
Region<Dim> region_of(const std::vector<PointOnWall<Dim>>& points, double time) {
  Region<Dim> region{points.front().at(time), points.back().at(time)};
  for (const PointOnWall<Dim>& point : points) region.margin = std::max(region.margin, region.distance(point.at(time)));
  return region;
}

/// The normal of the wall at `x`; of any wall if none is near, which point_on_wall rejects later.
template <int Dim>
Vec<Dim> normal_at(const Vec<Dim>& x, const Boundary<Dim>& boundary) {
  const NearestWall<Dim> nearest = boundary.nearest(x, std::numeric_limits<double>::infinity());
  return nearest.face < 0 ? Vec<Dim>(Vec<Dim>::Unit(0)) : boundary.faces[nearest.face].normal;
}

/// Places over a disc in the wall, all with the same weight. A square around the disc is divided into squares at most
/// dx/2 long; the places are the centres of those in the disc.
template <int Dim>
std::vector<Vec<Dim>> places_on_disc(const ProbeTable& probe, const Vec<Dim>& centre, const CaseSpec& spec,
                                     const Boundary<Dim>& boundary) {
  const Vec<Dim> normal = normal_at(centre, boundary);
  const double step = 0.5 * spec.particles.spacing;
  require_few_places(probe, std::pow(probe.diameter / step, Dim - 1));
  const int count = pieces_of_at_most(step, probe.diameter);
  const auto from_centre = [&](int k) { return ((k + 0.5) / count - 0.5) * probe.diameter; };
  std::vector<Vec<Dim>> places;
  if constexpr (Dim == 2) {
    for (int k = 0; k < count; ++k) places.push_back(centre + from_centre(k) * Vec<2>(-normal[1], normal[0]));
  } else {
    const Vec<3> along = across(normal);
    const Vec<3> upwards = normal.cross(along);
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k < count; ++k) {
        if (std::hypot(from_centre(i), from_centre(k)) > 0.5 * probe.diameter) continue;
        places.push_back(centre + from_centre(i) * along + from_centre(k) * upwards);
      }
    }
  }
  return places;
}

/// Places over the stretch from `from` to `to`, and to both sides of it in the wall by half the `width`.
template <int Dim>
std::vector<Vec<Dim>> places_on_strip(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const double step = 0.5 * spec.particles.spacing;
  std::vector<Vec<Dim>> line = places_between<Dim>(probe, step);
  if (probe.width == 0.0) return line;
  if constexpr (Dim == 2) {
    throw CaseError("probe-width-in-2d",
                    {"{} = {}: a wall in 2D has no width", label(probe).with_key("width"), Amount{probe.width, "m"}},
                    {"leave it out"});
  } else {
    const Vec<3> along = to_vec<3>(probe.to, label(probe), "to") - to_vec<3>(probe.from, label(probe), "from");
    const Vec<3> across = normal_at(line[line.size() / 2], boundary).cross(along).normalized();
    require_few_places(probe, static_cast<double>(line.size()) * (probe.width / step));
    const int count = pieces_of_at_most(step, probe.width);
    std::vector<Vec<3>> places;
    for (const Vec<3>& x : line) {
      for (int k = 0; k < count; ++k) places.push_back(x + ((k + 0.5) / count - 0.5) * probe.width * across);
    }
    return places;
  }
}

/// Pa; pressure of the air at a place on a wall with this normal. It is read dx in front, as a plate has other air
/// behind.
template <int Dim>
double air_pressure_on(const ProbeContext<Dim>& context, const Vec<Dim>& x_w, const Vec<Dim>& normal) {
  return context.air_pressure_at(x_w + context.spacing * normal);
}

/// A pressure with its impulse since the start. The reading at the end of a step counts for the whole step.
template <int Dim>
Reading<Dim> with_impulse(Reading<Dim> reading) {
  reading.memory = std::make_shared<std::vector<double>>(2, 0.0);
  reading.take = [take = std::move(reading.take), memory = reading.memory](const ProbeContext<Dim>& context) {
    std::vector<Row> rows = take(context);
    double& last_time = memory->front();  // s
    double& impulse = memory->back();     // Pa s
    impulse += rows.front().front() * (context.time - last_time);
    last_time = context.time;
    rows.front().push_back(impulse);
    return rows;
  };
  reading.adds_up = true;
  return reading;
}

/// The mean over points of walls.
template <int Dim>
Reading<Dim> mean_over(const std::vector<Vec<Dim>>& places, const ProbeTable& probe, const CaseSpec& spec,
                       const Boundary<Dim>& boundary) {
  std::vector<PointOnWall<Dim>> points;
  for (const Vec<Dim>& x : places) points.push_back(point_on_wall(probe, x, spec, boundary));
  return with_impulse<Dim>({columns_of(probe, Dim),
                            [points](const ProbeContext<Dim>& context) -> std::vector<Row> {
                              double sum = 0.0;
                              double wet = 0.0;
                              for (const PointOnWall<Dim>& point : points) {
                                const PressureOnWall pressure = wall_pressure(context, point.at(context.time));
                                sum += pressure.value;
                                wet += pressure.is_wet ? 1.0 : 0.0;
                              }
                              const double count = static_cast<double>(points.size());
                              return {{sum / count, wet / count}};
                            },
                            [points](double time) { return region_of(points, time); }});
}

}  // namespace

double averaging_time(double key, double spacing, double speed, double gravity) {
  constexpr double rows = 3.0;           // dx
  constexpr double part_of_depth = 0.1;  // H
  if (key > 0.0) return key;
  if (speed <= 0.0 || gravity <= 0.0) return 0.0;
  const double depth = speed * speed / (2.0 * gravity);
  return std::max(rows * spacing, part_of_depth * depth) / speed;
}

template <int Dim>
void WallPressureSums<Dim>::add(const ProbeContext<Dim>& context, const Vec<Dim>& x_w, std::int32_t j,
                                const Vec<Dim>& x_j, double weight) {
  if (!context.particles.is_fluid(j)) {
    wall += weight;
    if (context.wall_inertia == nullptr) return;
    blocked += weight * context.wall_inertia->blocked[context.particles.wall_row[j]];
    acceleration += weight * context.wall_inertia->acceleration_at(context.particles, j);
    return;
  }
  const double p_j = context.particles.pressure[j];
  least = std::min(least, p_j);
  pressure += weight * (p_j + context.density_of(j) * context.gravity.dot(x_w - x_j));
  water += weight;
  if (context.wall_inertia != nullptr) offset += weight * context.density_of(j) * (x_w - x_j);
}

template <int Dim>
void WallPressureSums<Dim>::add_owned(const ProbeContext<Dim>& context, const Vec<Dim>& x_w, const Vec<Dim>& shift) {
  const Vec<Dim> near = x_w - shift;
  for_each_weight(context, near, [&](std::int32_t j, double weight) {
    if (static_cast<std::size_t>(j) < context.particles.owned) {
      add(context, near, j, context.particles.position[j], weight);
    }
  });
}

template <int Dim>
std::optional<double> WallPressureSums<Dim>::value() const {
  if (water_share<Dim>(water, wall) <= surface_share) return std::nullopt;
  return std::max((pressure - acceleration_of_water().dot(offset)) / water, least);
}

template <int Dim>
Vec<Dim> WallPressureSums<Dim>::acceleration_of_water() const {
  if (acceleration.isZero(0.0)) return acceleration;
  return (blocked + weight_of_rest * wall * Mat<Dim>::Identity()).inverse() * acceleration;
}

template <int Dim>
PressureOnWall wall_pressure(const ProbeContext<Dim>& context, const Vec<Dim>& x_w, const Vec<Dim>& normal,
                             const WallPressureSums<Dim>& sums) {
  if (const std::optional<double> of_water = sums.value()) return {*of_water, true};
  return {air_pressure_on(context, x_w, normal), false};
}

template <int Dim>
PressureOnWall wall_pressure(const ProbeContext<Dim>& context, const Vec<Dim>& x_w) {
  WallPressureSums<Dim> sums;
  for_each_weight(context, x_w, [&](std::int32_t j, double weight) {
    sums.add(context, x_w, j, context.particles.position[j], weight);
  });
  Vec<Dim> normal = Vec<Dim>::Zero();
  if (context.air_pressure) {
    const NearestWall<Dim> wall = context.boundary.nearest(x_w, context.spacing);
    if (wall.face >= 0) normal = context.boundary.faces[wall.face].normal;
  }
  return wall_pressure(context, x_w, normal, sums);
}

/// Whether another wall stands on a wall of this normal: the place in front, at most `reach` (m) away, is behind it.
template <int Dim>
bool is_covered(const Boundary<Dim>& boundary, const Vec<Dim>& normal, const Vec<Dim>& place, double reach) {
  constexpr double max_cosine = 0.7;  // of walls that stand on the other
  bool is_covered = false;
  boundary.visit_plain_faces([&](int f) {
    const WallFace<Dim>& face = boundary.faces[f];
    const double height = face.height(place);
    if (is_covered || height >= 0.0 || height < -reach || boundary.walls[face.wall].is_plate) return;
    if (std::abs(face.normal.dot(normal)) > max_cosine) return;
    const Vec<Dim> foot = place - height * face.normal;
    is_covered = (closest_point(face, foot) - foot).norm() < 1e-6 * reach;
  });
  return is_covered;
}

template <int Dim>
std::vector<AirPush<Dim>> pushes_of_air(const ProbeContext<Dim>& context, std::span<const WallPatch<Dim>> patches,
                                        std::span<const double> chosen) {
  std::vector<AirPush<Dim>> pushes;
  if (!context.air_pressure) return pushes;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const Vec<Dim> centre = patches[k].centre(context.boundary);
    const WallFace<Dim>& face = context.boundary.faces[patches[k].face];
    const double pressure = chosen[k] > 0.0 ? air_pressure_on(context, centre, face.normal) : 0.0;
    const double dx = context.spacing;
    if (pressure == 0.0 || is_covered<Dim>(context.boundary, face.normal, centre + 0.5 * dx * face.normal, 4.0 * dx)) {
      continue;
    }
    // On a plate itself, the water of both of its sides would count.
    const bool is_plate = context.boundary.walls[face.wall].is_plate;
    const Vec<Dim> place = is_plate ? Vec<Dim>(centre + beside_plate * dx * face.normal) : centre;
    pushes.push_back({face.wall, centre, place, -chosen[k] * patches[k].measure * pressure * face.normal});
  }
  std::vector<double> sums(2 * pushes.size());
  const std::vector<Vec<Dim>> shifts = image_shifts<Dim>(context.domain);
  for_each(pushes.size(), [&](std::size_t n) {
    WallPressureSums<Dim> here;
    for (const Vec<Dim>& shift : shifts) here.add_owned(context, pushes[n].place, shift);
    sums[2 * n] = here.water;
    sums[2 * n + 1] = here.wall;
  });
  context.ranks.sum_of_each(sums);
  for_each(pushes.size(), [&](std::size_t n) {
    pushes[n].force *= 1.0 - std::min(1.0, water_share<Dim>(sums[2 * n], sums[2 * n + 1]));
  });
  return pushes;
}

template <int Dim>
Reading<Dim> wall_pressure_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const Vec<Dim> centre = to_vec<Dim>(probe.at, label(probe), "at");
  if (probe.diameter > 0.0) return mean_over(places_on_disc(probe, centre, spec, boundary), probe, spec, boundary);
  const PointOnWall<Dim> point = point_on_wall(probe, centre, spec, boundary);
  return with_impulse<Dim>({columns_of(probe, Dim),
                            [point](const ProbeContext<Dim>& context) -> std::vector<Row> {
                              return {{wall_pressure(context, point.at(context.time)).value}};
                            },
                            [point](double time) { return region_of<Dim>({point}, time); }});
}

template <int Dim>
Reading<Dim> wall_pressure_mean_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  return mean_over(places_on_strip(probe, spec, boundary), probe, spec, boundary);
}

template struct WallPressureSums<2>;
template struct WallPressureSums<3>;
TAILWATER_IN_2D_AND_3D(pushes_of_air);
template PressureOnWall wall_pressure<2>(const ProbeContext<2>&, const Vec<2>&);
template PressureOnWall wall_pressure<3>(const ProbeContext<3>&, const Vec<3>&);
template PressureOnWall wall_pressure<2>(const ProbeContext<2>&, const Vec<2>&, const Vec<2>&,
                                         const WallPressureSums<2>&);
template PressureOnWall wall_pressure<3>(const ProbeContext<3>&, const Vec<3>&, const Vec<3>&,
                                         const WallPressureSums<3>&);
TAILWATER_IN_2D_AND_3D(wall_pressure_reading);
TAILWATER_IN_2D_AND_3D(wall_pressure_mean_reading);

}  // namespace tailwater
