// The contents of a case file: one struct per table, one `describe` per struct. `describe` declares every key once: its
// name, default (the member's initialiser), unit, range and one line of documentation. The reader, the effective case
// written beside the results, `tailwater run --help-case` and docs/reference/case-file.md are all generated from it, so
// they cannot disagree.
//
// All numbers are SI. Lengths and other numbers may be written in the file as expressions of named parameters
// ("2*H"); the structs hold the values.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "case/choices.h"
#include "case/sources.h"
#include "case_files/coordinates.h"
#include "case_files/time_series.h"

namespace tailwater {

/// Default name of a block of fluid, a wall, an inlet or an outlet: fluid1, fluid2, ..., wall1, ...; `index` counts
/// from 0.
inline std::string default_name(const std::string& table, std::size_t index) {
  return table + std::to_string(index + 1);
}

/// Names of the coordinates in expressions that are evaluated for each particle; in 2D the first two.
inline constexpr std::array<std::string_view, 3> position_names{"x", "y", "z"};

/// Name of the time in expressions that are evaluated at each step.
inline constexpr std::array<std::string_view, 1> time_name{"t"};

/// Name of the height above an open end's lowest point, over the depth of the water, in profiles of velocity.
inline constexpr std::array<std::string_view, 1> height_name{"s"};

/// Names of the time and of the discharge through an open end, in expressions of its level. An expression that uses the
/// latter is rejected if a parameter has its name.
inline constexpr std::array<std::string_view, 2> level_names{"t", "q"};

/// Variables of an expression, besides the named numbers.
enum class Variables { position, time, height, level };

/// A number, or an expression that varies in space or time.
using Varying = std::variant<double, std::string>;

/// A vector that may vary, one component per dimension.
using VectorField = std::vector<Varying>;

/// The values a number may take. Bounds are inclusive unless `above`/`below` made them exclusive.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_is_excluded = false;
  bool high_is_excluded = false;

  static constexpr Range any() { return {}; }
  static constexpr Range above(double low) { return {.low = low, .low_is_excluded = true}; }
  static constexpr Range at_least(double low) { return {.low = low}; }
  static constexpr Range between(double low, double high) { return {.low = low, .high = high}; }
  static constexpr Range open_between(double low, double high) {
    return {.low = low, .high = high, .low_is_excluded = true, .high_is_excluded = true};
  }
  static constexpr Range above_up_to(double low, double high) {
    return {.low = low, .high = high, .low_is_excluded = true};
  }
  constexpr bool contains(double value) const {
    return (low_is_excluded ? value > low : value >= low) && (high_is_excluded ? value < high : value <= high);
  }
};

/// Whether a key must be given. A `written` key is given only by a run, in the case that it writes beside its results.
enum class Presence { optional, required, written };

/// Version of the case-file format that this program writes; it reads all earlier ones.
inline constexpr int case_format = 1;

struct CaseTable {
  int format = case_format;
  std::string title = "untitled";
  int dimension = 2;
  std::string datum;
  std::string crs;

  bool operator==(const CaseTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.integer("format", self.format, "", Range::at_least(1),
              "Version of the case-file format; a program rejects a version that is newer than its own");
    v.text("title", self.title, "Title of the case in summaries and reports, one line");
    v.integer("dimension", self.dimension, "", Range::between(2, 3), "Number of space dimensions");
    v.text("datum", self.datum, "Vertical datum of heights and levels, such as \"DHHN2016 - 84.2 m\", for reports");
    v.text("crs", self.crs,
           "Coordinate reference system and offset of horizontal coordinates, such as \"EPSG:25832 - (512000, "
           "5401000)\", for "
           "reports");
  }
};

struct PhysicsTable {
  double density = 1000.0;
  double viscosity = 1e-6;
  Coordinates gravity = {0.0, -9.81};
  double tension = 0.0;
  double channel_width = 0.0;
  double channel_roughness = 0.0;

  bool operator==(const PhysicsTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.number("density", self.density, "kg/m^3", Range::above(0.0), "Density of the fluid");
    v.number("viscosity", self.viscosity, "m^2/s", Range::at_least(0.0), "Kinematic viscosity of the fluid, nu_0");
    v.coordinates("gravity", self.gravity, "m/s^2",
                  "Acceleration of gravity, one number per dimension (default in 3D: 0, 0, -9.81)");
    v.number("tension", self.tension, "Pa", Range::at_least(0.0),
             "Pressure below that of the atmosphere up to which walls hold water where no air is near, as in a siphon, "
             "at most 1e5 for cold water; 0: water separates from walls");
    v.number("channel_width", self.channel_width, "m", Range::at_least(0.0),
             "2D: width of the channel between two side walls, whose friction acts on all the water; 0: no side walls");
    v.number("channel_roughness", self.channel_roughness, "m", Range::at_least(0.0),
             "2D: equivalent sand roughness k_s of these side walls; 0: smooth");
  }
};

/// A liquid that is not water, with its own density and law of viscosity (rheology.h).
struct LiquidTable {
  std::string name;
  double density = 1000.0;
  Rheology rheology = Rheology::newtonian;
  double viscosity = 0.0;
  double yield_stress = 0.0;
  double consistency = 0.0;
  double index = 1.0;
  double high_shear_viscosity = 0.0;
  double relaxation_time = 0.0;
  double rest_viscosity = 0.0;

  bool operator==(const LiquidTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.text("name", self.name, "Name by which a [[fluid]] takes it (default: liquid1, liquid2, ...)");
    v.number("density", self.density, "kg/m^3", Range::above(0.0), "Density");
    v.choice("rheology", self.rheology,
             "Law of the shear stress t for the shear rate s: viscosity s (newtonian), consistency s^index "
             "(power-law), yield_stress + viscosity s (bingham), yield_stress + consistency s^index "
             "(herschel-bulkley), or a viscosity that falls from one value at rest to another (carreau) "
             "(docs/theory/rheology.md)");
    v.number("viscosity", self.viscosity, "Pa s", Range::above(0.0),
             "Dynamic viscosity; the plastic viscosity of a Bingham liquid, and the viscosity at rest of a Carreau "
             "liquid");
    v.number("yield_stress", self.yield_stress, "Pa", Range::at_least(0.0),
             "Shear stress below which the liquid does not flow");
    v.number("consistency", self.consistency, "Pa s^n", Range::above(0.0), "Factor of the power law; n is the index");
    v.number("index", self.index, "", Range::above_up_to(0.0, 3.0),
             "Exponent of the power law: below 1 the liquid thins with the shear rate, above 1 it thickens");
    v.number("high_shear_viscosity", self.high_shear_viscosity, "Pa s", Range::at_least(0.0),
             "Dynamic viscosity of a Carreau liquid at high shear rates");
    v.number("relaxation_time", self.relaxation_time, "s", Range::above(0.0),
             "Time of a Carreau liquid; its viscosity falls beyond the shear rate of 1 over this time");
    v.number("rest_viscosity", self.rest_viscosity, "Pa s", Range::above(0.0),
             "Largest viscosity that the yield stress, or thinning, gives the liquid at rest, with which it creeps "
             "below the yield stress (default: 1000 times the yield stress over the shear rate at which it is half of "
             "the stress, for a Bingham liquid 1000 times its viscosity; without yield stress 1000 times the "
             "consistency, at least 1000 Pa s)");
  }
};

