#include "case/probe_columns.h"

#include <algorithm>
#include <array>
#include <span>

#include "base/assert.h"

namespace tailwater {
namespace {

/// How names of columns end, and the unit that it says.
struct Ending {
  std::string_view text;
  const char* unit;
  const char* unit_2d;
};

// Longer ones before those that they end with.
constexpr std::array endings{
    Ending{"_m3_per_s", "m^3/s", "m^3/s per m"},
    Ending{"_N_m_per_m", "N m/m", "N m/m"},
    Ending{"_N_per_m", "N/m", "N/m"},
    Ending{"_N_m", "N m", "N m"},
    Ending{"_m_per_s", "m/s", "m/s"},
    Ending{"_Pa_s", "Pa s", "Pa s"},
    Ending{"_m_s", "m/s", "m/s"},
    Ending{"_m3", "m^3", "m^3 per m"},
    Ending{"_rad", "rad", "rad"},
    Ending{"_Pa", "Pa", "Pa"},
    Ending{"_J", "J", "J per m"},
    Ending{"_N", "N", "N"},
    Ending{"_m", "m", "m"},
};

const Ending* ending_of(std::string_view column) {
  const auto* found = std::ranges::find_if(endings, [&](const Ending& one) { return column.ends_with(one.text); });
  return found == endings.end() ? nullptr : found;
}

/// Of both dimensions.
std::vector<SeriesColumn> all_columns_of(ProbeType type) {
  switch (type) {
    case ProbeType::depth:
      return {{"connected"}, {"highest"}, {"wet"}};
    case ProbeType::wall_pressure:
    case ProbeType::wall_pressure_mean:
    case ProbeType::pressure:
      return {{"pressure", Measure::pressure}};
    case ProbeType::front:
      return {{"front_connected"}, {"front"}};
    case ProbeType::velocity:
      return {{"u", Measure::speed}, {"v", Measure::speed}, {"w", Measure::speed}};
    case ProbeType::energy:
      return {{"total", Measure::energy}, {"kinetic", Measure::energy}, {"potential", Measure::energy}};
    case ProbeType::volume:
      return {{"volume_out", Measure::volume}, {"volume_in", Measure::volume}};
    case ProbeType::discharge:
      return {{"discharge", Measure::discharge}, {"volume", Measure::volume}};
    case ProbeType::force:
      return {{"force_x", Measure::force},  {"force_y", Measure::force},   {"force_z", Measure::force},
              {"moment", Measure::moment},  {"moment_x", Measure::moment}, {"moment_y", Measure::moment},
              {"moment_z", Measure::moment}};
    case ProbeType::pressure_map:
      return {{"largest", Measure::pressure}, {"mean", Measure::pressure}};
    case ProbeType::motion:
      return {{"displacement_x"},
              {"displacement_y"},
              {"displacement_z"},
              {"angle", Measure::angle},
              {"angle_x", Measure::angle},
              {"angle_y", Measure::angle},
              {"angle_z", Measure::angle},
              {"velocity_x", Measure::speed},
              {"velocity_y", Measure::speed},
              {"velocity_z", Measure::speed}};
    case ProbeType::run_up:
      return {{"connected"}, {"highest"}};
    case ProbeType::level_map:
      return {{"mean"}, {"highest"}};
    case ProbeType::pockets:
      return {{"pressure", Measure::pressure},
              {"volume", Measure::volume},
              {"gas", Measure::volume},
              {"vented", Measure::volume},
              {"energy", Measure::energy}};
    case ProbeType::profile:
      return {{"connected"}, {"highest"}};
    case ProbeType::velocity_profile:
      break;
  }
  return {};
}

bool is_of_dimension(std::string_view name, int dimension) {
  constexpr std::array<std::string_view, 2> only_2d{"angle", "moment"};
  constexpr std::array<std::string_view, 5> only_3d{"w", "angle_x", "angle_y", "moment_x", "moment_y"};
  if (dimension == 3) return std::ranges::find(only_2d, name) == only_2d.end();
  return std::ranges::find(only_3d, name) == only_3d.end() && !name.ends_with("_z");
}

}  // namespace

std::vector<SeriesColumn> columns_of(const ProbeTable& probe, int dimension) {
  std::vector<SeriesColumn> columns;
  if (probe.type == ProbeType::profile && dimension == 3) return columns;
  for (const SeriesColumn& column : all_columns_of(probe.type)) {
    const bool is_written = column.measure != Measure::moment || !probe.moment_about.empty();
    if (is_written && is_of_dimension(column.name, dimension)) columns.push_back(column);
  }
  return columns;
}

Compared compared_with(const MeasurementTable& measurement, const CaseSpec& spec) {
  const auto probe = std::ranges::find(spec.probes, measurement.probe, &ProbeTable::name);
  TAILWATER_ASSERT(probe != spec.probes.end(), "a measurement has a probe");
  const std::vector<SeriesColumn> columns = columns_of(*probe, spec.general.dimension);
  const auto column = std::ranges::find(columns, measurement.column, &SeriesColumn::name);
  TAILWATER_ASSERT(column != columns.end(), "a measurement has a column of its probe");
  return {static_cast<std::size_t>(probe - spec.probes.begin()), *column};
}

bool is_heading_of(const SeriesColumn& column, std::string_view heading) {
  const auto* ending = ending_of(heading);
  return ending != nullptr && heading.substr(0, heading.size() - ending->text.size()) == column.name;
}

std::string unit_of_column(std::string_view column, int dimension) {
  const auto* ending = ending_of(column);
  return ending == nullptr ? "" : dimension == 2 ? ending->unit_2d : ending->unit;
}

}  // namespace tailwater
