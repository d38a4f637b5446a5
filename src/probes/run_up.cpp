#include "probes/run_up.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "probes/chosen_walls.h"
#include "probes/front.h"
#include "probes/places.h"
#include "probes/water_column.h"

namespace tailwater {
namespace {

constexpr double wetting_distance = 1.0;  // dx; a row of particles on a wall is half of that away
constexpr double height_of_bin = 2.0;     // dx
/// Particles in the support around one of a film that is connected with the water below; splashes have fewer.
template <int Dim>
constexpr int neighbours_of_film = Dim + 3;

template <int Dim>
struct RunUp {
  Vec<Dim> up;
  ChosenWalls<Dim> walls;
  std::shared_ptr<std::vector<double>> memory = std::make_shared<std::vector<double>>(3);
  double& largest() const { return (*memory)[0]; }          ///< m; of connected water
  double& time_of_largest() const { return (*memory)[1]; }  ///< s
  double& highest() const { return (*memory)[2]; }          ///< m; of all water

  RunUp(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary)
      : up(upwards<Dim>(probe, spec)), walls(probe, spec, boundary) {
    // Called only for its errors: there must be a wall somewhere.
    chosen_shares<Dim>(probe, spec, boundary, make_wall_patches(boundary, longest_patch_edge * spec.particles.spacing));
    largest() = highest() = range(boundary).low;
  }

  struct Heights {
    double low = std::numeric_limits<double>::max();
    double high = -std::numeric_limits<double>::max();
  };

  /// The range of heights of the walls at their present places.
  Heights range(const Boundary<Dim>& boundary) const {
    Heights heights;
    for (const WallFace<Dim>& face : boundary.faces) {
      if (!walls.is_named(face.wall)) continue;
      for (const Vec<Dim>& corner : face.corners) {
        heights.low = std::min(heights.low, corner.dot(up));
        heights.high = std::max(heights.high, corner.dot(up));
      }
    }
    return heights;
  }

  /// The height up to which particle `i` wets the walls; below all walls if it does not.
  double reach(const ProbeContext<Dim>& context, std::size_t i) const {
    constexpr double nowhere = -std::numeric_limits<double>::max();
    const Particles<Dim>& particles = context.particles;
    if (!particles.is_fluid(i)) return nowhere;
    const auto foot = context.boundary.nearest(particles.position[i], wetting_distance * context.spacing);
    if (foot.face < 0 || !walls.contains(context.boundary.faces[foot.face].wall, foot.point)) return nowhere;
    const double across = context.boundary.faces[foot.face].normal.dot(up);
    return foot.point.dot(up) + 0.5 * context.spacing_at(foot.point) * std::sqrt(std::max(0.0, 1.0 - across * across));
  }

  /// Collective.
  Row read(const ProbeContext<Dim>& context) const {
    const Heights heights = range(context.boundary);
    const double bin = height_of_bin * context.spacing;
    // The highest reach in each bin, with its sign changed, because the ranks are reduced by their minimum.
    std::vector<double> connected(static_cast<std::size_t>((heights.high - heights.low) / bin) + 2, -heights.low);
    double highest_now = heights.low;
    for (std::size_t i = 0; i < context.particles.owned; ++i) {  // in order: many particles mark one bin
      const double height = reach(context, i);
      if (height <= heights.low) continue;
      highest_now = std::max(highest_now, height);
      const auto k = std::min(static_cast<std::size_t>((height - heights.low) / bin), connected.size() - 1);
      if (-height < connected[k] && is_connected(context, static_cast<std::int32_t>(i), neighbours_of_film<Dim>)) {
        connected[k] = -height;
      }
    }
    context.ranks.min_of_each(connected);
    highest_now = context.ranks.largest(highest_now);
    const auto is_wet = [&](double reach) { return reach < -heights.low; };
    const auto first = std::ranges::find_if(connected, is_wet);
    const auto gap = std::find_if_not(first, connected.end(), is_wet);
    const double now = first == connected.end() ? heights.low : -*std::prev(gap);
    if (now > largest()) {
      largest() = now;
      time_of_largest() = context.time;
    }
    highest() = std::max(highest(), highest_now);
    return {now, highest_now};
  }
};

}  // namespace

template <int Dim>
Reading<Dim> run_up_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const auto run_up = std::make_shared<const RunUp<Dim>>(probe, spec, boundary);
  Reading<Dim> reading;
  reading.columns = columns_of(probe, Dim);
  reading.take = [run_up](const ProbeContext<Dim>& context) -> std::vector<Row> { return {run_up->read(context)}; };
  reading.memory = run_up->memory;
  reading.totals = [run_up]() -> std::vector<double> {
    return {run_up->largest(), run_up->time_of_largest(), run_up->highest()};
  };
  return reading;
}

TAILWATER_IN_2D_AND_3D(run_up_reading);

}  // namespace tailwater
