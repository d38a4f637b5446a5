// Every kind of wrong case file: where the message points and what it must say. Each file has one mistake and gets
// one line, so that a mistake never drags others behind it.
#include <gtest/gtest.h>

#include <ostream>

#include "case_file.h"

namespace tailwater {
namespace {

struct BadInput {
  std::string name;
  std::string text;
  std::string place;  ///< line and column in the file; empty: the file as a whole
  std::vector<std::string> parts;
};

/// What GoogleTest prints of a row.
void PrintTo(const BadInput& input, std::ostream* stream) { *stream << input.name; }

const std::string probe = "[[probe]]\nname = \"p\"\n";
const std::string three = "case.dimension = 3\n" + required_keys;
const std::string cube = "[[fluid]]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n";

const std::vector<BadInput> table{
    // The file
    {"syntax", "[case\ntitle = 3\n", "1:6", {"not valid TOML"}},
    {"key_twice", required_keys + "[scheme]\ncourant = 0.1\ncourant = 0.2\n" + water, "5:", {"redefine", "courant"}},
    {"unknown_table",
     required_keys + "[shceme]\ncourant = 0.1\n" + water,
     "3:1",
     {"shceme", "did you mean \"scheme\"?"}},
    {"table_not_a_table", "scheme = 3\n" + required_keys + water, "1:10", {"scheme = 3", "[scheme]"}},
    {"one_fluid_table", required_keys + "[fluid]\nmin = [0, 0]\nmax = [1, 1]\n", "3:1", {"fluid", "[[fluid]]"}},
    {"no_fluid", required_keys, "", {"there is no fluid", "[[fluid]]"}},
    {"empty_fluid", "fluid = []\n" + required_keys, "", {"there is no fluid"}},
    {"missing_table", "time.end = 1\n" + water, "", {"particles.spacing is missing", "above 0 in m"}},
    {"missing_key", "particles.jitter = 0\ntime.end = 1\n" + water, "1:1", {"particles.spacing is missing"}},
    // Keys
    {"misspelt_key",
     required_keys + "[scheme]\nintgrator = \"implicit\"\n" + water,
     "4:13",
     {"scheme.intgrator = \"implicit\": unknown key", "did you mean \"integrator\"?"}},
    {"key_of_another_table",
     required_keys + "[output]\ncourant = 0.1\n" + water,
     "4:11",
     {"output.courant", "it belongs to [scheme]"}},
    {"misspelt_key_in_a_list",
     required_keys + water + "velocty = [0, 0]\n",
     "6:11",
     {"fluid[0].velocty", "did you mean \"velocity\"?"}},
    // Velocities that vary
    {"velocity_of_an_unknown_name",
     required_keys + water + "velocity = [0, \"2*w\"]\n",
     "6:16",
     {"fluid[0].velocity[1] = \"2*w\": unknown name \"w\"", "\"x\"", "\"y\""}},
    {"velocity_of_z_in_a_plane",
     required_keys + water + "velocity = [\"z\", 0]\n",
     "6:13",
     {"fluid[0].velocity[0] = \"z\": unknown name \"z\""}},
    {"velocity_with_too_few_components",
     required_keys + water + "velocity = [\"x\"]\n",
     "6:12",
     {"fluid[0].velocity", "2 numbers in m/s"}},
    // Walls that move
    {"displacement_of_a_position",
     required_keys + water + "[[wall]]\npoints = [[0, 0], [1, 0]]\ndisplacement = [0, \"x\"]\n",
     "8:20",
     {"wall[0].displacement[1] = \"x\": unknown name \"x\"", "\"t\""}},
    {"rotation_of_an_unknown_function",
     required_keys + water + "[[wall]]\npoints = [[0, 0], [1, 0]]\nrotation = \"clmp(t, 0, 1)\"\n",
     "8:12",
     {"wall[0].rotation", "did you mean \"clamp\"?"}},
    {"rotation_in_space",
     "case.dimension = 3\n" + required_keys +
         "[[fluid]]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[[wall]]\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n"
         "rotation = \"t\"\n",
     "11:12",
     {"wall[0].rotation", "needs the axis", "such as [0, 1, 0]"}},
    {"axis_in_the_plane",
     required_keys + water + "[[wall]]\npoints = [[0, 0], [1, 0]]\naxis = [0, 1]\n",
     "8:8",
     {"wall[0].axis", "about their pivot only"}},
    // Gates
    {"gate_without_an_extent",
     required_keys + water + "[[gate]]\nfrom = [1, 0]\nto = [1, 0]\nspeed = 1\n",
     "8:6",
     {"gate[0].to", "differs from `from` in 0 coordinates", "exactly one coordinate"}},
    {"gate_that_slants",
     required_keys + water + "[[gate]]\nfrom = [1, 0]\nto = [1.1, 1]\nspeed = 1\n",
     "8:6",
     {"gate[0].to", "differs from `from` in 2 coordinates"}},
    {"gate_with_the_wrong_sides",
     required_keys + water + "[[gate]]\nfrom = [1, 0]\nto = [1, 1]\nspeed = 1\nside = \"+y\"\n",
     "10:8",
     {"gate[0].side", "\"-x\" and \"+x\""}},
    {"gate_without_its_speed",
     required_keys + water + "[[gate]]\nfrom = [1, 0]\nto = [1, 1]\n",
     "6:1",
     {"gate[0].speed"}},
    {"gate_with_two_motions",
     required_keys + water +
         "[[gate]]\nfrom = [1, 0]\nto = [1, 1]\nmotion = \"acceleration\"\nacceleration = 1\nspeed = 1\n",
     "11:9",
     {"gate[0].speed", "is not used with motion = \"acceleration\""}},
    {"weight_that_does_not_lift",
     required_keys + water +
         "[[gate]]\nfrom = [1, 0]\nto = [1, 1]\nmotion = \"falling-weight\"\nweight = 2\ngate_mass = 3\n",
     "10:10",
     {"gate[0].weight", "does not lift a gate of 3 kg"}},
    {"gate_with_the_name_of_a_wall",
     required_keys + water +
         "[[wall]]\nname = \"a\"\npoints = [[0, 0], [1, 0]]\n[[gate]]\nname = \"a\"\nfrom = [1, 0]\nto = [1, 1]\nspeed "
         "= 1\n",
     "9:1",
     {"gate[0].name = \"a\"", "a wall has this name too"}},
    {"time_as_a_parameter", "parameters.t = 1\n" + required_keys + water, "1:16", {"parameters.t", "not x, y, z, t"}},
    {"position_as_a_parameter", "parameters.x = 1\n" + required_keys + water, "1:16", {"parameters.x", "not x, y, z"}},
    // Numbers
    {"range_low",
     "particles.spacing = -0.1\ntime.end = 1\n" + water,
     "1:21",
     {"particles.spacing = -0.1: out of range", "above 0 in m"}},
    {"range_high", required_keys + "[scheme]\nsupport = 9\n" + water, "4:11", {"scheme.support = 9", "2 to 5 in dx"}},
    {"range_of_an_expression",
     "particles.spacing = \"1-2\"\ntime.end = 1\n" + water,
     "1:21",
     {"its value -1", "above 0"}},
    {"not_a_number", required_keys + "[physics]\ndensity = nan\n" + water, "4:11", {"not a finite number", "kg/m^3"}},
    {"infinite", required_keys + "[physics]\ndensity = inf\n" + water, "4:11", {"not a finite number"}},
    {"infinite_expression", required_keys + "[physics]\ndensity = \"1/0\"\n" + water, "4:11", {"its value is inf"}},
    {"boolean_for_number",
     required_keys + "[physics]\ndensity = true\n" + water,
     "4:11",
     {"physics.density = true: wrong type", "number in kg/m^3"}},
    {"date_for_number", required_keys + "[physics]\ndensity = 2024-01-01\n" + water, "4:11", {"a date", "wrong type"}},
    {"list_for_number", required_keys + "[physics]\ndensity = [1, 2]\n" + water, "4:11", {"[1, 2]: wrong type"}},
    {"unit", "particles.spacing = \"0.6 m\"\ntime.end = 1\n" + water, "1:21", {"\"0.6 m\"", "without a unit"}},
    {"unit_without_space", "particles.spacing = \"60cm\"\ntime.end = 1\n" + water, "1:21", {"without a unit"}},
    {"decimal_comma", "particles.spacing = \"0,6\"\ntime.end = 1\n" + water, "1:21", {"write decimals with a point"}},
    {"fraction_for_integer",
     required_keys + "[scheme]\nmax_passes = 2.5\n" + water,
     "4:14",
     {"whole number, 1 to 100"}},
    {"integer_too_large",
     required_keys + "[pressure_solver]\nmax_iterations = 1e10\n" + water,
     "4:18",
     {"whole number"}},
    {"unknown_name",
     "particles.spacing = \"Hh/2\"\ntime.end = 1\nparameters.H = 1\n" + water,
     "1:21",
     {"unknown name \"Hh\" at position 1", "did you mean \"H\"?"}},
    {"spacing_of_itself", "particles.spacing = \"dx\"\ntime.end = 1\n" + water, "1:21", {"unknown name \"dx\""}},
    {"unknown_name_is_reported_once_if_dx_uses_it",
     "particles.spacing = \"H\"\ntime.end = \"dx\"\n[[fluid]]\nmin = [0, 0]\nmax = [\"4*dx\", 1]\n",
     "1:21",
     {"unknown name \"H\""}},
    // Parameters
    {"parameter_not_finite", "parameters.H = inf\n" + required_keys + water, "1:16", {"parameters.H = inf"}},
    {"parameter_of_itself", "parameters.H = \"H+1\"\n" + required_keys + water, "1:16", {"depends on itself"}},
    {"parameter_named_dx", "parameters.dx = 1\n" + required_keys + water, "1:17", {"cannot be a parameter's name"}},
    {"parameter_named_sin", "parameters.sin = 1\n" + required_keys + water, "1:18", {"cannot be a parameter's name"}},
    {"parameter_with_dash", "parameters.a-b = 1\n" + required_keys + water, "1:18", {"cannot be a parameter's name"}},
    {"parameter_of_unknown", "parameters.H = \"2*L\"\n" + required_keys + water, "1:16", {"unknown name \"L\""}},
    {"parameter_is_reported_once",
     "parameters.H = \"2*\"\nparameters.L = \"H\"\ntime.end = \"L\"\nparticles.spacing = 1\n" + water,
     "1:16",
     {"ends too early"}},
    {"parameters_not_a_table", "parameters = 3\n" + required_keys + water, "1:14", {"[parameters]"}},
    {"too_few_passes_for_the_relaxation",
     required_keys + "[scheme]\nintegrator = \"implicit\"\nrelax_velocity = 0.3\nmax_passes = 12\n" + water,
     "6:14",
     {"scheme.max_passes = 12", "at least 13"}},
    {"integrator_of_another_scheme",
     required_keys + "[scheme]\nname = \"farmani2020\"\nintegrator = \"explicit\"\n" + water,
     "5:14",
     {"scheme.integrator", "is not used with name = \"farmani2020\"", "name = \"farzin2014\""}},
    {"share_of_no_density_source",
     required_keys + "[scheme]\nsource = \"velocity-divergence\"\ndensity_relaxation = 0.1\n" + water,
     "5:22",
     {"scheme.density_relaxation", "is not used with source", "source = \"mixed\""}},
    {"beta_of_another_surface",
     required_keys + "[scheme]\nsurface_density = 0.9\n" + water,
     "4:19",
     {"scheme.surface_density", "is not used with surface = \"air\"", "surface = \"density\""}},
    // Texts and choices
    {"number_for_text", "case.title = 3\n" + required_keys + water, "1:14", {"case.title = 3", "text in quotes"}},
    {"unknown_choice",
     required_keys + "[scheme]\nintegrator = \"implict\"\n" + water,
     "4:14",
     {"scheme.integrator = \"implict\"", "did you mean \"implicit\"?", "\"explicit\", \"implicit\""}},
    {"number_for_choice",
     required_keys + "[scheme]\nkernel = 3\n" + water,
     "4:10",
     {"scheme.kernel = 3", "one of \"wendland-c2\", \"cubic-spline\", \"farzin\""}},
    {"unknown_field",
     required_keys + "[output]\nfields = [\"id\", \"presure\"]\n" + water,
     "4:17",
     {"output.fields[1] = \"presure\"", "did you mean \"pressure\"?"}},
    {"field_twice", required_keys + "[output]\nfields = [\"id\", \"id\"]\n" + water, "4:17", {"twice"}},
    {"field_not_a_list",
     required_keys + "[output]\nfields = \"id\"\n" + water,
     "4:10",
     {"list of any of \"pressure\""}},
    {"field_not_a_text", required_keys + "[output]\nfields = [3]\n" + water, "4:11", {"output.fields[0] = 3"}},
    // Dimension and coordinates
    {"dimension_four", "case.dimension = 4\n" + required_keys + water, "1:18", {"case.dimension = 4", "2 to 3"}},
    {"three_numbers_in_2d",
     required_keys + "[[fluid]]\nmin = [0, 0, 0]\nmax = [1, 1]\n",
     "4:7",
     {"fluid[0].min = [0, 0, 0]", "give 2 numbers in m", "case.dimension = 2"}},
    {"two_numbers_in_3d", three + "[[fluid]]\nmin = [0, 0]\nmax = [1, 1, 1]\n", "5:7", {"give 3 numbers"}},
    {"number_for_vector", required_keys + "[[fluid]]\nmin = 0\nmax = [1, 1]\n", "4:7", {"give 2 numbers"}},
    {"text_in_vector", required_keys + "[[fluid]]\nmin = [true, 0]\nmax = [1, 1]\n", "4:8", {"fluid[0].min[0] = true"}},
    {"gravity_of_wrong_length",
     required_keys + "[physics]\ngravity = [0]\n" + water,
     "4:11",
     {"physics.gravity = [0]"}},
    {"gravity_of_itself",
     required_keys + "[physics]\ngravity = [0, \"-g\"]\n" + water,
     "4:15",
     {"physics.gravity[1]", "unknown name \"g\""}},
    {"point_of_wrong_length",
     required_keys + water + "[[wall]]\npoints = [[0, 0], [1, 0, 0]]\n",
     "7:19",
     {"wall[0].points[1] = [1, 0, 0]", "give 2 numbers"}},
    {"point_not_a_list", required_keys + water + "[[wall]]\npoints = [0]\n", "7:11", {"wall[0].points[0] = 0"}},
    {"points_not_a_list", required_keys + water + "[[wall]]\npoints = 1\n", "7:10", {"list of points in m"}},
    // Outlets
    {"outlet_without_end", required_keys + water + "[[outlet]]\nfrom = [1, 0]\n", "6:1", {"outlet[0].to is missing"}},
    {"outlet_without_extent",
     required_keys + water + "[[outlet]]\nfrom = [1, 0]\nto = [1, 0]\n",
     "8:6",
     {"outlet[0].to", "same point as from"}},
    {"outlet_direction_is_zero",
     required_keys + water + "[[outlet]]\nfrom = [1, 0]\nto = [1, 1]\ndirection = [0, 0]\n",
     "9:13",
     {"outlet[0].direction", "has length 0"}},
    // Periodic directions
    {"period_of_one", required_keys + "[domain]\nperiodic_x = [1]\n" + water, "4:14", {"two numbers in m"}},
    {"period_backwards", required_keys + "[domain]\nperiodic_y = [1, 0]\n" + water, "4:14", {"low below high"}},
    {"period_empty", required_keys + "[domain]\nperiodic_y = [1, 1]\n" + water, "4:14", {"low below high"}},
    {"period_z_in_2d", required_keys + "[domain]\nperiodic_z = [0, 1]\n" + water, "4:14", {"no z"}},
    {"period_not_a_list", required_keys + "[domain]\nperiodic_x = 1\n" + water, "4:14", {"list of numbers in m"}},
    // Fluid
    {"fluid_without_max",
     required_keys + "[[fluid]]\nmin = [0, 0]\n",
     "3:1",
     {"fluid[0].max is missing", "shape = \"box\" needs it"}},
    {"polygon_with_max",
     required_keys + "[[fluid]]\nshape = \"polygon\"\npoints = [[0, 0], [1, 0], [0, 1]]\nmax = [1, 1]\n",
     "6:7",
     {"fluid[0].max", "is not used with shape = \"polygon\"", "goes with shape = \"box\""}},
    {"polygon_without_points",
     required_keys + "[[fluid]]\nshape = \"polygon\"\n",
     "3:1",
     {"fluid[0].points is missing"}},
    {"polygon_of_two_points",
     required_keys + "[[fluid]]\nshape = \"polygon\"\npoints = [[0, 0], [1, 0]]\n",
     "5:10",
     {"2 points are too few", "at least 3"}},
    {"polygon_in_3d",
     three + "[[fluid]]\nshape = \"polygon\"\npoints = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n",
     "5:9",
     {"polygon", "case.dimension = 3", "\"box\""}},
    {"side_walls_in_3d",
     three + "physics.channel_width = 0.3\n" + cube,
     "4:25",
     {"physics.channel_width", "case.dimension = 3", "[[wall]]"}},
    {"box_inside_out", required_keys + "[[fluid]]\nmin = [0, 2]\nmax = [1, 1]\n", "5:7", {"no extent in y", "2 to 1"}},
    {"fluid_name_twice",
     required_keys + water + "name = \"a\"\n[[fluid]]\nname = \"a\"\nmin = [2, 0]\nmax = [3, 1]\n",
     "8:8",
     {"fluid[1].name = \"a\"", "used twice"}},
    {"default_name_taken",
     required_keys + water + "name = \"fluid2\"\n[[fluid]]\nmin = [2, 0]\nmax = [3, 1]\n",
     "6:8",
     {"fluid[0].name = \"fluid2\"", "used twice"}},
    // Walls
    {"wall_of_one_point", required_keys + water + "[[wall]]\npoints = [[0, 0]]\n", "7:10", {"at least 2"}},
    {"wall_polygon_of_two",
     required_keys + water + "[[wall]]\nshape = \"polygon\"\npoints = [[0, 0], [1, 0]]\n",
     "8:10",
     {"at least 3"}},
    {"wall_polyline_in_3d",
     three + cube + "[[wall]]\npoints = [[0, 0, 0], [1, 0, 0]]\n",
     "7:1",
     {"polyline", "\"box\""}},
    {"wall_box_with_points",
     required_keys + water + "[[wall]]\nshape = \"box\"\nmin = [0, 0]\nmax = [1, 1]\npoints = [[0, 0], [1, 0]]\n",
     "10:10",
     {"wall[0].points", "not used with shape = \"box\""}},
    {"wall_unknown_face",
     required_keys + water + "[[wall]]\nshape = \"box\"\nmin = [0, 0]\nmax = [1, 1]\nopen = [\"top\"]\n",
     "10:9",
     {"wall[0].open[0] = \"top\"", "\"+y\""}},
    {"wall_face_z_in_2d",
     required_keys + water + "[[wall]]\nshape = \"box\"\nmin = [0, 0]\nmax = [1, 1]\nopen = [\"+z\"]\n",
     "10:8",
     {"no face \"+z\""}},
    {"wall_side_of_chain",
     required_keys + water + "[[wall]]\npoints = [[0, 0], [1, 0]]\nfluid_side = \"inside\"\n",
     "8:14",
     {"does not fit shape = \"polyline\"", "\"left\" or \"right\""}},
    {"wall_side_of_box",
     required_keys + water + "[[wall]]\nshape = \"box\"\nmin = [0, 0]\nmax = [1, 1]\nfluid_side = \"left\"\n",
     "10:14",
     {"\"inside\" or \"outside\""}},
    {"wall_friction_without_use",
     required_keys + water + "[[wall]]\npoints = [[0, 0], [1, 0]]\nfriction = 0.5\n",
     "8:12",
     {"wall[0].friction", "not used with slip = \"free\"", "partial"}},
    // Probes
    {"probe_without_name",
     required_keys + water + "[[probe]]\ntype = \"energy\"\n",
     "6:1",
     {"probe[0].name is missing"}},
    {"probe_without_type", required_keys + water + probe, "6:1", {"probe[0].type is missing", "\"wall-pressure\""}},
    {"probe_name_is_no_file",
     required_keys + water + "[[probe]]\nname = \"a/b\"\ntype = \"energy\"\n",
     "7:8",
     {"probe[0].name = \"a/b\"", "cannot be a file name"}},
    {"probe_name_is_empty",
     required_keys + water + "[[probe]]\nname = \"\"\ntype = \"energy\"\n",
     "7:8",
     {"cannot be a file name"}},
    {"probe_name_twice",
     required_keys + water + probe + "type = \"energy\"\n" + probe + "type = \"volume\"\n",
     "10:8",
     {"probe[1].name = \"p\"", "used twice"}},
    {"probe_without_at",
     required_keys + water + probe + "type = \"depth\"\n",
     "6:1",
     {"probe[0].at is missing", "type = \"depth\" needs it"}},
    {"probe_with_at",
     required_keys + water + probe + "type = \"energy\"\nat = [0, 0]\n",
     "9:6",
     {"probe[0].at", "not used with type = \"energy\""}},
    {"probe_profile_with_interval",
     required_keys + water + probe + "type = \"profile\"\nfrom = [0, 0]\nto = [1, 0]\ntimes = [0.5]\ninterval = 0.1\n",
     "12:12",
     {"probe[0].interval", "not used with type = \"profile\""}},
    {"probe_unknown_type",
     required_keys + water + probe + "type = \"wall_pressure\"\nat = [0, 0]\n",
     "8:8",
     {"did you mean \"wall-pressure\"?"}},
    {"probe_times_backwards",
     required_keys + water + probe + "type = \"profile\"\nfrom = [0, 0]\nto = [1, 0]\ntimes = [1, 0.5]\n",
     "11:9",
     {"increasing"}},
    {"probe_times_negative",
     required_keys + water + probe + "type = \"profile\"\nfrom = [0, 0]\nto = [1, 0]\ntimes = [-1]\n",
     "11:9",
     {"none negative"}},
    {"probe_stretch_is_a_point",
     required_keys + water + probe + "type = \"wall-pressure-mean\"\nfrom = [0, 0]\nto = [0, 0]\n",
     "10:6",
     {"same point"}},
    {"probe_direction_is_zero",
     required_keys + water + probe + "type = \"front\"\ndirection = [0, 0]\n",
     "9:13",
     {"length 0"}},
};

class BadInputTest : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputTest, GetsOneLineThatSaysWhatAndWhere) {
  const auto& [name, text, place, parts] = GetParam();
  const CaseFile file(text);
  const std::string path = file.path().string();
  const std::string message = message_of(text);
  EXPECT_EQ(line_count(message), 1) << message;
  EXPECT_TRUE(message.starts_with(place.empty() ? path + ": " : path + ":" + place)) << message << "\nplace: " << place;
  for (const std::string& part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << message << "\nmisses: " << part;
  }
}

INSTANTIATE_TEST_SUITE_P(Case, BadInputTest, testing::ValuesIn(table),
                         [](const auto& input) { return input.param.name; });

TEST(BadInput, ReportsAllProblemsInTheOrderOfTheFile) {
  const std::string message =
      message_of("[scheme]\nkernel = \"x\"\n[physics]\ndensity = -1\n[wrong]\n", {"time.end=0"});
  std::vector<std::string> expected{
      "--set time.end=0: time.end", "case.toml:2:10: scheme.kernel",           "case.toml:4:11: physics.density",
      "case.toml:5:1: wrong",       "case.toml: particles.spacing is missing", "case.toml: there is no fluid"};
  EXPECT_EQ(line_count(message), static_cast<int>(expected.size())) << message;
  std::size_t place = 0;
  for (const std::string& part : expected) {
    place = message.find(part, place);
    ASSERT_NE(place, std::string::npos) << message << "\nmisses in this order: " << part;
  }
}

}  // namespace
}  // namespace tailwater