struct ParticlesTable {
  double spacing = 0.0;
  double jitter = 0.0;
  int seed = 1;

  bool operator==(const ParticlesTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.number("spacing", self.spacing, "m", Range::above(0.0),
             "Distance dx between neighbouring particles of the initial lattice", Presence::required);
    v.number("jitter", self.jitter, "dx", Range::between(0.0, 0.4),
             "Largest random displacement of a fluid particle at the start, in each coordinate, as a fraction of dx");
    v.integer("seed", self.seed, "", Range::at_least(0), "Seed of the random displacements");
  }
};

/// Air enclosed by water and walls. Air that is connected to the atmosphere has the pressure 0 of the water's
/// equations.
struct AirTable {
  AirPockets pockets = AirPockets::none;
  double pressure = 101325.0;

  bool operator==(const AirTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.choice("pockets", self.pockets,
             "Model of enclosed air: none, with the pressure of open air; or a gas whose pressure follows from its "
             "volume without heat exchange (adiabatic) or at constant temperature (isothermal) (docs/theory/air.md)");
    v.number("pressure", self.pressure, "Pa", Range::above(0.0), "Absolute pressure of the atmosphere");
  }
};

/// An enclosed space with an initial air pressure that differs from the atmosphere's.
struct PocketTable {
  std::string name;  ///< no key: pocket1, pocket2, ...
  Coordinates at;
  double overpressure = 0.0;

  bool operator==(const PocketTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.coordinates("at", self.at, "m", "Point in the air of the space at the start", Presence::required);
    v.number("overpressure", self.overpressure, "Pa", Range::any(),
             "Initial gauge pressure of this air: above 0 it exceeds the atmospheric pressure", Presence::required);
  }
};

/// An opening through which the air of an enclosed space passes, but no water.
struct VentTable {
  std::string name;  ///< no key: vent1, vent2, ...
  Coordinates at;
  double area = 0.0;
  double loss = 2.7;

  bool operator==(const VentTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.coordinates("at", self.at, "m",
                  "Position of the opening: a point in the air of the space, or on the wall around it. While water "
                  "covers it, no air passes",
                  Presence::required);
    v.number("area", self.area, "m^2", Range::above(0.0), "Area of the opening; in 2D m^2 per metre of width",
             Presence::required);
    v.number("loss", self.loss, "", Range::above(0.0),
             "Loss coefficient zeta: pressure difference over the dynamic pressure rho u^2/2 of the mean velocity in "
             "the opening (2.7: a sharp-edged hole; 1.5: a short pipe)");
  }
};

/// Periodic directions of the domain; an empty range: not periodic.
struct DomainTable {
  std::vector<double> periodic_x;
  std::vector<double> periodic_y;
  std::vector<double> periodic_z;

  bool operator==(const DomainTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.numbers("periodic_x", self.periodic_x, "m",
              "[low, high]: periodic range of x; water that leaves at one end enters at the other");
    v.numbers("periodic_y", self.periodic_y, "m", "[low, high]: periodic range of y");
    v.numbers("periodic_z", self.periodic_z, "m", "[low, high]: periodic range of z");
  }
};

/// A mesh from a file, and its placement in the case.
struct PlacedFile {
  std::string file;
  std::string checksum;
  double scale = 1.0;
  Coordinates rotate;
  Coordinates translate;

  bool operator==(const PlacedFile&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.text("file", self.file, "STL, OBJ or PLY file of a mesh, relative to the case file");
    v.text("checksum", self.checksum,
           "CRC-32 of the mesh file, which a run writes into its case; a file with another one is refused",
           Presence::written);
    v.number("scale", self.scale, "", Range::above(0.0), "Length of the mesh file's unit in m: 0.001 for millimetres");
    v.coordinates("rotate", self.rotate, "deg",
                  "Angles by which the mesh is turned after scaling: about the x, the y and the z axis, in this order, "
                  "counter-clockwise as seen against the axis");
    v.coordinates("translate", self.translate, "m", "Displacement of the mesh after it has been turned");
  }
};

struct FluidTable : PlacedFile {
  std::string name;
  BlockShape shape = BlockShape::box;
  Coordinates min;
  Coordinates max;
  std::vector<Coordinates> points;
  Coordinates seed;
  double level = 0.0;
  VectorField velocity;
  std::string liquid;

  bool operator==(const FluidTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.text("name", self.name, "Name used in messages (default: fluid1, fluid2, ...)");
    v.choice("shape", self.shape,
             "Shape of the block: an axis-parallel box, a polygon (2D), the inside of a closed mesh from a file (3D), "
             "or the region that water from a seed point fills up to a level (fill). The volume of bodies in the block "
             "is left out");
    v.coordinates("min", self.min, "m", "Lowest corner of a box");
    v.coordinates("max", self.max, "m", "Highest corner of a box");
    v.points("points", self.points, "m", "Corners of a polygon, in order; the last is joined to the first");
    v.coordinates("seed", self.seed, "m", "Point in the water of a fill");
    v.number("level", self.level, "m", {}, "Height of the surface of a fill: its y in 2D, its z in 3D");
    PlacedFile::describe(self, v);
    v.field("velocity", self.velocity, Variables::position, "m/s",
            "Initial velocity (default: at rest); expressions may use the particle's coordinates x, y, z");
    v.text("liquid", self.liquid,
           "Name of the [[liquid]] of the block; blocks of several liquids do not mix (docs/theory/liquids.md) "
           "(default: water, with the density and viscosity of [physics])");
  }
};

/// The table that determines the motion of a wall: its own, or that of a gate, a wave maker or a floating body.
struct Drive {
  enum class By { wall, gate, wave_maker, body };
  By by = By::wall;
  std::size_t index = 0;  ///< of the gate, wave maker or body

  bool operator==(const Drive&) const = default;
};

struct WallTable : PlacedFile {
  std::string name;
  WallShape shape = WallShape::polyline;
  std::vector<Coordinates> points;
  std::string points_file;
  Coordinates min;
  Coordinates max;
  std::vector<std::string> open;
  FluidSide fluid_side = FluidSide::left;
  Slip slip = Slip::free;
  double friction = 0.5;
  double roughness = 0.0;
  double manning = 0.0;
  VectorField displacement;
  Varying rotation = 0.0;
  std::string motion;
  std::string motion_checksum;
  Coordinates pivot;
  Coordinates axis;

