#include "case/key_rules.h"

#include <fmt/format.h>

#include <algorithm>

namespace tailwater {

void check_shape_dimension(std::string_view shape, int dimension, std::string_view instead, TableReader& reader) {
  const toml::node* node = reader.given("shape");
  if (dimension == 0 || reader.dimension() == 0 || reader.dimension() == dimension) return;
  const std::string message = fmt::format("\"{}\" is a shape of {} dimensions, but case.dimension = {}; use {}", shape,
                                          dimension == 2 ? "two" : "three", reader.dimension(), instead);
  if (node != nullptr) {
    reader.wrong("shape-of-other-dimension", "shape", message);
  } else {
    reader.missing("shape-of-other-dimension", "shape", message);
  }
}

void check_box(const Coordinates& min, const Coordinates& max, TableReader& reader) {
  const toml::node* node = reader.given("max");
  if (node == nullptr || reader.given("min") == nullptr || reader.is_wrong("min") || reader.is_wrong("max")) return;
  for (std::size_t d = 0; d < std::min(min.size(), max.size()); ++d) {
    if (max[d] <= min[d]) {
      reader.wrong("box-max-below-min", "max", "the box has no extent in {}: {} to {}; give max above min", "xyz"[d],
                   min[d], max[d]);
    }
  }
}

std::size_t min_corners(WallShape shape, int dimension) {
  if (shape == WallShape::plate && dimension == 3) return 4;
  return shape == WallShape::polyline || shape == WallShape::plate ? 2 : 3;
}

void check_corner_count(const std::vector<Coordinates>& points, std::size_t least, TableReader& reader,
                        std::string_view key) {
  const toml::node* node = reader.given(key);
  if (node != nullptr && !reader.is_wrong(key) && points.size() < least) {
    reader.wrong("too-few-points", key, "too few points for this shape ({}); give at least {}", points.size(), least);
  }
}

Coordinates along_x(const TableReader& reader) {
  Coordinates direction(static_cast<std::size_t>(reader.dimension()), 0.0);
  if (!direction.empty()) direction.front() = 1.0;
  return direction;
}

void check_direction(const Coordinates& direction, TableReader& reader) {
  if (const toml::node* node = reader.given("direction"); node != nullptr && !reader.is_wrong("direction")) {
    if (std::all_of(direction.begin(), direction.end(), [](double c) { return c == 0.0; })) {
      reader.wrong("direction-zero", "direction", "has length 0; give a direction such as [1, 0]");
    }
  }
}

void check_ends(const Coordinates& from, const Coordinates& to, TableReader& reader) {
  if (!from.empty() && from == to && !reader.is_wrong("from") && !reader.is_wrong("to")) {
    reader.wrong("from-equals-to", "to", "is the same point as from; give two points");
  }
}

void check_turning_in_3d(const WallTable& wall, std::string_view key, TableReader& reader) {
  const bool has_axis = std::ranges::any_of(wall.axis, [](double c) { return c != 0.0; });
  if (wall.shape != WallShape::box && !reader.is_wrong("shape")) {
    reader.wrong("wall-turns-not-box", key,
                 "in three dimensions only walls of shape = \"box\" turn; draw boxes, or let the wall keep its angle");
  } else if (!has_axis && !reader.is_wrong("axis")) {
    reader.wrong("wall-turns-without-axis", key,
                 "needs the axis about which the wall turns; give axis, such as [0, 1, 0], and pivot, a point on it");
  }
}

}  // namespace tailwater
