#include "case/probe_columns.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "base/assert.h"

namespace tailwater {
namespace {

/// Units in texts and at the end of headings.
struct Units {
  const char* in_3d;
  const char* in_2d;
  const char* ending_in_3d;
  const char* ending_in_2d;
};

// In the order of Measure.
constexpr std::array units_by_measure{
    Units{"m", "m", "_m", "_m"},
    Units{"rad", "rad", "_rad", "_rad"},
    Units{"m/s", "m/s", "_m_per_s", "_m_per_s"},
    Units{"m^3/s", "m^3/s per m", "_m3_per_s", "_m3_per_s"},
    Units{"m^3", "m^3 per m", "_m3", "_m3"},
    Units{"Pa", "Pa", "_Pa", "_Pa"},
    Units{"N", "N/m", "_N", "_N_per_m"},
    Units{"N m", "N m/m", "_N_m", "_N_m_per_m"},
    Units{"J", "J per m", "_J", "_J"},
    Units{"", "", "", ""},
    Units{"s", "s", "_s", "_s"},
    Units{"rad/s", "rad/s", "_rad_per_s", "_rad_per_s"},
    Units{"Pa s", "Pa s", "_Pa_s", "_Pa_s"},
    Units{"W", "W/m", "_W", "_W_per_m"},
    Units{"1/s", "1/s", "_per_s", "_per_s"},
};

std::vector<std::string> names_of(const DeclaredColumn& column, int dimension) {
  const std::string name(column.name);
  const bool is_turn = column.parts == Parts::turn || column.parts == Parts::turn_range;
  if (column.parts == Parts::one || (is_turn && dimension == 2)) return {name};
  if (column.parts == Parts::one_in_3d && dimension == 2) return {};
  if (column.parts == Parts::one_in_3d) return {name};
  std::vector<std::string> names;
  for (int d = 0; d < dimension; ++d) {
    names.push_back(column.parts == Parts::velocity ? name + "uvw"[d] : name + '_' + "xyz"[d]);
  }
  return names;
}

std::string ending_of(const DeclaredColumn& column, int dimension) {
  if (column.parts == Parts::velocity) return "_m_s";
  const Units& of_measure = units_by_measure[static_cast<std::size_t>(column.measure)];
  return dimension == 2 ? of_measure.ending_in_2d : of_measure.ending_in_3d;
}

}  // namespace

Measure measure_of(Statistic statistic, Measure of_column) {
  if (statistic == Statistic::rise) return Measure::time;
  if (statistic != Statistic::rate && statistic != Statistic::max_rate) return of_column;
  TAILWATER_ASSERT(of_column == Measure::impulse || of_column == Measure::volume, "rates have a unit of their own");
  return of_column == Measure::impulse ? Measure::pressure : Measure::discharge;
}

std::string_view unit_of(Measure measure, int dimension) {
  const Units& of_measure = units_by_measure[static_cast<std::size_t>(measure)];
  return dimension == 2 ? of_measure.in_2d : of_measure.in_3d;
}

std::vector<OutputColumn> columns_in(int dimension, const DeclaredColumn& declared) {
  const bool is_range = declared.parts == Parts::vector_range || declared.parts == Parts::turn_range;
  std::vector<OutputColumn> columns;
  const auto add = [&](const std::string& name) {
    columns.push_back({name, name + ending_of(declared, dimension), declared.measure, declared.comparison});
  };
  for (const std::string& name : names_of(declared, dimension)) {
    add(is_range ? "least_" + name : name);
    if (is_range) add("largest_" + name);
  }
  return columns;
}

std::vector<OutputColumn> columns_of(const ProbeTable& probe, int dimension, bool walls_move) {
  std::vector<OutputColumn> columns;
  for (const DeclaredColumn& declared : info_of(probe.type).columns) {
    const bool is_absent = (declared.need == Need::diameter && probe.diameter == 0.0) ||
                           (declared.need == Need::liquid && probe.liquid.empty()) ||
                           (declared.need == Need::moment_about && probe.moment_about.empty()) ||
                           (declared.need == Need::moving_walls && !walls_move);
    if (!is_absent) std::ranges::move(columns_in(dimension, declared), std::back_inserter(columns));
  }
  return columns;
}

std::vector<OutputColumn> totals_of(ProbeType type, int dimension) {
  std::vector<OutputColumn> totals;
  for (const DeclaredColumn& declared : info_of(type).totals) {
    std::ranges::move(columns_in(dimension, declared), std::back_inserter(totals));
  }
  return totals;
}

std::vector<OutputColumn> comparable_columns(const ProbeTable& probe, int dimension) {
  if (probe.type == ProbeType::profile && dimension == 3) return {};
  std::vector<OutputColumn> columns = columns_of(probe, dimension);
  std::erase_if(columns, [](const OutputColumn& column) { return column.comparison == Comparison::none; });
  std::stable_partition(columns.begin(), columns.end(),
                        [](const OutputColumn& column) { return column.comparison == Comparison::by_default; });
  return columns;
}

Compared compared_with(const MeasurementTable& measurement, const CaseSpec& spec) {
  const auto probe = std::ranges::find(spec.probes, measurement.probe, &ProbeTable::name);
  TAILWATER_ASSERT(probe != spec.probes.end(), "a measurement has a probe");
  const std::vector<OutputColumn> columns = comparable_columns(*probe, spec.general.dimension);
  const auto column = std::ranges::find(columns, measurement.column, &OutputColumn::name);
  TAILWATER_ASSERT(column != columns.end(), "a measurement has a column of its probe");
  return {static_cast<std::size_t>(probe - spec.probes.begin()), *column};
}

}  // namespace tailwater
