#include "probes/pressure_map.h"

#include <algorithm>
#include <memory>

#include "base/for_each.h"
#include "io/vtp_writer.h"
#include "probes/chosen_walls.h"
#include "probes/places.h"
#include "probes/wall_pressure.h"

namespace tailwater {
namespace {

template <int Dim>
struct PressureMap {
  std::vector<WallPatch<Dim>> patches;
  std::vector<Vec<Dim>> drawn_corners;  ///< one patch after the other
  std::vector<std::int64_t> wall;       ///< of each patch
  double area = 0.0;                    ///< m or m^2; of all patches

  double averaging_time_of_probe;  ///< s; as in the case

  // The saved state of a checkpoint: four numbers, then five for each patch.
  std::shared_ptr<std::vector<double>> memory;
  double& last_time() const { return (*memory)[0]; }  // s
  double& duration() const { return (*memory)[1]; }   // s
  /// s; of the last half of a mean (0), and of the half before it (1)
  double& begin(std::size_t half) const { return (*memory)[2 + half]; }
  double& largest(std::size_t k) const { return (*memory)[4 + 5 * k]; }                          // Pa
  double& time_of_largest(std::size_t k) const { return (*memory)[5 + 5 * k]; }                  // s
  double& sum(std::size_t k) const { return (*memory)[6 + 5 * k]; }                              // Pa s
  double& sum_at_begin(std::size_t k, std::size_t s) const { return (*memory)[7 + 5 * k + s]; }  // Pa s
  double mean(std::size_t k) const { return duration() > 0.0 ? sum(k) / duration() : 0.0; }

  PressureMap(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary)
      : averaging_time_of_probe(probe.averaging_time) {
    const auto all = make_wall_patches(boundary, longest_patch_edge * spec.particles.spacing);
    const std::vector<double> shares = chosen_shares<Dim>(probe, spec, boundary, all);
    for (const std::size_t k : indices_where(all.size(), [&](std::size_t p) { return shares[p] > 0.0; })) {
      patches.push_back(all[k]);
      wall.push_back(boundary.faces[all[k].face].wall);
      area += all[k].measure;
      for (int c = 0; c < Dim; ++c) drawn_corners.push_back(all[k].corner(boundary, c));
    }
    memory = std::make_shared<std::vector<double>>(4 + 5 * patches.size(), 0.0);
  }

  /// Collective.
  Row read(const ProbeContext<Dim>& context) const {
    const std::vector<PressureOnWall> pressure = pressures(context);
    const double since_last = context.time - last_time();
    last_time() = context.time;
    duration() += since_last;
    double mean = 0.0;
    double wet = 0.0;
    for (std::size_t k = 0; k < patches.size(); ++k) {
      const double p = pressure[k].value;
      sum(k) += since_last * p;
      mean += patches[k].measure / area * p;
      if (pressure[k].is_wet) wet += patches[k].measure / area;
    }
    update_largest(context.time,
                   averaging_time(averaging_time_of_probe, context.spacing, context.speed, context.gravity.norm()),
                   pressure);
    const std::size_t highest = first_of_highest([&](std::size_t k) { return pressure[k].value; });
    Row row{pressure[highest].value};
    const Vec<Dim> place = patches[highest].centre(context.boundary);
    row.insert(row.end(), place.begin(), place.end());
    row.insert(row.end(), {mean, wet});
    return row;
  }

  /// Means are over the last two halves of a time of `over` [s], or between two readings that are farther apart. With 0
  /// the largest pressure is that of a reading.
  void update_largest(double time, double over, const std::vector<PressureOnWall>& pressure) const {
    constexpr double rounding = 1e-9;
    const auto update = [&](std::size_t k, double p) {
      if (p <= largest(k)) return;
      largest(k) = p;
      time_of_largest(k) = time;
    };
    if (duration() == 0.0) begin(0) = begin(1) = time;
    if (over == 0.0) {
      for (std::size_t k = 0; k < patches.size(); ++k) update(k, pressure[k].value);
      return;
    }
    const double whole = (1.0 - rounding) * over;
    if (time - begin(0) < 0.5 * whole) return;
    const std::size_t first = time - begin(0) >= whole ? 0 : 1;
    const double length = time - begin(first);
    for (std::size_t k = 0; k < patches.size(); ++k) {
      if (length >= whole) update(k, (sum(k) - sum_at_begin(k, first)) / length);
      sum_at_begin(k, 1) = sum_at_begin(k, 0);
      sum_at_begin(k, 0) = sum(k);
    }
    begin(1) = begin(0);
    begin(0) = time;
  }

