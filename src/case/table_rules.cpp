#include "case/table_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "case/formulation.h"
#include "case/key_use.h"
#include "case/linked_files.h"

namespace tailwater {

namespace {

/// `dimension`: the only one in which the shape exists; 0: it exists in both.
void check_shape_dimension(std::string_view shape, int dimension, std::string_view instead, TableReader& reader) {
  const toml::node* node = reader.given("shape");
  if (dimension == 0 || reader.dimension() == 0 || reader.dimension() == dimension) {
    return;
  }
  const std::string message = fmt::format("\"{}\" is a shape of {} dimensions, but case.dimension = {}; use {}", shape,
                                          dimension == 2 ? "two" : "three", reader.dimension(), instead);
  if (node != nullptr) {
    reader.wrong("shape", *node, message);
  } else {
    reader.missing("shape", message);
  }
}

void check_box(const Coordinates& min, const Coordinates& max, TableReader& reader) {
  const toml::node* node = reader.given("max");
  if (node == nullptr || reader.given("min") == nullptr || reader.is_wrong("min") || reader.is_wrong("max")) {
    return;
  }
  for (std::size_t d = 0; d < std::min(min.size(), max.size()); ++d) {
    if (max[d] <= min[d]) {
      reader.wrong("max", *node,
                   fmt::format("the box has no extent in {}: {} to {}; give max above min", "xyz"[d], min[d], max[d]));
    }
  }
}

void check_corner_count(const std::vector<Coordinates>& points, std::size_t least, TableReader& reader) {
  const toml::node* node = reader.given("points");
  if (node != nullptr && !reader.is_wrong("points") && points.size() < least) {
    reader.wrong("points", *node,
                 fmt::format("{} points are too few for this shape; give at least {}", points.size(), least));
  }
}

/// The direction +x.
Coordinates along_x(const TableReader& reader) {
  Coordinates direction(static_cast<std::size_t>(reader.dimension()), 0.0);
  if (!direction.empty()) direction.front() = 1.0;
  return direction;
}

void check_direction(const Coordinates& direction, TableReader& reader) {
  if (const toml::node* node = reader.given("direction"); node != nullptr && !reader.is_wrong("direction")) {
    if (std::all_of(direction.begin(), direction.end(), [](double c) { return c == 0.0; })) {
      reader.wrong("direction", *node, "has length 0; give a direction such as [1, 0]");
    }
  }
}

/// Two ends of something that has an extent.
void check_ends(const Coordinates& from, const Coordinates& to, TableReader& reader) {
  if (!from.empty() && from == to && !reader.is_wrong("from") && !reader.is_wrong("to")) {
    reader.wrong("to", *reader.given("to"), "is the same point as from; give two points");
  }
}

}  // namespace

void set_defaults(SchemeTable& scheme, TableReader& reader) {
  reader.read_ahead(scheme, {"name", "formulation", "integrator"});
  apply_formulation(scheme);
}

void set_defaults(FluidTable& fluid, TableReader& reader) {
  fluid.velocity.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
}

void set_defaults(WallTable& wall, TableReader& reader) {
  reader.read_ahead(wall, {"shape"});
  wall.fluid_side = wall.shape == WallShape::polyline ? FluidSide::left : FluidSide::inside;
  wall.displacement.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
  wall.pivot.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
  wall.rotate = wall.translate = wall.pivot;
}

void set_defaults(ProbeTable& probe, TableReader& reader) {
  reader.read_ahead(probe, {"type"});
  if (probe.type == ProbeType::front || probe.type == ProbeType::discharge) probe.direction = along_x(reader);
}

void set_defaults(InletTable& inlet, TableReader& reader) { inlet.direction = along_x(reader); }

void set_defaults(OutletTable& outlet, TableReader& reader) { outlet.direction = along_x(reader); }

/// Under-relaxation by a factor f leaves (1 - f)^passes of the old value, so too few passes lose part of every step.
void check(const SchemeTable& scheme, TableReader& reader) {
  constexpr double most_left = 0.01;
  const double least = std::min({scheme.relax_pressure, scheme.relax_velocity, scheme.relax_position});
  if (scheme.integrator != Integrator::implicit_projection || least >= 1.0 || reader.is_wrong("max_passes")) {
    return;
  }
  const int needed = static_cast<int>(std::ceil(std::log(most_left) / std::log(1.0 - least)));
  if (scheme.max_passes >= needed) {
    return;
  }
  const std::string message = fmt::format(
      "{} passes with an under-relaxation factor of {} do not complete a step; give at least {} passes, or a larger "
      "factor",
      scheme.max_passes, least, needed);
  if (const toml::node* node = reader.given("max_passes")) {
    reader.wrong("max_passes", *node, message);
  } else {
    reader.missing("max_passes", message);
  }
}

void check(const PhysicsTable& physics, TableReader& reader) {
  const toml::node* node = reader.given("channel_width");
  if (node != nullptr && physics.channel_width > 0.0 && reader.dimension() == 3) {
    reader.wrong("channel_width", *node,
                 "replaces the side walls that are missing in two dimensions, but case.dimension = 3; "
                 "remove it and give the side walls as [[wall]] tables");
  }
}

void check(const FluidTable& fluid, TableReader& reader) {
  check_shape_dimension(name_of(fluid.shape), fluid.shape == BlockShape::polygon ? 2 : 0, "\"box\" or \"fill\"",
                        reader);
  check_box(fluid.min, fluid.max, reader);
  check_corner_count(fluid.points, 3, reader);
}

namespace {

/// A chain has its points in the case or in a file.
void check_points_given(const WallTable& wall, TableReader& reader) {
  if (wall.shape != WallShape::polyline && wall.shape != WallShape::polygon) return;
  const bool has_file = !wall.points_file.empty();
  if (has_file && reader.given("points") != nullptr) {
    reader.wrong("points_file", *reader.given("points_file"),
                 "the wall has points as well; remove one of the two keys");
  } else if (!has_file && reader.given("points") == nullptr && !reader.is_wrong("shape") &&
             !reader.is_wrong("points_file")) {
    reader.missing(
        "points", fmt::format("shape = \"{}\" needs it: give its corners in m, or a points_file", name_of(wall.shape)));
  }
}

void check_fluid_side(const WallTable& wall, TableReader& reader) {
  if (reader.is_wrong("shape") || reader.is_wrong("fluid_side")) return;
  const toml::node* node = reader.given("fluid_side");
  const FluidSide side = wall.fluid_side;
  const bool is_chain_side = side == FluidSide::left || side == FluidSide::right;
  const bool is_body_side = side == FluidSide::inside || side == FluidSide::outside;
  if (wall.shape == WallShape::mesh) {
    constexpr std::string_view sides =
        "\"inside\" or \"outside\" of a closed mesh, \"above\" or \"below\" an open one, or its \"front\" or \"back\"";
    if (node == nullptr) {
      reader.missing("fluid_side", fmt::format("a mesh needs it; give {}", sides));
    } else if (is_chain_side) {
      reader.wrong("fluid_side", *node, fmt::format("does not fit shape = \"mesh\"; give {}", sides));
    }
    return;
  }
  const bool is_chain = wall.shape == WallShape::polyline;
  if (is_chain ? is_chain_side : is_body_side) return;
  reader.wrong("fluid_side", *node,
               fmt::format("does not fit shape = \"{}\"; give {}", name_of(wall.shape),
                           is_chain ? "\"left\" or \"right\"" : "\"inside\" or \"outside\""));
}

}  // namespace

void check(const WallTable& wall, TableReader& reader) {
  switch (wall.shape) {
    case WallShape::polyline:
    case WallShape::polygon:
      check_shape_dimension(name_of(wall.shape), 2, "\"box\" or \"mesh\"", reader);
      break;
    case WallShape::mesh:
      check_shape_dimension(name_of(wall.shape), 3, "\"polyline\", \"polygon\" or \"box\"", reader);
      break;
    case WallShape::box:
      break;
  }
  check_points_given(wall, reader);
  check_box(wall.min, wall.max, reader);
  check_corner_count(wall.points, wall.shape == WallShape::polyline ? 2 : 3, reader);
  if (const toml::node* node = reader.given("open"); node != nullptr && reader.dimension() == 2) {
    for (const std::string& face : wall.open) {
      if (face.ends_with('z')) {
        reader.wrong("open", *node, fmt::format("a box of two dimensions has no face \"{}\"; remove it", face));
      }
    }
  }
  check_fluid_side(wall, reader);
  if (reader.dimension() == 3 && wall.rotation != Varying(0.0)) {
    reader.wrong("rotation", *reader.given("rotation"), "walls turn in two dimensions only; remove the key");
  }
}

namespace {

/// Calls body, which reads the file that `key` names, and reports what is wrong with it at that key.
template <class Body>
void read_linked(std::string_view key, TableReader& reader, Body&& body) {
  const toml::node* node = reader.given(key);
  if (node == nullptr || reader.is_wrong(key)) return;
  try {
    body();
  } catch (const UserError& error) {
    reader.wrong(key, *node, error.what());
  }
}

/// Makes the name of a file absolute and takes its checksum; a file that is not the one of the checksum is refused.
void keep_linked(std::string& file, std::string& checksum, std::string_view checksum_key, TableReader& reader) {
  const std::filesystem::path path = reader.linked(file);
  const std::string found = checksum_of_file(path);
  if (!checksum.empty() && checksum != found) {
    throw InputError(
        fmt::format("{} has changed: its checksum is {}, and the case asks for {}; put the file back that the case "
                    "was made for, or start a new run without {}",
                    path.string(), found, checksum, checksum_key));
  }
  file = path.string();
  checksum = found;
}

/// A series that is too short for the run is found by geometry/checks, when the end of the run is known.
void read_series(std::string& file, std::string& checksum, std::span<const SeriesColumn> columns, TimeSeries& series,
                 TableReader& reader) {
  if (file.empty()) return;
  read_linked("file", reader, [&] {
    keep_linked(file, checksum, "checksum", reader);
    series = read_time_series(file, columns);
  });
}

/// The keys of those that have a value, in the case or in a file.
struct Given {
  std::string_view key;
  bool in_case;
  bool in_file;
  bool anywhere() const { return in_case || in_file; }
};

/// No quantity may come from the case and from a file.
void check_given_once(std::span<const Given> quantities, TableReader& reader) {
  for (const Given& quantity : quantities) {
    if (!quantity.in_case || !quantity.in_file) continue;
    reader.wrong(quantity.key, *reader.given(quantity.key),
                 fmt::format("the file has a column {} as well; remove one of the two", quantity.key));
  }
}

Given given(std::string_view key, const std::optional<Varying>& value, const TimeSeries& series, std::size_t column) {
  return {key, value.has_value(), column < series.columns.size() && !series.columns[column].empty()};
}

}  // namespace

void read_linked_files(WallTable& wall, TableReader& reader) {
  if (!wall.points_file.empty() && wall.points.empty() && !reader.is_wrong("shape")) {
    read_linked("points_file", reader, [&] {
      wall.points = read_points_file(reader.linked(wall.points_file));
      const std::size_t least = wall.shape == WallShape::polyline ? 2 : 3;
      if (wall.points.size() < least) {
        throw InputError(fmt::format("has too few points for shape = \"{}\": {}; give at least {}", name_of(wall.shape),
                                     wall.points.size(), least));
      }
      wall.points_file.clear();
    });
  }
  if (wall.shape == WallShape::mesh && !reader.is_wrong("shape")) {
    read_linked("file", reader, [&] { keep_linked(wall.file, wall.checksum, "checksum", reader); });
  }
}

void read_linked_files(InletTable& inlet, TableReader& reader) {
  static constexpr std::array<SeriesColumn, 3> columns{
      {{"discharge", Measure::discharge}, {"velocity", Measure::speed}, {"level"}}};
  read_series(inlet.file, inlet.checksum, columns, inlet.series, reader);
  if (reader.is_wrong("file")) return;
  const Given discharge = given("discharge", inlet.discharge, inlet.series, 0);
  const Given velocity = given("velocity", inlet.velocity, inlet.series, 1);
  const Given level = given("level", inlet.level, inlet.series, 2);
  check_given_once(std::array{discharge, velocity, level}, reader);
  const bool has_wrong_key = reader.is_wrong("discharge") || reader.is_wrong("velocity") || reader.is_wrong("level");
  if (!has_wrong_key && !discharge.anywhere() && !velocity.anywhere() && !level.anywhere()) {
    reader.missing("discharge", "say what enters: give a discharge, a velocity or a level, or a file with one of them");
  }
  if (discharge.anywhere() && velocity.anywhere()) {
    const std::string_view key = velocity.in_case ? "velocity" : discharge.in_case ? "discharge" : "file";
    reader.wrong(key, *reader.given(key), "an inlet has a discharge or a velocity; remove one of the two");
  }
  if (inlet.profile && !discharge.anywhere() && !velocity.anywhere()) {
    reader.wrong("profile", *reader.given("profile"),
                 "needs a discharge or a velocity; an inlet with a level alone takes the velocity from the flow");
  }
}

void read_linked_files(OutletTable& outlet, TableReader& reader) {
  static constexpr std::array<SeriesColumn, 1> columns{{{"level"}}};
  read_series(outlet.file, outlet.checksum, columns, outlet.series, reader);
  if (!reader.is_wrong("file")) check_given_once(std::array{given("level", outlet.level, outlet.series, 0)}, reader);
}

void check(const InletTable& inlet, TableReader& reader) {
  check_direction(inlet.direction, reader);
  check_ends(inlet.from, inlet.to, reader);
}

void check(const OutletTable& outlet, TableReader& reader) {
  check_direction(outlet.direction, reader);
  check_ends(outlet.from, outlet.to, reader);
}

void check(const ProbeTable& probe, TableReader& reader) {
  check_direction(probe.direction, reader);
  if (const toml::node* node = reader.given("times"); node != nullptr && !reader.is_wrong("times")) {
    const bool is_rising =
        std::adjacent_find(probe.times.begin(), probe.times.end(), std::greater_equal<>()) == probe.times.end();
    if (probe.times.empty() || probe.times.front() < 0.0 || !is_rising) {
      reader.wrong("times", *node, "give at least one time in s, none negative, in increasing order");
    }
  }
  check_ends(probe.from, probe.to, reader);
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (const toml::node* node = reader.given("name"); node != nullptr && !reader.is_wrong("name")) {
    const bool is_file_name = std::all_of(probe.name.begin(), probe.name.end(), is_plain) && !probe.name.empty() &&
                              probe.name.front() != '-' && probe.name.size() <= 100;
    if (!is_file_name) {
      reader.wrong("name", *node,
                   "cannot be a file name; use up to 100 letters, digits, _ and -, and do not begin with -");
    }
  }
}

void check(const DomainTable& domain, TableReader& reader) {
  const auto check_period = [&](std::string_view key, const std::vector<double>& range, int least_dimension) {
    const toml::node* node = reader.given(key);
    if (node == nullptr || reader.is_wrong(key) || range.empty()) {
      return;
    }
    if (range.size() != 2) {
      reader.wrong(key, *node, "give two numbers in m, [low, high], or remove the key");
    } else if (range[0] >= range[1]) {
      reader.wrong(key, *node, "is empty; give [low, high] with low below high, in m");
    } else if (reader.dimension() != 0 && reader.dimension() < least_dimension) {
      reader.wrong(key, *node, "a case of two dimensions has no z; remove the key");
    }
  };
  check_period("periodic_x", domain.periodic_x, 2);
  check_period("periodic_y", domain.periodic_y, 2);
  check_period("periodic_z", domain.periodic_z, 3);
}

/// Reports keys that the chosen shape or type needs or does not use.
void check_key_uses(std::string_view table, std::span<const KeyInfo> rows, TableReader& reader) {
  for (const KeyInfo& info : rows) {
    const auto [need, use] = key_verdict(table, info.key, rows);
    if (use == nullptr || reader.is_wrong(use->selector)) {
      continue;
    }
    const std::string choice = fmt::format("{} = \"{}\"", use->selector, use->choice);
    const toml::node* node = reader.given(info.key);
    if (need == KeyNeed::needed && node == nullptr) {
      reader.missing(info.key, fmt::format("{} needs it: {}{}", choice, info.doc, in_unit(info.unit)));
    } else if (need == KeyNeed::unused && node != nullptr) {
      reader.wrong(
          info.key, *node,
          fmt::format("is not used with {}; remove it (it goes with {})", choice, key_use_text(table, info.key)));
    }
  }
}

}  // namespace tailwater
