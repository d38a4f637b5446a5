#include "probes/wall_pressure.h"

#include <memory>

#include "geometry/wall_motion.h"
#include "probes/places.h"
#include "probes/water_share.h"

namespace tailwater {
namespace {

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
  const double support = spec.scheme.support * spec.particles.spacing;
  const NearestWall<Dim> nearest = boundary.nearest(x, support);
  if (nearest.face < 0) {
    throw InputError(fmt::format("{}: no wall within {:.4g} m (the kernel's support) of {}: move it onto a wall",
                                 label(probe), support, place(x)));
  }
  const int wall = boundary.faces[nearest.face].wall;
  Vec<Dim> point = nearest.point;
  if (boundary.walls[wall].is_plate) {
    const double tolerance = corner_tolerance * spec.particles.spacing;
    if (nearest.signed_distance <= tolerance) {
      throw InputError(
          fmt::format("{}: {} is on {}, a plate that has water on both sides: move it by a millimetre to "
                      "the side that is meant",
                      label(probe), place(x), wall_label(boundary, wall)));
    }
    point += tolerance * boundary.faces[nearest.face].normal;
  }
  if (!boundary.walls[wall].moves()) return {point, nullptr};
  const Drive& drive = spec.walls[wall].drive;
  if (drive.by == Drive::By::wave_maker && spec.wave_makers[drive.index].absorption == Absorption::active) {
    throw InputError(
        fmt::format("{}: {} gives way to waves, and a probe cannot follow it: move the probe, or give "
                    "absorption = \"none\"",
                    label(probe), wall_label(boundary, wall)));
  }
  if (drive.by == Drive::By::body) {
    throw InputError(
        fmt::format("{}: {} is of body '{}', which the water moves, and a probe cannot follow it: move the probe, or "
                    "take type = \"force\" with a region",
                    label(probe), wall_label(boundary, wall), spec.bodies[drive.index].name));
  }
  return {point, std::make_shared<WallPath<Dim>>(spec, spec.walls[wall], wall_label(boundary, wall))};
}

/// The region around the points, which need not lie on one line.
template <int Dim>
Region<Dim> region_of(const std::vector<PointOnWall<Dim>>& points, double time) {
  Region<Dim> region{points.front().at(time), points.back().at(time)};
  for (const PointOnWall<Dim>& point : points) {
    region.margin = std::max(region.margin, region.distance(point.at(time)));
  }
  return region;
}

}  // namespace

template <int Dim>
void WallPressureSums<Dim>::add(const ProbeContext<Dim>& context, const Vec<Dim>& x_w, std::int32_t j,
                                const Vec<Dim>& x_j, double weight) {
  if (!context.particles.is_fluid(j)) {
    wall += weight;
    return;
  }
  const double p_j = context.particles.pressure[j];
  least = std::min(least, p_j);
  pressure += weight * (p_j + context.density * context.gravity.dot(x_w - x_j));
  water += weight;
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
  return std::max(pressure / water, least);
}

template <int Dim>
std::optional<double> wall_pressure(const ProbeContext<Dim>& context, const Vec<Dim>& x_w) {
  WallPressureSums<Dim> sums;
  for_each_weight(context, x_w, [&](std::int32_t j, double weight) {
    sums.add(context, x_w, j, context.particles.position[j], weight);
  });
  return sums.value();
}

template <int Dim>
Reading<Dim> wall_pressure_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const PointOnWall<Dim> point = point_on_wall(probe, to_vec<Dim>(probe.at, label(probe), "at"), spec, boundary);
  return {{"pressure_Pa"},
          [point](const ProbeContext<Dim>& context) -> std::vector<Row> {
            return {{wall_pressure(context, point.at(context.time)).value_or(0.0)}};
          },
          [point](double time) { return region_of<Dim>({point}, time); }};
}

template <int Dim>
Reading<Dim> wall_pressure_mean_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  std::vector<PointOnWall<Dim>> points;
  for (const Vec<Dim>& x : places_between<Dim>(probe, 0.5 * spec.particles.spacing)) {
    points.push_back(point_on_wall(probe, x, spec, boundary));
  }
  return {{"pressure_Pa", "wet_share"},
          [points](const ProbeContext<Dim>& context) -> std::vector<Row> {
            double sum = 0.0;
            double wet = 0.0;
            for (const PointOnWall<Dim>& point : points) {
              if (const std::optional<double> pressure = wall_pressure(context, point.at(context.time))) {
                sum += *pressure;
                wet += 1.0;
              }
            }
            const double count = static_cast<double>(points.size());
            return {{sum / count, wet / count}};
          },
          [points](double time) { return region_of(points, time); }};
}

template struct WallPressureSums<2>;
template struct WallPressureSums<3>;
template std::optional<double> wall_pressure<2>(const ProbeContext<2>&, const Vec<2>&);
template std::optional<double> wall_pressure<3>(const ProbeContext<3>&, const Vec<3>&);
template Reading<2> wall_pressure_reading<2>(const ProbeTable&, const CaseSpec&, const Boundary<2>&);
template Reading<3> wall_pressure_reading<3>(const ProbeTable&, const CaseSpec&, const Boundary<3>&);
template Reading<2> wall_pressure_mean_reading<2>(const ProbeTable&, const CaseSpec&, const Boundary<2>&);
template Reading<3> wall_pressure_mean_reading<3>(const ProbeTable&, const CaseSpec&, const Boundary<3>&);

}  // namespace tailwater
