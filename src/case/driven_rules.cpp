// Rules for moving parts: gates, wave makers, bodies and their moorings; and for zones of damping and of finer
// particles.
#include <fmt/format.h>

#include <algorithm>

#include "case/key_rules.h"
#include "case/table_rules.h"

namespace tailwater {

namespace {

/// Checks that `from` and `to` span a flat axis-parallel plate with that side; `what` is the name of the plate in
/// messages.
void check_plate(const Coordinates& from, const Coordinates& to, AxisDirection side, std::string_view what,
                 TableReader& reader) {
  if (from.size() != to.size() || reader.is_wrong("from") || reader.is_wrong("to") || from.empty()) return;
  const auto axis = static_cast<std::size_t>(side) / 2;
  std::string flat;
  for (std::size_t d = 0; d < from.size(); ++d) {
    if (from[d] == to[d]) flat += "xyz"[d];
  }
  if (flat.size() != 1) {
    reader.wrong("plate-corners", "to",
                 "differs from `from` in {} coordinates, but {} is a flat {}: give two points that have exactly one "
                 "coordinate in common",
                 from.size() - flat.size(), what,
                 from.size() == 2 ? "upright or level segment" : "axis-parallel rectangle");
  } else if (axis >= from.size() || flat[0] != "xyz"[axis]) {
    const std::string message = fmt::format(
        "the plane through from and to is normal to {}, so its sides are \"-{}\" and \"+{}\"; give one of them", flat,
        flat, flat);
    if (reader.given("side") != nullptr) {
      reader.wrong("plate-side", "side", message);
    } else {
      reader.missing("plate-side", "side", message);
    }
  }
}

/// No solitary wave is higher than this fraction of the depth (McCowan 1894), nor is any periodic one.
constexpr double highest_over_depth = 0.78;

/// Keys that makers and zones share.
void check_waves(const WaveKeys& waves, double depth, std::string_view place, TableReader& reader) {
  const bool is_periodic = has_period(waves.waves);
  if (is_periodic && waves.period == 0.0 && reader.given("period") != nullptr && !reader.is_wrong("period")) {
    reader.wrong("wave-period-missing", "period", "waves need a period; give a number above 0 in s");
  }
  if (is_periodic && waves.waves != WaveKind::regular && waves.ramp == 0.0 && reader.given("ramp") != nullptr &&
      !reader.is_wrong("ramp")) {
    reader.wrong("wave-ramp-missing", "ramp", "{} waves need a ramp to begin from rest; give a time above 0 s",
                 waves.waves == WaveKind::focused ? "focused" : "irregular");
  }
  if (waves.waves == WaveKind::focused && !reader.is_wrong("focus") &&
      (waves.focus.size() != 2 || waves.focus[1] <= 0.0)) {
    reader.wrong("wave-focus", "focus", "give two numbers, as in [3, 10]: a distance in m and a time above 0 in s");
  }
  if (waves.height > highest_over_depth * depth && !reader.is_wrong("height") && !reader.is_wrong("depth")) {
    reader.wrong("wave-too-high", "height", "such a wave breaks at the {}: give at most {} of the depth, {:.4g} m",
                 place, highest_over_depth, highest_over_depth * depth);
  }
}

}  // namespace

void check(const WaveMakerTable& maker, TableReader& reader) {
  check_plate(maker.from, maker.to, maker.side, "a wave maker", reader);
  if (maker.waves == WaveKind::none && maker.absorption == Absorption::none && !reader.is_wrong("absorption")) {
    reader.missing("maker-without-waves", "absorption",
                   "without waves or absorption the plate would rest; give waves, or absorption = \"active\"");
  }
  const bool is_long = maker.waves == WaveKind::solitary || maker.waves == WaveKind::n_wave;
  if (maker.type == MakerType::flap && is_long && !reader.is_wrong("type")) {
    reader.wrong("flap-long-wave", "type",
                 "such a long wave moves the water evenly over the depth, and a flap does not; use a piston");
  }
  check_waves(maker, maker.depth, "maker", reader);
}

/// Checks numbers of a body for all its degrees of freedom, free or not.
void check_numbers_of_freedoms(const std::vector<double>& numbers, std::string_view key, TableReader& reader) {
  const std::size_t needed = reader.dimension() == 2 ? 3 : 6;
  if (numbers.empty() || reader.is_wrong(key)) return;
  if (numbers.size() == needed && std::ranges::none_of(numbers, [](double number) { return number < 0.0; })) return;
  reader.wrong("body-numbers", key, "give {} numbers of at least 0, for {}", needed,
               needed == 3 ? "x, y, rotation" : "x, y, z, rotation_x, rotation_y, rotation_z");
}

void check(const BodyTable& body, TableReader& reader) {
  if (body.walls.empty() && !reader.is_wrong("walls")) {
    reader.missing("body-without-walls", "walls",
                   "a body needs a surface; give the names of its walls, as in [\"hull\"]");
  }
  if (reader.dimension() == 0) return;  // the names of the free motions depend on it
  check_numbers_of_freedoms(body.springs, "springs", reader);
  check_numbers_of_freedoms(body.damping, "damping", reader);
  check_numbers_of_freedoms(body.quadratic_damping, "quadratic_damping", reader);
  check_numbers_of_freedoms(body.extra_mass, "extra_mass", reader);
  const bool is_flat = reader.dimension() == 2;
  for (const std::string& degree : body.free) {
    const bool is_turn = degree.starts_with("rotation");
    if (degree.find('z') != std::string::npos ? is_flat : is_turn && (degree == "rotation") != is_flat) {
      reader.wrong("body-freedom-unknown", "free", "\"{}\" is not a degree of freedom in {} dimensions; choose from {}",
                   degree, reader.dimension(),
                   is_flat ? "x, y, rotation" : "x, y, z, rotation_x, rotation_y, rotation_z");
      return;
    }
  }
  const bool turns =
      std::ranges::any_of(body.free, [](const std::string& degree) { return degree.starts_with("rotation"); });
  const std::size_t needed = is_flat ? 1 : 3;
  if (reader.is_wrong("inertia") || reader.is_wrong("free")) return;
  if (body.inertia.empty()) {
    if (turns) {
      reader.missing(
          "inertia-missing", "inertia",
          fmt::format(
              "a body that is free to turn needs its moment{} of inertia; give {}, or leave the rotation out of `free`",
              is_flat ? "" : "s", is_flat ? "[I]" : "[Ixx, Iyy, Izz]"));
    }
  } else if (body.inertia.size() != needed ||
             std::ranges::any_of(body.inertia, [](double moment) { return moment <= 0.0; })) {
    reader.wrong("inertia-numbers", "inertia", "give {} above 0 in {} dimensions",
                 is_flat ? "one number" : "three numbers", reader.dimension());
  }
}

void check(const MooringTable& mooring, TableReader& reader) {
  if (!reader.is_wrong("body")) {
    const std::vector<std::string>& bodies = mooring.bodies;
    if (bodies.empty()) {
      reader.missing("mooring-without-body", "body", "a mooring holds a body; give its name");
    } else if (bodies.size() > 2) {
      reader.wrong("mooring-of-three-bodies", "body",
                   "a line has two ends; name one body, or the two that it connects");
    }
  }
  if (mooring.stiffness == 0.0 && (mooring.damping == 0.0 || mooring.length > 0.0) && !reader.is_wrong("stiffness")) {
    reader.wrong(
        "mooring-without-stiffness", "stiffness",
        "a line without stiffness is a damper, which needs damping above 0; give damping, and remove the length");
  }
  if (mooring.length == 0.0 && !mooring.at.empty() && mooring.at == mooring.anchor && !reader.is_wrong("anchor")) {
    reader.wrong("mooring-without-length", "anchor",
                 "is the same point as at, so the line has no direction; give another point");
  }
}

void check(const DampingTable& damping, TableReader& reader) {
  check_box(damping.min, damping.max, reader);
  if (const toml::node* node = reader.given("towards");
      node != nullptr && reader.dimension() == 2 && damping.towards >= AxisDirection::minus_z) {
    reader.wrong("direction-in-2d", "towards", "a 2D case has no z; give a direction in x or y");
  }
  if (reader.dimension() == 2 && damping.direction != 0.0 && !reader.is_wrong("direction")) {
    reader.wrong("wave-direction-in-2d", "direction",
                 "waves of a case of two dimensions have one direction; leave it out");
  }
  if (reader.dimension() == 2 && damping.spreading != 0.0 && !reader.is_wrong("spreading")) {
    reader.wrong("wave-direction-in-2d", "spreading",
                 "waves of a case of two dimensions have one direction; leave it out");
  }
  if (damping.waves != WaveKind::none && !has_period(damping.waves) && !reader.is_wrong("waves")) {
    reader.wrong("damping-waves", "waves", "relaxation zones do not make solitary waves or N-waves; use a piston");
  } else if (damping.waves != WaveKind::none) {
    check_waves(damping, damping.depth, "zone", reader);
  }
}

void check(const RefinementTable& zone, TableReader& reader) {
  check_box(zone.min, zone.max, reader);
  check_corner_count(zone.points, 3, reader);
  if (zone.shape == ZoneShape::walls && zone.walls.empty() && reader.given("walls") != nullptr &&
      !reader.is_wrong("walls")) {
    reader.wrong("zone-names-no-wall", "walls", "names no wall; give the names of walls, as in [\"pier\"]");
  }
}

void check(const GateTable& gate, TableReader& reader) { check_plate(gate.from, gate.to, gate.side, "a gate", reader); }

}  // namespace tailwater
