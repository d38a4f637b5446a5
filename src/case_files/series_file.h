// A CSV file of quantities over time, as described in linked_files.h.
#pragma once

#include <filesystem>
#include <istream>
#include <span>

#include "case_files/time_series.h"

namespace tailwater {

/// The type of the lines of a file of measured values.
enum class Samples { of_one_place, of_profiles };

/// The columns of `file`, whose name is used in messages, in SI units. Throws InputError with file, line and remedy.
TimeSeries parse_series(const std::filesystem::path& path, std::istream& file, std::span<const SeriesColumn> columns);

/// The measured values of `file`, as read_measured_series returns them.
TimeSeries parse_measured_series(const std::filesystem::path& path, std::istream& file,
                                 std::span<const std::string_view> names, Measure measure, Samples samples);

}  // namespace tailwater
