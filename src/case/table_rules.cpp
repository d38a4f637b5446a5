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

/// The number of corners that a wall of this shape has at least.
std::size_t least_corners(WallShape shape, int dimension) {
  if (shape == WallShape::plate && dimension == 3) return 4;
  return shape == WallShape::polyline || shape == WallShape::plate ? 2 : 3;
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
  fluid.rotate.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
  fluid.translate = fluid.rotate;
}

void set_defaults(WallTable& wall, TableReader& reader) {
  reader.read_ahead(wall, {"shape"});
  wall.fluid_side = wall.shape == WallShape::polyline ? FluidSide::left : FluidSide::inside;
  wall.displacement.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
  wall.pivot.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
  wall.rotate = wall.translate = wall.axis = wall.pivot;
}

void set_defaults(GateTable& gate, TableReader& reader) {
  gate.direction.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
}

void set_defaults(WaveMakerTable& maker, TableReader& reader) {
  reader.read_ahead(maker, {"waves", "period"});
  maker.ramp = 2.0 * maker.period;
}

void set_defaults(BodyTable& body, TableReader& reader) {
  const std::vector<std::string> in_plane{"x", "y", "rotation"};
  const std::vector<std::string> in_space{"x", "y", "z", "rotation_x", "rotation_y", "rotation_z"};
  body.free = reader.dimension() == 3 ? in_space : in_plane;
  body.velocity.assign(static_cast<std::size_t>(reader.dimension()), 0.0);
}

void set_defaults(ProbeTable& probe, TableReader& reader) {
  reader.read_ahead(probe, {"type"});
  if (probe.type == ProbeType::front || probe.type == ProbeType::discharge) probe.direction = along_x(reader);
}

void set_defaults(InletTable& inlet, TableReader& reader) { inlet.direction = along_x(reader); }

void set_defaults(OutletTable& outlet, TableReader& reader) { outlet.direction = along_x(reader); }

void check(const PhysicsTable& physics, TableReader& reader) {
  const toml::node* node = reader.given("channel_width");
  if (node != nullptr && physics.channel_width > 0.0 && reader.dimension() == 3) {
    reader.wrong("channel_width", *node,
                 "replaces the side walls that are missing in two dimensions, but case.dimension = 3; "
                 "remove it and give the side walls as [[wall]] tables");
  }
}

void check(const FluidTable& fluid, TableReader& reader) {
  const int dimension = fluid.shape == BlockShape::polygon ? 2 : fluid.shape == BlockShape::mesh ? 3 : 0;
  check_shape_dimension(name_of(fluid.shape), dimension,
                        dimension == 2 ? "\"box\", \"mesh\" or \"fill\"" : "\"box\", \"polygon\" or \"fill\"", reader);
  check_box(fluid.min, fluid.max, reader);
  check_corner_count(fluid.points, 3, reader);
}

