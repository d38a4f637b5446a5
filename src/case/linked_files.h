// Files that a case names: the points of a chain, and the checksum of a mesh.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "case/spec.h"

namespace tailwater {

/// The points of a CSV file, in m. Lines that are empty or begin with # are skipped. The first other line may name the
/// columns, each with its unit (m, mm, cm, km or ft) as in "x [mm]", "z (m)" or "z_m". Of more than two columns those
/// named x, station, chainage or distance, and y, z, elevation, height or level are taken. Columns are separated by
/// commas, semicolons, tabs or blanks.
/// Throws IoError if the file cannot be read, else InputError, which names file and line and gives the remedy.
std::vector<Coordinates> read_points_file(const std::filesystem::path& path);

/// CRC-32 of the file's bytes, as 8 hexadecimal digits. Throws IoError if it cannot be read.
std::string checksum_of_file(const std::filesystem::path& path);

}  // namespace tailwater
