// Files that a case names: the points of a chain, quantities over time, and the checksums of files.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "case_files/coordinates.h"
#include "case_files/series_file.h"

namespace tailwater {

/// The points of a CSV file, in m. Empty lines and lines that begin with # are skipped. The first other line may name
/// the columns, each with its unit (m, mm, cm, km or ft) as in "x [mm]", "z (m)" or "z_m". If there are more than two
/// columns, those named x, station, chainage or distance, and y, z, elevation, height or level are used. Columns are
/// separated by commas, semicolons, tabs or blanks. Throws IoError if the file cannot be read, else InputError, which
/// names file and line and gives the remedy.
std::vector<Coordinates> read_points_file(const std::filesystem::path& path);

/// The named columns of a CSV file over time, in SI units. Its first line that is neither empty nor a comment names the
/// columns: t, or time, in s, ms, min or h, and any of `columns`, each with its unit as in "t [s], x [mm], angle
/// [deg]". Without a unit t is in s, a length in m and a speed in m/s; an angle and a discharge need theirs. Throws
/// IoError if the file cannot be read, else InputError, which names file and line and gives the remedy.
TimeSeries read_time_series(const std::filesystem::path& path, std::span<const SeriesColumn> columns);

/// One column of a CSV file of measured values over time, in SI units. The file is as for read_time_series, and may
/// have other columns. The column is the first of `names`, or else "value", that the header has, in this order, or the
/// only column beside the time. A pressure, a force and a moment need a unit too. Times may repeat and go back, as
/// digitised ones do: they are sorted, and values of one time are averaged. Profiles have their places, the column x of
/// the file, as second column, and keep their order within a time. Throws the exceptions of read_time_series.
TimeSeries read_measured_series(const std::filesystem::path& path, std::span<const std::string_view> names,
                                Measure measure, Samples samples);

/// CRC-32 of the file's bytes, as 8 hexadecimal digits. Throws IoError if the file cannot be read.
std::string checksum_of_file(const std::filesystem::path& path);

}  // namespace tailwater