  TimeSeries series;  ///< contents of the file `motion`: t, x, y, z, angle
  Drive drive;

  bool operator==(const WallTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.text("name", self.name, "Name used in messages and by probes (default: wall1, wall2, ...)");
    v.choice("shape", self.shape,
             "polyline: open chain of segments (2D); polygon: closed chain (2D); box: faces of a box; mesh: triangles "
             "from a file (3D); plate: a wall without thickness that has water on both sides, an open chain of "
             "segments (2D), a rectangle or the open mesh of a file (3D)");
    v.points("points", self.points, "m", "Corners of a polyline, polygon or plate, in order");
    v.text("points_file", self.points_file,
           "Instead of points: CSV file with the points, relative to the case file (docs/theory/geometry.md); a run "
           "stores the points in its case");
    v.coordinates("min", self.min, "m", "Lowest corner of a box");
    v.coordinates("max", self.max, "m", "Highest corner of a box");
    v.texts("open", self.open, box_face_names, "Faces of a box that are left open");
    PlacedFile::describe(self, v);
    v.choice(
        "fluid_side", self.fluid_side,
        "Side on which the water is: left or right of a polyline, in the direction of its points; inside or outside a "
        "polygon, box or closed mesh; above, below, front or back of an open mesh, where the corners of triangles run "
        "counter-clockwise as seen from the front (default: left; inside; required for a mesh; not for a plate)");
    v.choice("slip", self.slip,
             "Wall friction: none (free), that of the no-slip condition (no-slip), a fraction of that of a smooth wall "
             "(partial), or that of the no-slip condition up to a fraction of the normal stress, along which a thick "
             "liquid slides (coulomb)");
    v.number("friction", self.friction, "", Range::between(0.0, 1.0),
             "With slip = \"partial\": fraction of the no-slip wall stress; with slip = \"coulomb\": coefficient of "
             "friction, the largest shear stress over the normal stress");
    v.number("roughness", self.roughness, "m", Range::at_least(0.0),
             "With slip = \"no-slip\": equivalent sand roughness k_s of the wall; 0: smooth");
    v.number("manning", self.manning, "s/m^(1/3)", Range::at_least(0.0),
             "Instead of roughness: Manning's n, for which k_s = (8.1 sqrt(g) n)^6 after Strickler (g = 9.81 m/s^2)");
    v.field("displacement", self.displacement, Variables::time, "m",
            "Displacement of the wall from its drawn position (default: none); expressions may use the time t");
    v.varying("rotation", self.rotation, Variables::time, "rad",
              "Rotation of the wall about its pivot, counter-clockwise as seen against the axis; the displacement is "
              "added to it");
    v.text("motion", self.motion,
           "Instead of displacement and rotation: CSV file with both over time, relative to the case file, with a line "
           "that names the columns, as in \"t [s], x [mm], angle [deg]\" (docs/theory/moving_walls.md)");
    v.text("motion_checksum", self.motion_checksum,
           "CRC-32 of the motion's file, which a run writes into its case; a file with another one is refused",
           Presence::written);
    v.coordinates("pivot", self.pivot, "m", "Point about which the wall rotates (default: the origin)");
    v.coordinates("axis", self.axis, "", "Direction of the axis through the pivot about which a box rotates (3D)");
  }
};

/// A flat plate that is pulled out of the water. After the case has been read, it is one of the walls.
struct GateTable {
  std::string name;
  Coordinates from;
  Coordinates to;
  AxisDirection side = AxisDirection::plus_x;
  double thickness = 0.0;
  double start = 0.0;
  GateMotion motion = GateMotion::speed;
  double speed = 0.0;
  double acceleration = 0.0;
  std::string file;
  std::string checksum;
  double travel = 0.0;

  TimeSeries series;  ///< contents of the file: t, displacement

  bool operator==(const GateTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.text("name", self.name, "Name used in messages and by probes (default: gate1, gate2, ...)");
    v.coordinates("from", self.from, "m",
                  "Foot of the gate's face on the water's side: one end of an axis-parallel segment (2D), a corner of "
                  "a flat axis-parallel rectangle (3D)",
                  Presence::required);
    v.coordinates("to", self.to, "m", "Top of that face, above the water: the other end (2D), the opposite corner (3D)",
                  Presence::required);
    v.choice("side", self.side, "Side of that face on which the gate's thickness lies: away from the deep water");
    v.number("thickness", self.thickness, "m", Range::at_least(0.0),
             "Thickness of the gate; 0: none, as a plate (4 dx with a published formulation)");
    v.number("start", self.start, "s", Range::at_least(0.0), "Time at which the gate begins to move");
    v.choice("motion", self.motion,
             "Upward motion of the gate, against gravity: at constant speed, with constant acceleration, or with the "
             "displacement of a file; its seal has no friction");
    v.number("speed", self.speed, "m/s", Range::above(0.0), "Speed of the gate");
    v.number("acceleration", self.acceleration, "m/s^2", Range::above(0.0), "Acceleration of the gate");
    v.text("file", self.file,
           "CSV file of the gate's displacement over the time since `start`, relative to the case file, with a line "
           "that names the columns, as in \"t [s], displacement [mm]\"");
    v.text("checksum", self.checksum,
           "CRC-32 of the file, which a run writes into its case; a file with another one is refused",
           Presence::written);
    v.number("travel", self.travel, "m", Range::at_least(0.0),
             "Displacement after which the gate stops; 0: its own height");
  }
};

/// The waves of a wave maker or of a zone.
struct WaveKeys {
  WaveKind waves = WaveKind::regular;
  double height = 0.0;
  double period = 0.0;
  double peak_enhancement = 3.3;
  int seed = 1;
  std::vector<double> focus;
  double start = 0.0;
  double ramp = 0.0;

  bool operator==(const WaveKeys&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.choice(
        "waves", self.waves,
        "regular: waves of one period; solitary: one wave of Rayleigh's shape; n-wave: one long wave with a trough "
        "ahead of its crest; jonswap: irregular waves with a JONSWAP spectrum; focused: a group with this "
        "spectrum whose crests meet at one place; none: the plate or zone only absorbs");
    v.number("height", self.height, "m", Range::above(0.0),
             "Height of a regular or solitary wave; of the crest of an N-wave, as high as its trough is deep; "
             "significant height Hm0 of irregular ones; twice the crest of a focused group by linear theory");
    v.number("period", self.period, "s", Range::at_least(0.0),
             "Period of regular waves, of the peak of irregular ones; with waves = \"none\" that of the waves to be "
             "absorbed best (0: long waves at a plate, those of the wave maker in a zone)");
    v.number("peak_enhancement", self.peak_enhancement, "", Range::at_least(1.0),
             "gamma of the JONSWAP spectrum; 1: Pierson-Moskowitz");
    v.integer("seed", self.seed, "", Range::at_least(0), "Seed of the random phases and frequencies");
    v.numbers(
        "focus", self.focus, "",
        "[distance in m, time in s] at which the crests of a focused group meet: in front of the plate at rest or "
        "of the inner end of the zone, and after `start`");
    v.number("start", self.start, "s", Range::at_least(0.0), "Time at which the waves begin");
    v.number("ramp", self.ramp, "s", Range::at_least(0.0),
             "Time in which the waves grow to their full height; not for solitary waves (default: two periods)");
  }
};

