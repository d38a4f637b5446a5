#include "case/probe_columns.h"

#include <algorithm>
#include <array>
#include <span>

namespace tailwater {
namespace {

/// How names of columns end.
std::span<const std::string_view> endings_of(Measure measure) {
  static constexpr std::array<std::string_view, 1> lengths{"m"};
  static constexpr std::array<std::string_view, 1> angles{"rad"};
  static constexpr std::array<std::string_view, 2> speeds{"m_s", "m_per_s"};
  static constexpr std::array<std::string_view, 1> discharges{"m3_per_s"};
  static constexpr std::array<std::string_view, 1> volumes{"m3"};
  static constexpr std::array<std::string_view, 1> pressures{"Pa"};
  static constexpr std::array<std::string_view, 2> forces{"N", "N_per_m"};
  static constexpr std::array<std::string_view, 2> moments{"N_m", "N_m_per_m"};
  static constexpr std::array<std::string_view, 1> energies{"J"};
  switch (measure) {
    case Measure::length:
      return lengths;
    case Measure::angle:
      return angles;
    case Measure::speed:
      return speeds;
    case Measure::discharge:
      return discharges;
    case Measure::volume:
      return volumes;
    case Measure::pressure:
      return pressures;
    case Measure::force:
      return forces;
    case Measure::moment:
      return moments;
    case Measure::energy:
      break;
  }
  return energies;
}

constexpr std::array<SeriesColumn, 7> forces{{{"force_x", Measure::force},
                                              {"force_y", Measure::force},
                                              {"force_z", Measure::force},
                                              {"moment", Measure::moment},
                                              {"moment_x", Measure::moment},
                                              {"moment_y", Measure::moment},
                                              {"moment_z", Measure::moment}}};
constexpr std::array<SeriesColumn, 10> motions{{{"displacement_x"},
                                                {"displacement_y"},
                                                {"displacement_z"},
                                                {"angle", Measure::angle},
                                                {"angle_x", Measure::angle},
                                                {"angle_y", Measure::angle},
                                                {"angle_z", Measure::angle},
                                                {"velocity_x", Measure::speed},
                                                {"velocity_y", Measure::speed},
                                                {"velocity_z", Measure::speed}}};

/// Of both dimensions.
std::span<const SeriesColumn> all_columns_of(ProbeType type) {
  static constexpr std::array<SeriesColumn, 3> depths{{{"connected"}, {"highest"}, {"wet"}}};
  static constexpr std::array<SeriesColumn, 1> pressures{{{"pressure", Measure::pressure}}};
  static constexpr std::array<SeriesColumn, 2> fronts{{{"front_connected"}, {"front"}}};
  static constexpr std::array<SeriesColumn, 3> velocities{
      {{"u", Measure::speed}, {"v", Measure::speed}, {"w", Measure::speed}}};
  static constexpr std::array<SeriesColumn, 3> energies{
      {{"total", Measure::energy}, {"kinetic", Measure::energy}, {"potential", Measure::energy}}};
  static constexpr std::array<SeriesColumn, 2> volumes{
      {{"volume_out", Measure::volume}, {"volume_in", Measure::volume}}};
  static constexpr std::array<SeriesColumn, 2> discharges{
      {{"discharge", Measure::discharge}, {"volume", Measure::volume}}};
  static constexpr std::array<SeriesColumn, 2> maps{{{"largest", Measure::pressure}, {"mean", Measure::pressure}}};
  static constexpr std::array<SeriesColumn, 2> run_ups{{{"connected"}, {"highest"}}};
  static constexpr std::array<SeriesColumn, 2> levels{{{"mean"}, {"highest"}}};
  switch (type) {
    case ProbeType::depth:
      return depths;
    case ProbeType::wall_pressure:
    case ProbeType::wall_pressure_mean:
    case ProbeType::pressure:
      return pressures;
    case ProbeType::front:
      return fronts;
    case ProbeType::velocity:
      return velocities;
    case ProbeType::energy:
      return energies;
    case ProbeType::volume:
      return volumes;
    case ProbeType::discharge:
      return discharges;
    case ProbeType::force:
      return forces;
    case ProbeType::pressure_map:
      return maps;
    case ProbeType::motion:
      return motions;
    case ProbeType::run_up:
      return run_ups;
    case ProbeType::level_map:
      return levels;
    case ProbeType::profile:
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

std::vector<SeriesColumn> columns_of(ProbeType type, int dimension) {
  std::vector<SeriesColumn> columns;
  for (const SeriesColumn& column : all_columns_of(type)) {
    if (is_of_dimension(column.name, dimension)) columns.push_back(column);
  }
  return columns;
}

bool is_heading_of(const SeriesColumn& column, std::string_view heading) {
  if (!heading.starts_with(column.name)) return false;
  heading.remove_prefix(column.name.size());
  if (!heading.starts_with('_')) return false;
  return std::ranges::find(endings_of(column.measure), heading.substr(1)) != endings_of(column.measure).end();
}

}  // namespace tailwater
