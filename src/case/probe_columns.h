// The columns of probes' tables that hold one quantity over time, or over x and time, with which a measurement can be
// compared.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "case/spec.h"
#include "case_files/time_series.h"

namespace tailwater {

/// Those that the probe writes, the first its default; none of a velocity profile, and of a profile in 3D.
std::vector<SeriesColumn> columns_of(const ProbeTable& probe, int dimension);

struct Compared {
  std::size_t probe;  ///< in the case
  SeriesColumn column;
};
/// With what a measurement of a case that has been read is compared.
Compared compared_with(const MeasurementTable& measurement, const CaseSpec& spec);

/// Whether a heading of a table, as in "force_x_N_per_m", is that of the column.
bool is_heading_of(const SeriesColumn& column, std::string_view heading);

/// The unit of a column by the end of its name. In 2D a force is per metre of width, as its column says; an energy and
/// a volume are too, which theirs do not say.
std::string unit_of_column(std::string_view column, int dimension);

}  // namespace tailwater