/// A flat upright plate that makes or absorbs waves. After the case has been read, it is one of the walls.
struct WaveMakerTable : WaveKeys {
  std::string name;
  MakerType type = MakerType::piston;
  Coordinates from;
  Coordinates to;
  AxisDirection side = AxisDirection::minus_x;
  double depth = 0.0;
  Absorption absorption = Absorption::none;

  bool operator==(const WaveMakerTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.text("name", self.name, "Name used in messages (default: wave_maker1, wave_maker2, ...)");
    v.choice("type", self.type, "A piston, which stays upright, or a flap, which rotates about its foot on the bed");
    v.coordinates("from", self.from, "m",
                  "Foot of the plate on the bed: one end of an upright segment (2D), a corner of a flat axis-parallel "
                  "rectangle (3D)",
                  Presence::required);
    v.coordinates("to", self.to, "m", "Top of the plate, above the waves: the other end (2D), the opposite corner (3D)",
                  Presence::required);
    v.choice("side", self.side, "Side of the plate without water");
    v.number("depth", self.depth, "m", Range::above(0.0), "Depth of the still water at the plate", Presence::required);
    WaveKeys::describe(self, v);
    v.choice(
        "absorption", self.absorption,
        "active: the plate absorbs incoming waves, controlled by the elevation in front of it (docs/theory/waves.md)");
  }
};

/// Names of a body's degrees of freedom; in 2D "rotation" is about the only axis.
inline constexpr std::array<std::string_view, 7> freedom_names{"x",          "y",          "z",         "rotation",
                                                               "rotation_x", "rotation_y", "rotation_z"};

/// A rigid body that the water moves. After the case has been read, it drives its walls.
struct BodyTable {
  std::string name;
  std::vector<std::string> walls;
  double mass = 0.0;
  Coordinates centre;
  std::vector<double> inertia;
  std::vector<std::string> free;
  Coordinates velocity;
  std::vector<double> springs;
  std::vector<double> damping;
  std::vector<double> quadratic_damping;
  std::vector<double> extra_mass;

  bool operator==(const BodyTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.text("name", self.name, "Name used in messages and by moorings (default: body1, body2, ...)");
    v.texts("walls", self.walls, {},
            "Names of the walls that form the surface of the body, which is closed and has the water outside");
    v.number("mass", self.mass, "kg", Range::above(0.0), "Mass of the body; in 2D per metre of width",
             Presence::required);
    v.coordinates("centre", self.centre, "m", "Centre of mass of the body as drawn", Presence::required);
    v.numbers(
        "inertia", self.inertia, "kg m^2",
        "Moments of inertia about the centre: [I] in 2D, per metre of width; [Ixx, Iyy, Izz] in 3D, about axes along "
        "x, y and z in the drawn position, which must be the principal axes (required if the body can rotate)");
    v.texts("free", self.free, freedom_names, "Degrees of freedom (default: all; in 2D [\"x\", \"y\", \"rotation\"])");
    v.coordinates("velocity", self.velocity, "m/s", "Initial velocity of the body (default: at rest)");
    v.numbers("springs", self.springs, "N/m, N m/rad",
              "Stiffness of springs that return the body to its drawn position, for each of x, y, rotation (2D) or x, "
              "y, z, rotation_x, rotation_y, rotation_z (3D), as in [0, 0, 20]; in 2D per metre of width");
    v.numbers("damping", self.damping, "N s/m, N m s/rad",
              "Force against each velocity of the body, over that velocity: linear dampers, or a power take-off; in "
              "the order of `springs`");
    v.numbers("quadratic_damping", self.quadratic_damping, "N s^2/m^2, N m s^2/rad^2",
              "Force against each velocity of the body, over the square of that velocity; in the order of `springs`");
    v.numbers("extra_mass", self.extra_mass, "kg, kg m^2",
              "Mass that accelerates with the body, but has no weight; in the order of `springs`");
  }
};

/// A line that holds a body, or connects it to another.
struct MooringTable {
  std::string name;  ///< no key: mooring1, mooring2, ...
  std::vector<std::string> bodies;
  Coordinates at;
  Coordinates anchor;
  double stiffness = 0.0;
  double length = 0.0;
  double damping = 0.0;

  bool operator==(const MooringTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.texts("body", self.bodies, {},
            "Name of the body that the line holds, or names of the two bodies that it connects");
    v.coordinates("at", self.at, "m", "Fastening point on the first body as drawn", Presence::required);
    v.coordinates("anchor", self.anchor, "m",
                  "Other end of the line: a fixed point, or a point on the second body as drawn", Presence::required);
    v.number("stiffness", self.stiffness, "N/m", Range::at_least(0.0),
             "Force per elongation beyond the length of the line; 0: a damper alone, of length 0; in 2D per metre of "
             "width",
             Presence::required);
    v.number(
        "length", self.length, "m", Range::at_least(0.0),
        "Length of the slack line, which pulls only when it is longer and never pushes. 0: a spring that always pulls");
    v.number("damping", self.damping, "N s/m", Range::at_least(0.0),
             "Force per rate of elongation while the line is taut; in 2D per metre of width");
  }
};

/// A zone of the water in which the velocity is relaxed: to rest, so that waves decay, or to that of given waves.
struct DampingTable : WaveKeys {
  std::string name;  ///< no key: damping1, damping2, ...
  Coordinates min;
  Coordinates max;
  AxisDirection towards = AxisDirection::plus_x;
  double strength = 0.0;
  double depth = 0.0;
  double level = 0.0;
  double transport = 0.0;
  double direction = 0.0;
  double spreading = 0.0;

