// Liquids beside open ends, floating bodies and wave makers, against exact flows.
#include <gtest/gtest.h>

#include <array>

#include "base/finding.h"
#include "bodies/floating_bodies.h"
#include "case/reader.h"
#include "rheology/liquids.h"
#include "rheology/thick_liquid.h"
#include "schemes/open_ends.h"
#include "support/record.h"

namespace tailwater {
namespace {

void pass_to(Flow<2>& flow, double end) {
  while (flow.state.time < end) pass_and_step(flow);
}

/// rms of the velocity along x less exact(y), over the largest of exact, of the fluid with low < x < high [m].
double profile_error_between(const Flow<2>& flow, double low, double high, auto&& exact) {
  const Particles<2>& particles = flow.state.particles;
  double squares = 0.0;
  double count = 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    const Vec<2>& x = particles.position[i];
    if (!particles.is_fluid(i) || x[0] < low || x[0] > high) continue;
    squares += std::pow(particles.velocity[i][0] - exact(x[1]), 2);
    largest = std::max(largest, exact(x[1]));
    count += 1.0;
  }
  return std::sqrt(squares / count) / largest;
}

/// Opens a box of no slip at both ends in x.
void open_both_ends(CaseSpec& spec) {
  spec.walls[0].slip = Slip::no_slip;
  spec.walls[0].friction = 1.0;
  open_end(spec);
  open_start(spec);
}

// A film of 1 m down a slope carries q = rho g_x h^3/(3 mu). An inlet with this discharge and its parabola feeds it,
// and its level is held at the end. The velocity is right to 3 %, as water at a mouth follows a level to a quarter of a
// spacing, which is 2.5 % of this depth.
TEST(MudInflow, FeedsAFilmOfTheExactDepth) {
  CaseSpec spec = tank_case<2>(0.1, 3.0, 1.0);
  open_both_ends(spec);
  spec.physics.gravity = {1.0, -10.0};
  spec.inlets[0].discharge = 1.0 / 3.0;
  spec.inlets[0].profile = "s*(2 - s)";
  spec.outlets[0].level = 1.0;
  spec.outlets[0].absorbing = 0.0;
  spec.fluid[0].velocity = {"0.5*y*(2 - y)", 0.0};
  fill_with(spec, newtonian(1000.0));
  Flow<2> flow = make_flow<2>(spec);
  ASSERT_TRUE(flow.setup.has_implicit_viscosity);
  // Water enters row by row, so that the discharge varies by some per cent. Mean of the rows of the film over time:
  std::array<double, 10> velocity{};
  std::array<double, 10> particles_in{};
  double area = 0.0;
  double discharge = 0.0;
  double steps = 0.0;
  while (flow.state.time < 4.0) {
    pass_and_step(flow);
    if (flow.state.time < 1.5) continue;
    const Particles<2>& particles = flow.state.particles;
    for (std::size_t i = 0; i < particles.owned; ++i) {
      const Vec<2>& x = particles.position[i];
      if (!particles.is_fluid(i) || x[0] < 1.0 || x[0] > 2.0) continue;
      const auto row = static_cast<std::size_t>(std::clamp(10.0 * x[1], 0.0, 9.0));
      velocity[row] += particles.velocity[i][0] - 0.5 * x[1] * (2.0 - x[1]);
      particles_in[row] += 1.0;
      area += particles.volume[i];
      discharge += particles.volume[i] * particles.velocity[i][0];
    }
    steps += 1.0;
  }
  double squares = 0.0;
  for (std::size_t row = 0; row < 10; ++row) squares += 0.1 * std::pow(velocity[row] / particles_in[row], 2);
  const double error = std::sqrt(squares) / 0.5;
  record_error("mud_inflow", 2, 0.1, error);
  EXPECT_LT(error, 0.03);
  EXPECT_NEAR(area / steps, 1.0, 0.02);
  EXPECT_NEAR(discharge / steps, 1.0 / 3.0, 0.02 / 3.0);
}

// Between two plates 1 m apart a uniform inflow of 1 m/s becomes the parabola 6 y (1 - y), and the pressure falls by
// 12 mu u/h^2 per length.
TEST(MudInflow, FillsAConduitWithPoiseuilleFlow) {
  CaseSpec spec = tank_case<2>(0.1, 3.0, 1.0);
  spec.walls[0].max[1] = 1.0;
  spec.walls[0].open.clear();
  open_both_ends(spec);
  spec.inlets[0].velocity = 1.0;
  spec.fluid[0].velocity = {1.0, 0.0};
  fill_with(spec, newtonian(1000.0));
  Flow<2> flow = make_flow<2>(spec);
  ASSERT_TRUE(flow.setup.has_implicit_viscosity);
  pass_to(flow, 1.5);
  const double error = profile_error_between(flow, 1.0, 2.0, [](double y) { return 6.0 * y * (1.0 - y); });
  record_error("mud_in_a_conduit", 2, 0.1, error);
  EXPECT_LT(error, 0.02);
}

/// Two liquids in a tank, the lower one up to `h` [m].
void fill_in_layers(CaseSpec& spec, double h, double density_below, double density_above) {
  spec.liquids = {newtonian(1e-3), newtonian(1e-3)};
  spec.liquids[0].name = spec.fluid[0].liquid = "below";
  spec.liquids[0].density = density_below;
  spec.liquids[1].density = density_above;
  FluidTable above = spec.fluid[0];
  spec.fluid[0].max.back() = above.min.back() = h;
  spec.liquids[1].name = above.liquid = "above";
  spec.fluid.push_back(above);
}

// Layers at rest beside a mouth with a held level stay at rest: the pressure beyond is that of both liquids.
TEST(LevelBesideTwoLiquids, HoldsLayersAtRest) {
  CaseSpec spec = tank_case<2>(0.05, 1.0, 0.4);
  open_end(spec);
  spec.outlets[0].level = 0.4;
  fill_in_layers(spec, 0.2, 1500.0, 1000.0);
  Flow<2> flow = make_flow<2>(spec);
  pass_to(flow, 2.0);
  const Particles<2>& particles = flow.state.particles;
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    const double y = particles.position[i][1];
    const double exact = y > 0.2 ? 1000.0 * g * (0.4 - y) : g * (1000.0 * 0.2 + 1500.0 * (0.2 - y));
    squares += std::pow(particles.pressure[i] - exact, 2);
    count += 1.0;
  }
  const double error = std::sqrt(squares / count) / (g * (1000.0 * 0.2 + 1500.0 * 0.2));
  record_error("layers_at_a_level", 2, 0.05, error);
  EXPECT_LT(error, 0.01);
  EXPECT_LT(largest_horizontal_speed(flow), 0.02 * std::sqrt(g * 0.4));
}