  /// The largest mean [Pa]; the mean so far until there is one.
  double largest_mean(std::size_t k) const {
    return time_of_largest(k) > 0.0 ? largest(k) : std::max(largest(k), mean(k));
  }

  /// The first patch of those with the highest pressure. Pressures that differ by rounding alone, as those along a
  /// level bed, count as equal, so the place does not depend on the number of ranks.
  template <class Of>
  std::size_t first_of_highest(Of&& of) const {
    constexpr double rounding = 1e-9;
    double highest = of(0);
    for (std::size_t k = 1; k < patches.size(); ++k) highest = std::max(highest, of(k));
    std::size_t first = 0;
    while (of(first) < highest - rounding * std::abs(highest)) ++first;
    return first;
  }

  std::vector<PressureOnWall> pressures(const ProbeContext<Dim>& context) const {
    std::vector<WallPressureSums<Dim>> sums(patches.size());
    std::vector<double> least(patches.size());
    const std::vector<Vec<Dim>> shifts = image_shifts<Dim>(context.domain);
    for_each(patches.size(), [&](std::size_t k) {
      const WallFace<Dim>& face = context.boundary.faces[patches[k].face];
      const Vec<Dim> place = in_front_of<Dim>(context.boundary, face.wall, face.normal,
                                              patches[k].centre(context.boundary), context.spacing);
      for (const Vec<Dim>& shift : shifts) sums[k].add_owned(context, place, shift);
      least[k] = sums[k].least;
    });
    const bool has_inertia = context.wall_inertia != nullptr;
    std::vector<double> entries;
    for (auto& here : sums) here.for_each_sum(has_inertia, [&](double entry) { entries.push_back(entry); });
    context.ranks.sum_of_each(entries);
    context.ranks.min_of_each(least);
    std::size_t next = 0;
    for (auto& here : sums) here.for_each_sum(has_inertia, [&](double& entry) { entry = entries[next++]; });
    std::vector<PressureOnWall> pressure(patches.size());
    for_each(patches.size(), [&](std::size_t k) {
      sums[k].least = least[k];
      pressure[k] = wall_pressure<Dim>(context, patches[k].centre(context.boundary),
                                       context.boundary.faces[patches[k].face].normal, sums[k]);
    });
    return pressure;
  }

  /// Returns `of(k)` for each corner of each patch k.
  template <class Of>
  auto at_corners(Of&& of) const {
    std::vector<std::decay_t<decltype(of(0))>> values;
    for (std::size_t k = 0; k < patches.size(); ++k) values.insert(values.end(), Dim, of(k));
    return values;
  }

  void write(const std::filesystem::path& path, double time) const {
    const std::vector<double> largest_here = at_corners([&](std::size_t k) { return largest_mean(k); });
    const std::vector<double> times = at_corners([&](std::size_t k) { return time_of_largest(k); });
    const std::vector<double> means = at_corners([&](std::size_t k) { return mean(k); });
    const std::vector<std::int64_t> walls = at_corners([&](std::size_t k) { return wall[k]; });
    const ParticleFields<Dim> fields{.position = drawn_corners,
                                     .fields = {{"largest_pressure", largest_here},
                                                {"time_of_largest", times},
                                                {"mean_pressure", means},
                                                {"wall", walls}},
                                     .corners = Dim};
    write_vtp(path, time, encode_piece(fields));
  }

  std::vector<double> totals() const {
    const std::size_t highest = first_of_highest([&](std::size_t k) { return largest_mean(k); });
    Vec<Dim> place = Vec<Dim>::Zero();
    for (int c = 0; c < Dim; ++c) place += drawn_corners[Dim * highest + c] / Dim;
    double mean_over_area = 0.0;
    for (std::size_t k = 0; k < patches.size(); ++k) mean_over_area += patches[k].measure / area * mean(k);
    std::vector<double> totals{largest_mean(highest), time_of_largest(highest)};
    totals.insert(totals.end(), place.begin(), place.end());
    totals.push_back(mean_over_area);
    return totals;
  }
};

}  // namespace

template <int Dim>
Reading<Dim> pressure_map_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const auto map = std::make_shared<const PressureMap<Dim>>(probe, spec, boundary);
  Reading<Dim> reading;
  reading.columns = columns_of(probe, Dim);
  reading.take = [map](const ProbeContext<Dim>& context) -> std::vector<Row> { return {map->read(context)}; };
  reading.memory = map->memory;
  reading.totals = [map] { return map->totals(); };
  reading.write_map = [map](const std::filesystem::path& path, double time) { map->write(path, time); };
  return reading;
}

TAILWATER_IN_2D_AND_3D(pressure_map_reading);

}  // namespace tailwater