namespace {

/// A plate is drawn by points or by a mesh.
void check_mesh_of_plate(const WallTable& wall, TableReader& reader) {
  if (reader.is_wrong("file")) return;
  if (reader.dimension() == 2) {
    reader.wrong("file", *reader.given("file"),
                 "a mesh has three dimensions, but case.dimension = 2; give points or a points_file");
  } else if (!wall.points_file.empty() || reader.given("points") != nullptr) {
    reader.wrong("file", *reader.given("file"), "the plate has points as well; remove one of the two keys");
  }
}

/// A chain has its points in the case or in a file.
void check_points_given(const WallTable& wall, TableReader& reader) {
  if (wall.shape == WallShape::box || wall.shape == WallShape::mesh) return;
  if (wall.shape == WallShape::plate && !wall.file.empty()) {
    check_mesh_of_plate(wall, reader);
    return;
  }
  const bool has_file = !wall.points_file.empty();
  if (has_file && reader.given("points") != nullptr) {
    reader.wrong("points_file", *reader.given("points_file"),
                 "the wall has points as well; remove one of the two keys");
  } else if (!has_file && reader.given("points") == nullptr && !reader.is_wrong("shape") &&
             !reader.is_wrong("points_file")) {
    reader.missing(
        "points", fmt::format("shape = \"{}\" needs it: give its corners in m, or a {}", name_of(wall.shape),
                              wall.shape == WallShape::plate && reader.dimension() == 3 ? "mesh file" : "points_file"));
  }
}

void check_fluid_side(const WallTable& wall, TableReader& reader) {
  if (wall.shape == WallShape::plate || reader.is_wrong("shape") || reader.is_wrong("fluid_side")) return;
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

/// In 3D only boxes turn, about an axis; `key` says that the wall does.
void check_turning_in_3d(const WallTable& wall, std::string_view key, TableReader& reader) {
  const bool has_axis = std::ranges::any_of(wall.axis, [](double c) { return c != 0.0; });
  if (wall.shape != WallShape::box && !reader.is_wrong("shape")) {
    reader.wrong(key, *reader.given(key),
                 "in three dimensions only walls of shape = \"box\" turn; draw boxes, or let the wall keep its angle");
  } else if (!has_axis && !reader.is_wrong("axis")) {
    reader.wrong(key, *reader.given(key),
                 "needs the axis about which the wall turns; give axis, such as [0, 1, 0], and pivot, a point of it");
  }
}

/// How a wall moves is said by expressions or by a file, and in 3D it turns about an axis.
void check_wall_motion(const WallTable& wall, TableReader& reader) {
  const auto is_zero = [](const Varying& value) { return value == Varying(0.0); };
  const auto refuse = [&](std::string_view key) {
    reader.wrong(key, *reader.given(key), "the wall has a motion from a file as well; remove one of the two keys");
  };
  if (!wall.motion.empty() && !std::ranges::all_of(wall.displacement, is_zero)) refuse("displacement");
  if (!wall.motion.empty() && !is_zero(wall.rotation)) refuse("rotation");
  const bool has_axis = std::ranges::any_of(wall.axis, [](double c) { return c != 0.0; });
  if (reader.dimension() == 2 && has_axis) {
    reader.wrong("axis", *reader.given("axis"), "in two dimensions walls turn about their pivot only; remove the key");
  }
  if (reader.dimension() != 3 || wall.rotation == Varying(0.0)) return;
  check_turning_in_3d(wall, "rotation", reader);
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
    case WallShape::plate:
      break;
  }
  check_points_given(wall, reader);
  check_box(wall.min, wall.max, reader);
  check_corner_count(wall.points, least_corners(wall.shape, reader.dimension()), reader);
  if (const toml::node* node = reader.given("open"); node != nullptr && reader.dimension() == 2) {
    for (const std::string& face : wall.open) {
      if (face.ends_with('z')) {
        reader.wrong("open", *node, fmt::format("a box of two dimensions has no face \"{}\"; remove it", face));
      }
    }
  }
  check_fluid_side(wall, reader);
  check_wall_motion(wall, reader);
  if (wall.roughness > 0.0 && wall.manning > 0.0) {
    reader.wrong("manning", *reader.given("manning"), "the wall has a roughness as well; remove one of the two keys");
  }
}

namespace {

/// Checks that `from` and `to` span a flat axis-parallel plate with that side; `what` is its name in messages.
void check_plate(const Coordinates& from, const Coordinates& to, AxisDirection side, std::string_view what,
                 TableReader& reader) {
  if (from.size() != to.size() || reader.is_wrong("from") || reader.is_wrong("to") || from.empty()) return;
  const auto axis = static_cast<std::size_t>(side) / 2;
  std::string flat;
  for (std::size_t d = 0; d < from.size(); ++d) {
    if (from[d] == to[d]) flat += "xyz"[d];
  }
  if (flat.size() != 1) {
    reader.wrong("to", *reader.given("to"),
                 fmt::format("differs from `from` in {} coordinates, but {} is a flat {}: give two points that have "
                             "exactly one coordinate in common",
                             from.size() - flat.size(), what,
                             from.size() == 2 ? "upright or level segment" : "axis-parallel rectangle"));
  } else if (axis >= from.size() || flat[0] != "xyz"[axis]) {
    const std::string message = fmt::format(
        "the plane through from and to is at one {}, so its sides are \"-{}\" and \"+{}\"; give one of them", flat,
        flat, flat);
    if (const toml::node* node = reader.given("side")) {
      reader.wrong("side", *node, message);
    } else {
      reader.missing("side", message);
    }
  }
}

/// No solitary wave is higher than this share of the depth (McCowan 1894), nor is any periodic one.
constexpr double highest_over_depth = 0.78;

}  // namespace

void check(const WaveMakerTable& maker, TableReader& reader) {
  check_plate(maker.from, maker.to, maker.side, "a wave maker", reader);
  if (maker.waves == WaveKind::none && maker.absorption == Absorption::none && !reader.is_wrong("absorption")) {
    reader.missing("absorption",
                   "a plate that makes no waves would rest; give absorption = \"active\", or other waves");
  }
  const bool has_period = maker.waves == WaveKind::regular || maker.waves == WaveKind::jonswap;
  if (has_period && maker.period == 0.0 && reader.given("period") != nullptr && !reader.is_wrong("period")) {
    reader.wrong("period", *reader.given("period"), "waves need a period; give a number above 0 in s");
  }
  if (maker.type == MakerType::flap && maker.waves == WaveKind::solitary && !reader.is_wrong("type")) {
    reader.wrong("type", *reader.given("type"), "a solitary wave moves the water evenly over the depth; use a piston");
  }
  if (const toml::node* node = reader.given("order");
      node != nullptr && maker.type == MakerType::flap && maker.order == 2) {
    reader.wrong("order", *node, "the theory of second order is for pistons; give 1, or type = \"piston\"");
  }
  if (maker.waves == WaveKind::jonswap && maker.ramp == 0.0 && reader.given("ramp") != nullptr &&
      !reader.is_wrong("ramp")) {
    reader.wrong("ramp", *reader.given("ramp"), "irregular waves do not begin at rest; give a time above 0 s");
  }
  if (maker.height > highest_over_depth * maker.depth && !reader.is_wrong("height") && !reader.is_wrong("depth")) {
    reader.wrong("height", *reader.given("height"),
                 fmt::format("such a wave breaks at the maker: give at most {} of the depth, {:.4g} m",
                             highest_over_depth, highest_over_depth * maker.depth));
  }
}

void check(const BodyTable& body, TableReader& reader) {
  if (body.walls.empty() && !reader.is_wrong("walls")) {
    reader.missing("walls", "a body needs a surface; give the names of its walls, as in [\"hull\"]");
  }
  const bool is_flat = reader.dimension() == 2;
  for (const std::string& way : body.free) {
    const bool is_turn = way.starts_with("rotation");
    if (way.find('z') != std::string::npos ? is_flat : is_turn && (way == "rotation") != is_flat) {
      reader.wrong("free", *reader.given("free"),
                   fmt::format("\"{}\" is none of the ways in {} dimensions; choose from {}", way, reader.dimension(),
                               is_flat ? "x, y, rotation" : "x, y, z, rotation_x, rotation_y, rotation_z"));
      return;
    }
  }
  const bool turns = std::ranges::any_of(body.free, [](const std::string& way) { return way.starts_with("rotation"); });
  const std::size_t needed = is_flat ? 1 : 3;
  if (reader.is_wrong("inertia") || reader.is_wrong("free")) return;
  if (body.inertia.empty()) {
    if (turns) {
      reader.missing("inertia",
                     fmt::format("a body that is free to turn needs its moment{} of inertia; give {}, or leave the "
                                 "rotation out of `free`",
                                 is_flat ? "" : "s", is_flat ? "[I]" : "[Ixx, Iyy, Izz]"));
    }
  } else if (body.inertia.size() != needed ||
             std::ranges::any_of(body.inertia, [](double moment) { return moment <= 0.0; })) {
    reader.wrong(
        "inertia", *reader.given("inertia"),
        fmt::format("give {} above 0 in {} dimensions", is_flat ? "one number" : "three numbers", reader.dimension()));
  }
}

void check(const MooringTable& mooring, TableReader& reader) {
  if (mooring.length == 0.0 && !mooring.at.empty() && mooring.at == mooring.anchor && !reader.is_wrong("anchor")) {
    reader.wrong("anchor", *reader.given("anchor"),
                 "is where the line is fastened to the body, so it has no direction; give another place");
  }
}

void check(const DampingTable& damping, TableReader& reader) {
  check_box(damping.min, damping.max, reader);
  if (const toml::node* node = reader.given("towards");
      node != nullptr && reader.dimension() == 2 && damping.towards >= AxisDirection::minus_z) {
    reader.wrong("towards", *node, "a case of two dimensions has no z; give a direction in x or y");
  }
}

void check(const GateTable& gate, TableReader& reader) {
  check_plate(gate.from, gate.to, gate.side, "a gate", reader);
  if (gate.motion == GateMotion::falling_weight && gate.weight > 0.0 && gate.weight <= gate.gate_mass &&
      !reader.is_wrong("weight") && !reader.is_wrong("gate_mass")) {
    reader.wrong("weight", *reader.given("weight"),
                 fmt::format("does not lift a gate of {} kg; give a weight above gate_mass", gate.gate_mass));
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

/// A run begins at t = 0. That the series lasts to its end is checked when the end has been read.
void require_start(const TimeSeries& series) {
  if (series.time.front() <= 0.0) return;
  throw InputError(fmt::format("{}:{}: begins at t = {:.9g} s, but the motion begins at 0; add a line for t = 0",
                               series.file, series.line.front(), series.time.front()));
}

/// A series that is too short for the run is found by the room checks, when the end of the run is known.
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

void read_linked_files(FluidTable& fluid, TableReader& reader) {
  if (fluid.shape != BlockShape::mesh || reader.is_wrong("shape")) return;
  read_linked("file", reader, [&] { keep_linked(fluid.file, fluid.checksum, "checksum", reader); });
}

void read_linked_files(WallTable& wall, TableReader& reader) {
  if (!wall.points_file.empty() && wall.points.empty() && !reader.is_wrong("shape")) {
    read_linked("points_file", reader, [&] {
      wall.points = read_points_file(reader.linked(wall.points_file));
      const std::size_t least = least_corners(wall.shape, reader.dimension());
      if (wall.points.size() < least) {
        throw InputError(fmt::format("has too few points for shape = \"{}\": {}; give at least {}", name_of(wall.shape),
                                     wall.points.size(), least));
      }
      wall.points_file.clear();
    });
  }
  const bool is_mesh = wall.shape == WallShape::mesh || (wall.shape == WallShape::plate && !wall.file.empty());
  if (is_mesh && !reader.is_wrong("shape")) {
    read_linked("file", reader, [&] { keep_linked(wall.file, wall.checksum, "checksum", reader); });
  }
  if (wall.motion.empty()) return;
  read_linked("motion", reader, [&] {
    constexpr std::array<SeriesColumn, 4> columns{{{"x"}, {"y"}, {"z"}, {"angle", Measure::angle}}};
    keep_linked(wall.motion, wall.motion_checksum, "motion_checksum", reader);
    wall.series = read_time_series(wall.motion, columns);
    require_start(wall.series);
    if (reader.dimension() == 2 && !wall.series.columns[2].empty()) {
      throw InputError(fmt::format("{} has a column z, but case.dimension = 2; remove it", wall.motion));
    }
  });
  if (reader.dimension() == 3 && !reader.is_wrong("motion") && !wall.series.columns[3].empty()) {
    check_turning_in_3d(wall, "motion", reader);
  }
}

void read_linked_files(GateTable& gate, TableReader& reader) {
  if (gate.motion != GateMotion::file || gate.file.empty()) return;
  read_linked("file", reader, [&] {
    constexpr std::array<SeriesColumn, 1> columns{{{"way"}}};
    keep_linked(gate.file, gate.checksum, "checksum", reader);
    gate.series = read_time_series(gate.file, columns);
    require_start(gate.series);
  });
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
  if (inlet.reserve > 0.0 && inlet.water_from.empty() && !reader.is_wrong("reserve")) {
    reader.wrong("reserve", *reader.given("reserve"),
                 "is water that waits to circulate; say with water_from which outlet's water enters, or remove it");
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
    const bool are_needed = probe.type == ProbeType::profile;
    if (probe.times.empty() ? are_needed : probe.times.front() < 0.0 || !is_rising) {
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
    } else if (need == KeyNeed::needed && node->is_string() && node->as_string()->get().empty()) {
      reader.wrong(info.key, *node, fmt::format("is empty, and {} needs it: {}", choice, info.doc));
    } else if (need == KeyNeed::unused && node != nullptr) {
      reader.wrong(
          info.key, *node,
          fmt::format("is not used with {}; remove it (it goes with {})", choice, key_use_text(table, info.key)));
    }
  }
}

}  // namespace tailwater
