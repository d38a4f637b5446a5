// The output of probes, declared once for each type in probe_types.cpp: the columns of its table, its totals in
// summary.json and its results. The headings of tables and their units, the quantities for comparison with
// measurements, the summary and docs/reference/probes.md follow from these declarations.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "case/spec.h"
#include "case_files/time_series.h"

namespace tailwater {

/// The numbers that one declaration represents.
enum class Parts {
  one,
  one_in_3d,
  vector,        ///< NAME_x, NAME_y and in 3D NAME_z
  turn,          ///< in 2D one number, in 3D NAME_x, NAME_y and NAME_z
  velocity,      ///< NAMEu, NAMEv and in 3D NAMEw
  vector_range,  ///< min_NAME_x, largest_NAME_x, and so on
  turn_range,
};

/// Whether a measurement can be compared with a column. One that names no column is compared with the default.
enum class Comparison { none, possible, by_default };

/// A column with a need is absent from the tables of probes that do not meet it.
enum class Need { nothing, diameter, liquid, moment_about, moving_walls };

struct DeclaredColumn {
  std::string_view name;
  Measure measure;
  std::string_view doc;
  Comparison comparison = Comparison::none;
  Parts parts = Parts::one;
  Need need = Need::nothing;
};

enum class Statistic {
  mean,
  max,
  max_magnitude,
  max_moving_mean,  ///< of a column that is a moving mean; at least the mean result before it
  last,
  range,
  rate,
  max_rate,  ///< of a column that adds up; a mean over ProbeTable::averaging_time, as is the next
  max_mean,
  rise,
  last_min,
  last_max
};

/// A number that a run prints at its end and writes to the block "results" of summary.json. It is left out in the
/// dimension in which its column does not exist.
struct DeclaredResult {
  std::string_view name;
  std::string_view label;   ///< in front of the number; empty for the main result
  std::string_view column;  ///< without its unit
  Statistic statistic;
};

struct ProbeInfo {
  ProbeType type;
  std::string_view doc;
  std::vector<DeclaredColumn> columns;  ///< of the table after the time, in its order
  std::vector<DeclaredResult> results;
  std::vector<DeclaredColumn> totals = {};  ///< of the whole run, in the block "probes" of summary.json
};

const ProbeInfo& info_of(ProbeType type);

/// A column in 2D or 3D.
struct OutputColumn {
  std::string name;     ///< "force_x"
  std::string heading;  ///< "force_x_N_per_m"
  Measure measure;
  Comparison comparison;
};

std::vector<OutputColumn> columns_in(int dimension, const DeclaredColumn& declared);

/// The columns of a probe's table after the time. `walls_move`: whether one of the probe's walls moves.
std::vector<OutputColumn> columns_of(const ProbeTable& probe, int dimension, bool walls_move = false);

/// The totals of a probe, in their order.
std::vector<OutputColumn> totals_of(ProbeType type, int dimension);

/// The columns that a measurement can be compared with, the default first.
std::vector<OutputColumn> comparable_columns(const ProbeTable& probe, int dimension);

struct Compared {
  std::size_t probe;  ///< index in the case
  OutputColumn column;
};
/// The probe and the column with which a measurement is compared, in a case that has been read.
Compared compared_with(const MeasurementTable& measurement, const CaseSpec& spec);

/// The quantity of a statistic of a column.
Measure measure_of(Statistic statistic, Measure of_column);

/// The SI unit, as "N/m" of a force in 2D, where forces, volumes and energies are per metre of width.
std::string_view unit_of(Measure measure, int dimension);

}  // namespace tailwater
