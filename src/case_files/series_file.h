// A CSV file of quantities over time, as linked_files.h describes it.
#pragma once

#include <filesystem>
#include <istream>
#include <span>

#include "case_files/time_series.h"

namespace tailwater {

/// What the lines of a file of measured values are.
enum class Samples { of_one_place, of_profiles };

/// The columns of `file`, whose name messages tell, in SI units. Throws InputError with file, line and remedy.
TimeSeries parse_series(const std::filesystem::path& path, std::istream& file, std::span<const SeriesColumn> columns);

/// What was measured, likewise, as read_measured_series has it.
TimeSeries parse_measured_series(const std::filesystem::path& path, std::istream& file,
                                 std::span<const std::string_view> names, Measure measure, Samples samples);

}  // namespace tailwater