// Brine that enters along the floor of a tank of water, 0.02 m^2/s for 2 s, makes a layer of 0.04 m^2 on the floor.
TEST(BrineInflow, MakesALayerOnTheFloor) {
  CaseSpec spec = tank_case<2>(0.025, 1.0, 0.3);
  InletTable& inlet = open_start(spec);
  inlet.to[1] = 0.1;
  inlet.discharge = 0.02;
  spec.walls[0].shape = WallShape::polyline;
  spec.walls[0].open.clear();
  spec.walls[0].points = {{0.0, 0.1}, {0.0, 0.6}};
  spec.walls[0].fluid_side = FluidSide::right;
  WallTable rest = spec.walls[0];
  rest.points = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.6}};
  rest.fluid_side = FluidSide::left;
  spec.walls.push_back(rest);
  fill_in_layers(spec, 0.1, 1100.0, 1000.0);
  spec.fluid[0].max[0] = 0.05;  // the brine that stands before the inlet
  FluidTable water = spec.fluid[1];
  water.min = {0.05, 0.0};
  water.max = {1.0, 0.1};
  spec.fluid.push_back(water);
  Flow<2> flow = make_flow<2>(spec);
  const auto brine = [&] {
    const Particles<2>& particles = flow.state.particles;
    Vec<2> volume_and_height = sum_over(particles.owned, Vec<2>(0.0, 0.0), [&](std::size_t i) {
      const Vec<2>& x = particles.position[i];
      const bool counts = particles.is_fluid(i) && x[0] > 0.0 && flow.setup.liquids.of(particles.id[i]) == 0;
      return counts ? Vec<2>(particles.volume[i], particles.volume[i] * x[1]) : Vec<2>(0.0, 0.0);
    });
    volume_and_height[1] /= volume_and_height[0];
    return volume_and_height;
  };
  const double before = brine()[0];
  pass_to(flow, 2.0);
  const Vec<2> after = brine();
  EXPECT_NEAR(after[0] - before, 0.02 * flow.state.time, 0.05 * 0.04);
  // Twice the height of the centre of an even layer: 1.97 with the shifts before 2026-11-29, 2.06 since.
  EXPECT_LT(after[1], 2.1 * 0.5 * after[0]);
}