  DampingTable() { waves = WaveKind::none; }
  bool operator==(const DampingTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.coordinates("min", self.min, "m", "Lowest corner of the zone, an axis-parallel box", Presence::required);
    v.coordinates("max", self.max, "m", "Highest corner of the zone", Presence::required);
    v.choice("towards", self.towards,
             "Side of the zone at which it damps most; the damping grows from 0 at the opposite side, as the square of "
             "the distance. Waves of the zone leave through that opposite side");
    v.number(
        "strength", self.strength, "1/s", Range::at_least(0.0),
        "Rate at that side at which the velocity approaches rest, or that of the waves; 0: the rate with the least "
        "reflection at `period` (docs/theory/waves.md)");
    WaveKeys::describe(self, v);
    v.number("depth", self.depth, "m", Range::at_least(0.0),
             "Depth of the still water in the zone (0: that at the wave maker)");
    v.number("level", self.level, "m", {}, "Height of the still water's surface, from the origin of the case");
    v.number(
        "transport", self.transport, "m/s", {},
        "Discharge over depth, averaged over the waves: in their direction, away from the side `towards`; with waves = "
        "\"none\" in the direction `towards`. 0 where the case is closed");
    v.number("direction", self.direction, "degrees", Range::between(-75.0, 75.0),
             "3D: angle between the waves and the way out of the zone, positive towards the level axis across it. In "
             "a case that is periodic across, it is changed until whole waves fit into the period");
    v.number("spreading", self.spreading, "", Range::at_least(0.0),
             "3D: exponent s of cos^2s of half the angle from `direction`, the distribution of irregular waves over "
             "directions; 0: one direction");
  }
};

/// A zone in which particles are finer than elsewhere (refinement/spacing_field.h).
struct RefinementTable {
  std::string name;
  ZoneShape shape = ZoneShape::box;
  Coordinates min;
  Coordinates max;
  std::vector<Coordinates> points;
  std::vector<std::string> walls;
  double distance = 0.0;
  VectorField displacement;
  int level = 1;

  bool operator==(const RefinementTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.text("name", self.name, "Name in messages");
    v.choice("shape", self.shape,
             "Shape of the zone: an axis-parallel box, a polygon (in 3D in plan, at all heights), all places near the "
             "named walls, or all places above a depth below the initial surface");
    v.coordinates("min", self.min, "m",
                  "Lowest corner of a box; the spacing falls from the edge of a box or polygon inwards, over 4 dx per "
                  "level, except where the zone reaches to the outermost walls");
    v.coordinates("max", self.max, "m", "Highest corner of a box");
    v.points("points", self.points, "m", "Corners (x, y) of a polygon, in order; the last is joined to the first");
    v.texts("walls", self.walls, {},
            "Names of walls; the zone moves with walls that move as one, such as a gate or a floating body");
    v.number("distance", self.distance, "m", Range::above(0.0),
             "Distance from the walls, or depth below the highest water at the start, up to which the spacing is the "
             "finest; beyond, it grows over 4 dx per level");
    v.field("displacement", self.displacement, Variables::time, "m",
            "Displacement of the zone from its drawn place, for a zone that follows a bore or a wave (default: none); "
            "expressions may use the time t");
    v.integer("level", self.level, "", Range::between(1, 4), "The spacing inside is particles.spacing / 2^level");
  }
};

/// A region filled with stones or grains at rest. porous/porous_law.h has the laws of resistance.
struct PorousTable : PlacedFile {
  std::string name;
  RegionShape shape = RegionShape::box;
  Coordinates min;
  Coordinates max;
  std::vector<Coordinates> points;
  double porosity = 0.0;
  PorousResistance resistance = PorousResistance::van_gent;
  double grain_size = 0.0;
  double alpha = 1000.0;
  double beta = 1.1;
  double keulegan_carpenter = 0.0;
  double linear = 0.0;
  double quadratic = 0.0;
  double added_mass = 0.0;

  bool operator==(const PorousTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.text("name", self.name, "Name used in messages (default: porous1, porous2, ...)");
    v.choice("shape", self.shape,
             "Shape of the layer: an axis-parallel box, a polygon (2D), or the inside of a closed mesh from a file "
             "(3D); where layers overlap, the last one counts");
    v.coordinates("min", self.min, "m", "Lowest corner of a box");
    v.coordinates("max", self.max, "m", "Highest corner of a box");
    v.points("points", self.points, "m", "Corners of a polygon, in order; the last is joined to the first");
    PlacedFile::describe(self, v);
    v.number("porosity", self.porosity, "", Range::open_between(0.0, 1.0),
             "Fraction n of the layer's volume that water can fill", Presence::required);
    v.choice("resistance", self.resistance,
             "Law of the hydraulic gradient I = a v + b v |v| for the filter velocity v = n u: from the grain size "
             "after van Gent (1995) or Ergun (1952), or from given coefficients");
    v.number("grain_size", self.grain_size, "m", Range::above(0.0), "Median diameter D50 of the stones or grains");
    v.number("alpha", self.alpha, "", Range::at_least(0.0),
             "Coefficient of a = alpha (1-n)^2/n^3 nu/(g D50^2) (default with Ergun's law: 150)");
    v.number("beta", self.beta, "", Range::at_least(0.0),
             "Coefficient of b = beta (1 + 7.5/KC) (1-n)/n^3 1/(g D50) (default with Ergun's law: 1.75)");
    v.number("keulegan_carpenter", self.keulegan_carpenter, "", Range::at_least(0.0),
             "Keulegan-Carpenter number KC = V T/(n D50) of the waves in the layer, with the largest filter velocity V "
             "and the period T; 0: steady flow, without the term 7.5/KC");
    v.number("linear", self.linear, "s/m", Range::at_least(0.0),
             "Coefficient a; in Darcy's law 1/a is the permeability K in m/s");
    v.number("quadratic", self.quadratic, "s2/m2", Range::at_least(0.0), "Coefficient b");
    v.number("added_mass", self.added_mass, "", Range::at_least(0.0),
             "Added mass of the water over its mass (default after van Gent: 0.34 (1-n)/n)");
  }
};

template <class Self, class Visitor>
void describe_absorbing(Self& self, Visitor& v) {
  v.number("absorbing", self.absorbing, "", Range::between(0.0, 1.0),
           "With a level: 0 holds it at any instant and reflects waves; 1 holds it on average over the time in which a "
           "wave passes through the case and lets waves out. With 0.3 the waves of the start of a steady flow decay");
}

/// The section of an inlet or outlet: a segment in 2D; in 3D a rectangle, a polygon, a disc, or the region between the
/// walls of a plane.
struct Section {
  Coordinates from;
  Coordinates to;
  Coordinates direction;
  std::vector<Coordinates> polygon;
  Coordinates centre;
  double radius = 0.0;
  Coordinates through;

  std::vector<Coordinates> found;  ///< m; corners of the section of a point, once found (geometry/opening.h)

