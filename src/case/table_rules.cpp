#include "case/table_rules.h"

#include <fmt/format.h>

#include <algorithm>
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

void check_corner_count(const std::vector<Coordinates>& points, std::size_t least, TableReader& reader,
                        std::string_view key = "points") {
  const toml::node* node = reader.given(key);
  if (node != nullptr && !reader.is_wrong(key) && points.size() < least) {
    reader.wrong(key, *node,
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
  if (probe.type == ProbeType::front) probe.direction = along_x(reader);
}

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

void read_linked_files(WallTable& wall, TableReader& reader) {
  const auto read = [&](std::string_view key, auto&& body) {
    const toml::node* node = reader.given(key);
    if (node == nullptr || reader.is_wrong(key) || reader.is_wrong("shape")) return;
    try {
      body();
    } catch (const UserError& error) {
      reader.wrong(key, *node, error.what());
    }
  };
  if (!wall.points_file.empty() && wall.points.empty()) {
    read("points_file", [&] {
      wall.points = read_points_file(reader.linked(wall.points_file));
      const std::size_t least = wall.shape == WallShape::polyline ? 2 : 3;
      if (wall.points.size() < least) {
        throw InputError(fmt::format("has too few points for shape = \"{}\": {}; give at least {}", name_of(wall.shape),
                                     wall.points.size(), least));
      }
      wall.points_file.clear();
    });
  }
  if (wall.shape == WallShape::mesh) {
    read("file", [&] {
      const std::filesystem::path path = reader.linked(wall.file);
      const std::string found = checksum_of_file(path);
      if (!wall.checksum.empty() && wall.checksum != found) {
        throw InputError(
            fmt::format("{} has changed: its checksum is {}, and the case asks for {}; put the file back that the case "
                        "was made for, or start a new run without checksum",
                        path.string(), found, wall.checksum));
      }
      wall.file = path.string();
      wall.checksum = found;
    });
  }
}

void check(const OutletTable& outlet, TableReader& reader) {
  check_direction(outlet.direction, reader);
  check_ends(outlet.from, outlet.to, reader);
}

namespace {

/// The region that limits a probe to a part of the walls: a box, which may be flat, or a polygon.
void check_region(const ProbeTable& probe, TableReader& reader) {
  const toml::node* min = reader.given("region_min");
  const toml::node* max = reader.given("region_max");
  const toml::node* points = reader.given("region_points");
  if (reader.is_wrong("region_min") || reader.is_wrong("region_max") || reader.is_wrong("region_points")) return;
  if ((min == nullptr) != (max == nullptr)) {
    const bool lacks_max = max == nullptr;
    reader.wrong(lacks_max ? "region_min" : "region_max", lacks_max ? *min : *max,
                 fmt::format("is one corner of a box; give {} as well", lacks_max ? "region_max" : "region_min"));
    return;
  }
  for (std::size_t d = 0; d < std::min(probe.region_min.size(), probe.region_max.size()); ++d) {
    if (probe.region_max[d] < probe.region_min[d]) {
      reader.wrong("region_max", *max,
                   fmt::format("lies below region_min in {}: {} and {}; exchange them", "xyz"[d], probe.region_min[d],
                               probe.region_max[d]));
    }
  }
  if (points == nullptr) return;
  check_corner_count(probe.region_points, 3, reader, "region_points");
  if (min != nullptr) {
    reader.wrong("region_points", *points, "the probe has a box region_min to region_max as well; remove one of them");
  } else if (reader.dimension() == 3) {
    reader.wrong("region_points", *points, "a polygon is a region of two dimensions; give region_min and region_max");
  }
}

}  // namespace

void check(const ProbeTable& probe, TableReader& reader) {
  check_region(probe, reader);
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