/// A box that floats upright, from `low` to `high` [m] in both directions.
void float_box(CaseSpec& spec, double low, double high, double density_of_box) {
  WallTable hull;
  hull.name = "hull";
  hull.shape = WallShape::box;
  hull.min = {low, low};
  hull.max = {high, high};
  hull.fluid_side = FluidSide::outside;
  hull.drive = {Drive::By::body, 0};
  spec.walls.push_back(hull);
  BodyTable body;
  body.name = "hull";
  body.walls = {"hull"};
  body.mass = density_of_box * (high - low) * (high - low);
  body.centre = {0.5 * (low + high), 0.5 * (low + high)};
  body.free = {"y"};
  body.velocity = {0.0, 0.0};
  spec.bodies = {body};
}

// A box of 1500 kg/m^3 between layers of 2000 and 1000 kg/m^3 is half in each.
TEST(BodyInTwoLiquids, FloatsAtTheDepthOfArchimedes) {
  constexpr double dx = 0.025;
  CaseSpec spec = tank_case<2>(dx, 0.6, 0.6);
  fill_in_layers(spec, 0.3, 2000.0, 1000.0);
  float_box(spec, 0.2, 0.4, 1500.0);
  Flow<2> flow = make_flow<2>(spec);
  double squares = 0.0;
  double steps = 0.0;
  while (flow.state.time < 1.0) {
    step(flow);
    const double off = flow.state.motion.bodies.each[0].centre_at(flow.state.time)[1] - 0.3;
    squares += off * off;
    steps += 1.0;
  }
  EXPECT_LT(std::sqrt(squares / steps), 0.1 * dx);
}

TEST(BodyInMud, IsRefused) {
  CaseSpec spec = tank_case<2>(0.05, 0.6, 0.6);
  fill_with(spec, newtonian(1000.0));
  float_box(spec, 0.2, 0.4, 500.0);
  EXPECT_THROW(make_flow<2>(spec), CaseError);
}

/// Kinetic energy [J] in a flume with a piston after a period and a quarter.
double energy_of_waves(const std::string& liquids, const std::string& blocks) {
  const std::string text =
      "[case]\ntitle = \"Flume\"\n[particles]\nspacing = 0.05\n[time]\nend = 2.4\n"
      "[[wall]]\nname = \"flume\"\npoints = [[-0.4, 0], [3, 0], [3, 0.8]]\n"
      "[[wave_maker]]\nfrom = [0, 0]\nto = [0, 0.8]\ndepth = 0.4\nwaves = \"regular\"\nheight = 0.04\n"
      "period = 1.2\n";
  Flow<2> flow = make_flow<2>(read_case_text(text + liquids + blocks, "flume.toml"));
  while (flow.state.time < 1.5) step(flow);
  return sum_over(flow.state.particles.owned, 0.0,
                  [&](std::size_t i) { return flow.state.particles.is_fluid(i) ? flow.kinetic_energy_of(i) : 0.0; });
}

// A piston makes the same waves in two layers of water as in water.
TEST(WaveMakerInTwoLiquids, MakesTheWavesOfWater) {
  const double of_water = energy_of_waves("", "[[fluid]]\nmin = [0, 0]\nmax = [3, 0.4]\n");
  const double of_layers =
      energy_of_waves("[[liquid]]\nname = \"a\"\nviscosity = 1e-3\n[[liquid]]\nname = \"b\"\nviscosity = 1e-3\n",
                      "[[fluid]]\nmin = [0, 0]\nmax = [3, 0.2]\nliquid = \"a\"\n"
                      "[[fluid]]\nmin = [0, 0.2]\nmax = [3, 0.4]\nliquid = \"b\"\n");
  EXPECT_NEAR(of_layers / of_water, 1.0, 0.02);
}

}  // namespace
}  // namespace tailwater