  bool operator==(const Section&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.coordinates("from", self.from, "m",
                  "Start of the opening, on the bed: one end of a segment (2D), a corner of a flat axis-parallel "
                  "rectangle (3D)");
    v.coordinates("to", self.to, "m",
                  "Other end of the segment, above the highest water to be expected (2D); the opposite corner (3D)");
    v.points("polygon", self.polygon, "m", "In 3D, instead of from and to: corners of a flat polygon, in order");
    v.coordinates("centre", self.centre, "m",
                  "In 3D, instead of from and to: centre of a disc at right angles to direction");
    v.number("radius", self.radius, "m", Range::at_least(0.0), "With centre: radius of the disc");
    v.coordinates(
        "through", self.through, "m",
        "In 3D, instead of from and to: a point of the opening, which is the region between the walls in the plane at "
        "right angles to direction. Where the walls are open above, it ends at the height of the point");
  }
};

struct InletTable : Section {
  std::string name;
  std::optional<Varying> discharge;
  std::optional<Varying> velocity;
  std::optional<Varying> level;
  double absorbing = 0.0;
  std::optional<Varying> profile;
  std::string file;
  std::string checksum;
  std::string water_from;
  double reserve = 0.0;

  TimeSeries series;  ///< contents of the file: t, discharge, velocity, level

  bool operator==(const InletTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.text("name", self.name, "Name used in messages and in summary.json (default: inlet1, inlet2, ...)");
    Section::describe(self, v);
    v.coordinates("direction", self.direction, "",
                  "Direction in which the water enters; with from and to an approximate one, which distinguishes the "
                  "two sides (default: +x)");
    v.varying("discharge", self.discharge, Variables::time, "m^3/s",
              "Discharge that enters; in 2D m^3/s per metre of width; below 0 it is taken out");
    v.varying("velocity", self.velocity, Variables::time, "m/s",
              "Mean velocity with which water enters, instead of a discharge");
    v.varying("level", self.level, Variables::level, "m",
              "Height of the water's surface beyond the inlet, as a coordinate; without a discharge and a velocity "
              "these follow from the flow; with one of them the flow must be supercritical, otherwise leave the level "
              "out");
    describe_absorbing(self, v);
    v.varying("profile", self.profile, Variables::height, "",
              "Shape of the velocity over the depth, of any size: an expression of s, which is 0 at the bed and 1 at "
              "the surface (default: uniform)");
    v.text("file", self.file,
           "Instead of discharge, velocity and level, or of some of them: CSV file of them over time, relative to the "
           "case file, with a line that names the columns, as in \"t [s], discharge [l/s]\"; in between it is smooth");
    v.text("checksum", self.checksum,
           "CRC-32 of the file, which a run writes into its case; a file with another one is refused",
           Presence::written);
    v.text("water_from", self.water_from,
           "Name of the outlet whose water circulates: only the outflow there enters here (default: new water enters)");
    v.number("reserve", self.reserve, "m^3", Range::at_least(0.0),
             "With water_from: volume of the water that waits to enter at the start; in 2D m^3 per metre of width");
  }
};

struct OutletTable : Section {
  std::string name;
  Beyond beyond = Beyond::channel;
  std::optional<Varying> level;
  double absorbing = 0.0;
  std::string file;
  std::string checksum;

  TimeSeries series;  ///< contents of the file: t, level

  bool operator==(const OutletTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.text("name", self.name, "Name used in messages and in summary.json (default: outlet1, outlet2, ...)");
    Section::describe(self, v);
    v.coordinates("direction", self.direction, "",
                  "Direction in which the water leaves; with from and to an approximate one, which distinguishes the "
                  "two sides (default: +x)");
    v.choice("beyond", self.beyond,
             "Without a level: a channel that continues, or air, as below a hole or a brink, which the water enters as "
             "a free jet");
    v.varying("level", self.level, Variables::level, "m",
              "Level of the tailwater, as a coordinate; water enters where the level inside is lower (default: given "
              "by beyond). An expression of q, the outgoing discharge in m^3/s (in 2D per metre of width), is a "
              "stage-discharge relation, such as 0.3 + 0.5*q^(2/3)");
    describe_absorbing(self, v);
    v.text("file", self.file,
           "Instead of level: CSV file of it over time, relative to the case file, with a line that names the columns, "
           "as in \"t [s], level [m]\"; in between it is smooth");
    v.text("checksum", self.checksum,
           "CRC-32 of the file, which a run writes into its case; a file with another one is refused",
           Presence::written);
  }
};

/// Whether water can enter through the outlet.
inline bool may_bring_water(const OutletTable& outlet) { return outlet.level || !outlet.file.empty(); }

struct TimeTable {
  double end = 0.0;
  double end_at_rest = 0.0;

  bool operator==(const TimeTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.number("end", self.end, "s", Range::above(0.0), "Simulated time at which the run ends", Presence::required);
    v.number("end_at_rest", self.end_at_rest, "m/s", Range::at_least(0.0),
             "Speed below which the fluid is at rest: a run ends before `end` when it has moved and all of it has been "
             "slower for a hundredth of `end`; 0: never");
  }
};

/// The scheme. `name`, `formulation` and `integrator` determine the default of `courant` (formulation.h); the
/// initialisers are those of farzin2014, robust.
struct SchemeTable {
  SchemeName name = SchemeName::farzin2014;
  Formulation formulation = Formulation::robust;
  Integrator integrator = Integrator::explicit_projection;
  PairVectors pair_vectors = PairVectors::corrected;
  double courant = 0.55;
  Turbulence turbulence = Turbulence::spalart_allmaras;

  bool operator==(const SchemeTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.choice("name", self.name,
             "Published scheme: projection of the velocity (Farzin et al. 2014), or two steps with the density at "
             "predicted positions (Farmani et al. 2020)");
    v.choice("formulation", self.formulation,
             "robust: recommended (docs/theory/schemes.md); published: the paper's own operators, walls and surface");
    v.choice("integrator", self.integrator,
             "explicit: derivatives at the old positions (F14-F17); implicit: at the new positions (F20-F27)");
    v.choice("pair_vectors", self.pair_vectors,
             "Vectors of the pressure gradient and the divergence: the kernel's gradient, or vectors corrected to "
             "first order and still antisymmetric, inside the water or up to its surface (waves then keep their "
             "height, and jittered water takes longer to come to rest)");
    v.number("courant", self.courant, "", Range::above_up_to(0.0, 1.0), "alpha of the time-step rule (F40, F41, B20)");
    v.choice("turbulence", self.turbulence,
             "Mixing of momentum in the boundary layers of walls with friction: by the viscosity alone, or by the eddy "
             "viscosity of Spalart & Allmaras (1992) as well");
  }
};

/// Changes of the robust formulation by which a study measures the effect of its components. No case needs these keys,
/// and the reference does not list them.
struct StudyTable {
  double support = 3.0;
  double length = 0.0;
  double artificial_viscosity = 0.0;
  double noise_viscosity = 0.2;
  double shifting = 3.0;
  double density_relaxation = 0.05;
  double energy_slack = 1e-4;
  DivergenceFree divergence_free = DivergenceFree::midway;
  Displacement displacement = Displacement::new_velocity;

