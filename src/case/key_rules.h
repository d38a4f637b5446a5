// Rules for keys that several tables use. Keys with a wrong value of their own were reported before and are left out.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "case/spec.h"
#include "case/table_reader.h"

namespace tailwater {

/// `dimension`: the only one in which the shape exists; 0: it exists in both.
void check_shape_dimension(std::string_view shape, int dimension, std::string_view instead, TableReader& reader);

void check_box(const Coordinates& min, const Coordinates& max, TableReader& reader);

/// The minimum number of corners of a wall of this shape.
std::size_t min_corners(WallShape shape, int dimension);

void check_corner_count(const std::vector<Coordinates>& points, std::size_t least, TableReader& reader,
                        std::string_view key = "points");

/// The direction +x.
Coordinates along_x(const TableReader& reader);

void check_direction(const Coordinates& direction, TableReader& reader);

/// Checks two ends of an object, which must differ.
void check_ends(const Coordinates& from, const Coordinates& to, TableReader& reader);

/// Checks that in 3D only boxes turn, about an axis; `key` is the key by which the wall turns.
void check_turning_in_3d(const WallTable& wall, std::string_view key, TableReader& reader);

}  // namespace tailwater
