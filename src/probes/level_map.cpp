#include "probes/level_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "base/for_each.h"
#include "io/csv_writer.h"
#include "io/vtp_writer.h"
#include "probes/places.h"
#include "probes/water_column.h"

namespace tailwater {
namespace {

/// The values of a line; a checkpoint saves these numbers.
enum LevelValue { largest, time_of_largest, integral, last, values_per_line };
constexpr std::size_t values_before_lines = 2;  // the time of the last reading, and the time that all cover

template <int Dim>
struct LevelMap {
  Vec<Dim> up;
  std::array<double, Dim - 1> piece;  ///< m; in x (and y)
  std::vector<Vec<Dim>> places;
  std::vector<UprightGauge<Dim>> lines;
  std::shared_ptr<std::vector<double>> memory;

  LevelMap(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary)
      : up(upwards<Dim>(probe, spec)) {
    const Vec<Dim> from = to_vec<Dim>(probe.from, label(probe), "from");
    const Vec<Dim> to = to_vec<Dim>(probe.to, label(probe), "to");
    const double step = step_of(probe, spec.particles.spacing);
    std::array<int, Dim - 1> count;
    double places_asked_for = 1.0;
    for (int d = 0; d < Dim - 1; ++d) {
      if (from[d] == to[d]) {
        throw CaseError("level-map-without-extent",
                        {"{}: from and to have the same {}, so the map has no extent", label(probe), "xy"[d]},
                        {"give two corners"});
      }
      places_asked_for *= std::max(1.0, std::abs(to[d] - from[d]) / step);
      require_few_places(probe, places_asked_for);
      count[d] = pieces_of_at_most(step, std::abs(to[d] - from[d]));
      piece[d] = (to[d] - from[d]) / count[d];
    }
    for (int j = 0; j < (Dim == 3 ? count.back() : 1); ++j) {
      for (int i = 0; i < count[0]; ++i) {
        Vec<Dim> place = from;
        place[0] += (i + 0.5) * piece[0];
        if (Dim == 3) place[1] += (j + 0.5) * piece.back();
        places.push_back(place);
        lines.emplace_back(probe, place, spec, boundary);
      }
    }
    memory = std::make_shared<std::vector<double>>(values_before_lines + values_per_line * lines.size(), 0.0);
    for (std::size_t k = 0; k < lines.size(); ++k) of(k, largest) = of(k, last) = bed(k);
  }

  double& time_of_last_reading() const { return (*memory)[0]; }
  double& duration() const { return (*memory)[1]; }
  double& of(std::size_t k, LevelValue value) const {
    return (*memory)[values_before_lines + values_per_line * k + value];
  }
  double mean(std::size_t k) const { return duration() > 0.0 ? of(k, integral) / duration() : of(k, last); }

  double bed(std::size_t k) const { return lines[k].highest_bed(); }

  template <class Of>
  double mean_over_places(Of&& level) const {
    return sum_over(lines.size(), 0.0, level) / static_cast<double>(lines.size());
  }

  Row read(const ProbeContext<Dim>& context) const {
    const WaterColumns<Dim> columns(context);
    const double since_last = context.time - time_of_last_reading();
    time_of_last_reading() = context.time;
    duration() += since_last;
    for_each(lines.size(), [&](std::size_t k) {
      const WaterColumn column = columns.on(lines[k].now(context));
      const double level = column.bed + column.connected;
      of(k, last) = level;
      of(k, integral) += since_last * level;
      if (level <= of(k, largest)) return;
      of(k, largest) = level;
      of(k, time_of_largest) = context.time;
    });
    const auto level = [&](std::size_t k) { return of(k, last); };
    return {largest_over(lines.size(), level(0), level), mean_over_places(level)};
  }

  void write(const std::filesystem::path& path, double time) const {
    if constexpr (Dim == 2) {
      CsvWriter csv(std::filesystem::path(path).replace_extension(".map.csv"),
                    {"x_m", "bed_m", "largest_m", "time_of_largest_s", "mean_m", "last_m"});
      for (std::size_t k = 0; k < lines.size(); ++k) {
        csv.write(Row{places[k][0], bed(k), of(k, largest), of(k, time_of_largest), mean(k), of(k, last)});
      }
    } else {
      write_vtp(path, time, encode_piece(FieldsOfPlan(*this).view()));
    }
  }

  /// Two triangles for each piece of the plan.
  struct FieldsOfPlan {
    std::vector<Vec<Dim>> corners;
    std::array<std::vector<double>, 5> values;

    explicit FieldsOfPlan(const LevelMap& map) {
      constexpr std::array<std::array<double, 2>, 6> shifts{
          {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
      for (std::size_t k = 0; k < map.lines.size(); ++k) {
        for (const auto& shift : shifts) {
          Vec<Dim> corner = map.places[k];
          for (int d = 0; d < Dim - 1; ++d) corner[d] += shift[d] * map.piece[d];
          corners.push_back(corner + (map.of(k, largest) - corner.dot(map.up)) * map.up);
          const std::array<double, 5> here{map.of(k, largest), map.of(k, time_of_largest), map.mean(k), map.of(k, last),
                                           map.bed(k)};
          for (std::size_t v = 0; v < here.size(); ++v) values[v].push_back(here[v]);
        }
      }
    }

    ParticleFields<Dim> view() const {
      return {.position = corners,
              .fields = {{"largest_level", values[0]},
                         {"time_of_largest", values[1]},
                         {"mean_level", values[2]},
                         {"last_level", values[3]},
                         {"bed", values[4]}},
              .corners = 3};
    }
  };

  std::vector<double> totals() const {
    // Levels that differ by rounding alone count as equal, so the place does not depend on the number of ranks.
    const double rounding = 1e-9 * std::abs(piece[0]);
    const double top = largest_over(lines.size(), of(0, largest), [&](std::size_t k) { return of(k, largest); });
    std::size_t highest = 0;
    while (of(highest, largest) < top - rounding) ++highest;
    std::vector<double> totals{top, of(highest, time_of_largest)};
    totals.insert(totals.end(), places[highest].begin(), places[highest].begin() + (Dim - 1));
    totals.push_back(mean_over_places([&](std::size_t k) { return mean(k); }));
    totals.push_back(mean_over_places([&](std::size_t k) { return of(k, last); }));
    return totals;
  }
};

}  // namespace

template <int Dim>
Reading<Dim> level_map_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const auto map = std::make_shared<const LevelMap<Dim>>(probe, spec, boundary);
  Reading<Dim> reading;
  reading.columns = columns_of(probe, Dim);
  reading.take = [map](const ProbeContext<Dim>& context) -> std::vector<Row> { return {map->read(context)}; };
  reading.region = [map](double time) { return region_of(map->lines, time); };
  reading.memory = map->memory;
  reading.totals = [map] { return map->totals(); };
  reading.write_map = [map](const std::filesystem::path& path, double time) { map->write(path, time); };
  return reading;
}

TAILWATER_IN_2D_AND_3D(level_map_reading);

}  // namespace tailwater