  bool operator==(const StudyTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.number("support", self.support, "dx", Range::between(2.0, 5.0), "Radius of the kernel's support");
    v.number("length", self.length, "m", Range::at_least(0.0),
             "Length scale L of the time-step rule (F41); 0: the height of the fluid along gravity, at the start or at "
             "open ends");
    v.number("artificial_viscosity", self.artificial_viscosity, "", Range::at_least(0.0),
             "c_a of the papers' artificial viscosity, nu_a = c_a |u| dx (F3)");
    v.number(
        "noise_viscosity", self.noise_viscosity, "", Range::between(0.0, 1.0),
        "Viscosity that acts only on differences between neighbours that a linear velocity field does not "
        "explain, as a multiple of dx times a speed: that of the water or, if larger, that of a fall over the head "
        "of the pressure that does not balance the weight");
    v.number("shifting", self.shifting, "", Range::at_least(0.0),
             "Strength of the particle shifting along the concentration gradient; 0: none");
    v.number("density_relaxation", self.density_relaxation, "", Range::between(0.0, 1.0),
             "Fraction of the density error that the source of the pressure equation corrects while water at the speed "
             "of the time-step rule goes dx");
    v.number("energy_slack", self.energy_slack, "", Range::above(0.0),
             "The expansion by the density source decreases as the energy rises by more than the walls' work. It is 0 "
             "when the rise reaches this fraction of m g L/2 plus the kinetic energy");
    v.choice("divergence_free", self.divergence_free,
             "Position at which the projection makes the velocity divergence-free: midway along the displacement, "
             "which is second order in time, or at the start of the step as published (F18)");
    v.choice("displacement", self.displacement,
             "Velocity that moves the particles of farzin2014: the new one, or as published the mean of the old and "
             "the new (F17); farmani2020 always takes the mean (B19)");
  }
};

struct PressureSolverTable {
  KrylovMethod method = KrylovMethod::automatic;  ///< no key: the preconditioner determines it
  PreconditionerName preconditioner = PreconditionerName::automatic;
  double tolerance = 1e-4;
  int max_iterations = 500;
  std::string petsc_options;

  bool operator==(const PressureSolverTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.choice("preconditioner", self.preconditioner,
             "Preconditioner, and the method that goes with it; auto chooses by size (docs/theory/linear.md)");
    v.number("tolerance", self.tolerance, "", Range::between(1e-14, 0.1), "Relative residual at which a solve ends");
    v.integer("max_iterations", self.max_iterations, "", Range::at_least(1),
              "Largest number of iterations; a solve that needs more is an error");
    v.text("petsc_options", self.petsc_options,
           "Further PETSc options, with the prefix pressure_; they override the keys above");
  }
};

struct ParallelTable {
  double imbalance = 0.03;

  bool operator==(const ParallelTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.number("imbalance", self.imbalance, "", Range::between(0.0, 10.0),
             "Particles are redistributed when the busiest rank has more than 1 plus this times the mean work");
  }
};

/// Thresholds at which a run warns of its own results, or stops.
struct LimitsTable {
  double energy_warning = 1e-3;
  double energy_stop = 0.0;
  double volume_warning = 0.05;
  double volume_stop = 0.0;

  bool operator==(const LimitsTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.number("energy_warning", self.energy_warning, "", Range::at_least(0.0),
             "The run warns when the energy, without the work of walls, has risen by more than this fraction of m g "
             "L/2 plus the kinetic energy and the largest work of open ends. A smaller rise than the energy of lifting "
             "the water by dx/20 plus a tenth of that work and a twentieth of the largest work of walls does not "
             "count. 0: never");
    v.number("energy_stop", self.energy_stop, "", Range::at_least(0.0), "The same fraction at which the run fails");
    v.number("volume_warning", self.volume_warning, "", Range::at_least(0.0),
             "The run warns when the mean density of the water away from the surface is off by more than this "
             "fraction; 0: never");
    v.number("volume_stop", self.volume_stop, "", Range::at_least(0.0), "The same fraction at which the run fails");
  }
};

struct OutputTable {
  double fields_interval = 0.0;
  double view_interval = 0.0;
  std::vector<std::string> fields = {"pressure", "velocity", "density_error", "id"};
  double checkpoint_interval = 900.0;

  bool operator==(const OutputTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.number("fields_interval", self.fields_interval, "s", Range::at_least(0.0),
             "Time between field files; 0: a hundredth of the end time");
    v.number("view_interval", self.view_interval, "s", Range::at_least(0.0),
             "Time between the small frames for `tailwater view`; 0: a four-hundredth of the end time, and at least "
             "eight steps");
    v.texts("fields", self.fields, field_names, "Fields to write");
    v.number("checkpoint_interval", self.checkpoint_interval, "s", Range::at_least(0.0),
             "Wall-clock time between checkpoints, from which `tailwater resume` continues; 0: only at the end of a "
             "run and on request");
  }
};

struct ProbeTable {
  std::string name;
  ProbeType type = ProbeType::depth;
  Coordinates at;
  Coordinates from;
  Coordinates to;
  Coordinates direction;
  std::vector<std::string> walls;
  Coordinates region_min;
  Coordinates region_max;
  Coordinates moment_about;
  std::string body;
  std::string liquid;
  double diameter = 0.0;
  double width = 0.0;
  double step = 0.0;
  std::vector<double> times;
  double interval = 0.0;
  double averaging_time = 0.0;

