// The columns of probes' tables that hold one quantity over time, with which a measurement can be compared.
#pragma once

#include <string_view>
#include <vector>

#include "case/choices.h"
#include "case/time_series.h"

namespace tailwater {

/// Those of a probe of this type, the first its default; none where its table has several lines of one time.
std::vector<SeriesColumn> columns_of(ProbeType type, int dimension);

/// Whether a heading of a table, as in "force_x_N_per_m", is that of the column.
bool is_heading_of(const SeriesColumn& column, std::string_view heading);

}  // namespace tailwater