  bool operator==(const ProbeTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.text("name", self.name, "Name of the CSV file, probes/NAME.csv", Presence::required);
    v.choice("type", self.type, "Measured quantity", Presence::required);
    v.coordinates("at", self.at, "m",
                  "Position of a depth or velocity-profile probe (its height is ignored) or of a wall-pressure, "
                  "pressure or velocity probe");
    v.coordinates("from", self.from, "m",
                  "Start of a stretch of wall, of a profile, of a level map (its height is ignored) or of a section; "
                  "for overtopping, the crest");
    v.coordinates("to", self.to, "m",
                  "End of a stretch of wall or of a profile. For a level map or a section: end of a segment (2D), or "
                  "opposite corner of a flat axis-parallel rectangle (3D)");
    v.coordinates("direction", self.direction, "",
                  "Direction in which a front probe looks, or in which a discharge counts as positive (default: +x)");
    v.texts("walls", self.walls, {}, "Names of the walls of a force, pressure-map or run-up probe (default: all)");
    v.coordinates("region_min", self.region_min, "m",
                  "Lowest corner of a box; only the parts of these walls inside it, as drawn, count");
    v.coordinates("region_max", self.region_max, "m", "Highest corner of this box");
    v.coordinates("moment_about", self.moment_about, "m",
                  "Fixed point about which the moment is taken (default: no moment is written)");
    v.text("body", self.body, "Name of the body whose motion is written");
    v.text("liquid", self.liquid,
           "Name of the [[liquid]] whose level, front or volume is measured, in a case with several (default: all)");
    v.number(
        "diameter", self.diameter, "m", Range::at_least(0.0),
        "Diameter of the round sensor in the wall, over which the pressure is averaged (2D: its length); 0: a point");
    v.number("width", self.width, "m", Range::at_least(0.0),
             "Width of the rectangle in the wall, half on each side of the stretch (3D); 0: a line");
    v.number("step", self.step, "m", Range::at_least(0.0),
             "Distance between the points of a level map or a velocity profile; 0: dx");
    v.numbers("times", self.times, "s", "Times at which a profile or velocity profile is taken");
    v.number("interval", self.interval, "s", Range::at_least(0.0), "Time between two readings; 0: every step");
    v.number("averaging_time", self.averaging_time, "s", Range::at_least(0.0),
             "Largest pressures in the summary are means over this time, for instance the rise time of the sensor; 0: "
             "3 dx or a tenth of the depth H of the water, whichever is longer, over the speed sqrt(2 g H)");
  }
};

/// Laboratory measurements for comparison with the output of a probe.
struct MeasurementTable {
  std::string name;  ///< no key: measurement1, measurement2, ...
  std::string probe;
  std::string column;
  std::string file;
  std::string checksum;
  double shift = 0.0;
  double scatter = 0.0;

  TimeSeries series;  ///< contents of the file: t, and one column in the unit of the probe's

  bool operator==(const MeasurementTable&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.text("probe", self.probe, "Name of the probe to compare with", Presence::required);
    v.text("column", self.column,
           "Column of the probe's table, without its unit, as in \"highest\" (default: the first one)");
    v.text("file", self.file,
           "CSV file of the measured values over time, relative to the case file, with a line that names the columns, "
           "as in \"t [s], depth [mm]\". If there are several columns, the one named like the probe, like `column` or "
           "\"value\" is used (docs/theory/probes.md)",
           Presence::required);
    v.text("checksum", self.checksum,
           "CRC-32 of the file, which a run writes into its case; a file with another one is refused",
           Presence::written);
    v.number("shift", self.shift, "s", Range::at_least(0.0),
             "Largest time shift, in either direction, for the best fit: the uncertainty of the instant t = 0 of the "
             "measurement");
    v.number("scatter", self.scatter, "", Range::at_least(0.0),
             "Standard deviation of repeated measurements, in the SI unit of the column; 0: not known");
  }
};

/// A named number of the case file, for use in expressions.
struct Parameter {
  std::string name;
  double value = 0.0;

  bool operator==(const Parameter&) const = default;
};

/// A whole case, each key read and validated; checks/check.h checks the geometry as a whole.
struct CaseSpec {
  std::vector<Parameter> parameters;
  CaseTable general;
  PhysicsTable physics;
  AirTable air;
  std::vector<PocketTable> pockets;
  std::vector<VentTable> vents;
  std::vector<LiquidTable> liquids;
  ParticlesTable particles;
  DomainTable domain;
  std::vector<FluidTable> fluid;
  std::vector<WallTable> walls;  ///< after those of the file: the walls of gates and wave makers
  std::vector<GateTable> gates;
  std::vector<WaveMakerTable> wave_makers;
  std::vector<BodyTable> bodies;
  std::vector<MooringTable> moorings;
  std::vector<DampingTable> damping;
  std::vector<RefinementTable> refinement;
  std::vector<PorousTable> porous;
  std::vector<InletTable> inlets;
  std::vector<OutletTable> outlets;
  TimeTable time;
  SchemeTable scheme;
  PressureSolverTable pressure_solver;
  ParallelTable parallel;
  LimitsTable limits;
  OutputTable output;
  std::vector<ProbeTable> probes;
  std::vector<MeasurementTable> measurements;
  StudyTable study;
  CaseSources sources;

  // Compiled once, in spec.cpp: otherwise two dozen objects would contain the code for some twenty tables.
  CaseSpec();
  CaseSpec(const CaseSpec&);
  CaseSpec(CaseSpec&&) noexcept;
  CaseSpec& operator=(const CaseSpec&);
  CaseSpec& operator=(CaseSpec&&) noexcept;
  ~CaseSpec();

  bool operator==(const CaseSpec&) const = default;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& v) {
    v.table("case", self.general, "The case as a whole");
    v.table("physics", self.physics, "Fluid and gravity");
    v.table("air", self.air, "Air enclosed by water and walls");
    v.tables("pocket", self.pockets,
             "An enclosed space whose initial air pressure differs from the atmosphere's; one table each");
    v.tables("vent", self.vents, "An opening between an enclosed space and the atmosphere; one table each");
    v.tables("liquid", self.liquids, "A thick or yielding liquid, such as mud or fresh concrete; one table each");
    v.table("particles", self.particles, "Resolution and initial arrangement");
    v.table("domain", self.domain, "Periodic directions");
    v.tables("fluid", self.fluid, "A block of fluid at the start; one table each");
    v.tables("wall", self.walls, "A solid wall; one table each");
    v.tables("gate", self.gates, "A plate that is pulled out of the water; one table each");
    v.tables("wave_maker", self.wave_makers, "A plate that makes waves, or absorbs them; one table each");
    v.tables("body", self.bodies, "A rigid body that the water moves; one table each");
    v.tables("mooring", self.moorings, "A line that holds a body; one table each");
    v.tables("damping", self.damping,
             "A zone in which waves decay, or a relaxation zone that makes and absorbs waves; one table each");
    v.tables("refinement", self.refinement, "A zone of finer particles; one table each");
    v.tables("porous", self.porous, "A layer of stones or grains that water flows through; one table each");
    v.tables("inlet", self.inlets, "An open end through which water enters; one table each");
    v.tables("outlet", self.outlets, "An open end through which water leaves; one table each");
    v.table("time", self.time, "Duration of the run");
    v.table("scheme", self.scheme, "Numerical scheme");
    v.table("pressure_solver", self.pressure_solver, "Linear solver of the pressure equation");
    v.table("parallel", self.parallel, "Runs on several ranks (-n)");
    v.table("limits", self.limits, "Thresholds at which a run warns of its own errors, or stops");
    v.table("output", self.output, "Field files for ParaView, frames for `tailwater view`, and checkpoints");
    v.tables("probe", self.probes, "A measurement written during the run; one table each");
    v.tables("measurement", self.measurements, "Measured values over time for comparison with a probe; one table each");
    v.table("study", self.study, "For studies: the robust formulation without one of its parts");
  }
};

}  // namespace tailwater
