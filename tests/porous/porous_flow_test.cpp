// Flow through porous layers against what theory has for it.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "flow/measure.h"
#include "schemes/cases.h"
#include "schemes/open_ends.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

PorousTable layer_of(Coordinates min, Coordinates max, double porosity, double linear, double quadratic = 0.0) {
  PorousTable layer;
  layer.name = "layer";
  layer.min = std::move(min);
  layer.max = std::move(max);
  layer.porosity = porosity;
  layer.resistance = PorousResistance::coefficients;
  layer.linear = linear;
  layer.quadratic = quadratic;
  layer.added_mass = 0.34 * (1.0 - porosity) / porosity;
  return layer;
}

void run_to(auto& flow, double end) {
  while (flow.state.time < end) step(flow);
}

template <int Dim>
double water_of(const Flow<Dim>& flow) {
  return sum_over(flow.state.particles.owned, 0.0,
                  [&](std::size_t i) { return flow.state.particles.is_fluid(i) ? flow.water_volume_of(i) : 0.0; });
}

/// A channel of 1 m that repeats itself, 0.2 m high, with a plug in it from 0.25 to 0.75 m; a force of 1 m/s^2 along it
/// drives water that fills it.
CaseSpec plugged_channel(double porosity, double linear, double quadratic) {
  CaseSpec spec;
  spec.particles.spacing = 0.02;
  spec.physics.gravity = {1.0, 0.0};
  spec.domain.periodic_x = {0.0, 1.0};
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {1.0, 0.2};
  spec.fluid = {water};
  WallTable bottom;
  bottom.points = {{0.0, 0.0}, {1.0, 0.0}};
  WallTable top;
  top.points = {{1.0, 0.2}, {0.0, 0.2}};
  spec.walls = {bottom, top};
  spec.porous = {layer_of({0.25, -1.0}, {0.75, 1.0}, porosity, linear, quadratic)};
  return spec;
}

/// Mean filter velocity along the channel between two places.
double filter_velocity(const Flow<2>& flow, double from, double to) {
  const Particles<2>& particles = flow.state.particles;
  const std::vector<Vec<2>> v = flow.filter_velocity();
  const Vec<2> nothing = Vec<2>::Zero();
  const Vec<2> sums = sum_over(particles.owned, nothing, [&](std::size_t i) {
    const double x = particles.position[i][0];
    if (!particles.is_fluid(i) || x < from || x > to) return nothing;
    return Vec<2>(particles.volume[i] * v[i][0], particles.volume[i]);
  });
  return sums[0] / sums[1];
}

class PluggedChannel : public testing::TestWithParam<Integrator> {};

// Steady flow: 1 m/s^2 over 1 m is the head g (a v + b v^2) that 0.5 m of the plug take. At 1 cm/s the dynamic head of
// the water is 1e-4 of that, so nothing but the law counts. One projection leaves a divergence at the surfaces of the
// plug, before the density source sees it: 1.2 % of the flow (0.8 % with the shifts before 2026-11-29). A quarter of
// the resistance is in these surfaces (2 x 0.06 m of 0.5 m), and the sum of the resistance is the force, so the flow in
// the plug is off by a quarter of 1 %.
TEST_P(PluggedChannel, TakesTheHeadOfItsLaw) {
  struct Law {
    double linear, quadratic;
  };
  for (const auto [linear, quadratic] : {Law{200.0, 0.0}, Law{0.0, 2e4}, Law{100.0, 1e4}}) {
    CaseSpec spec = plugged_channel(0.4, linear, quadratic);
    spec.scheme.integrator = GetParam();
    Flow<2> flow = make_flow<2>(spec);
    run_to(flow, 0.3);        // ten times as long as the law needs: 1/(a v + 2 b v) is at most 0.02 s
    const double head = 2.0;  // per metre of the plug, over g = 1
    const double steady = quadratic == 0.0
                              ? head / linear
                              : (std::sqrt(linear * linear + 4.0 * quadratic * head) - linear) / (2.0 * quadratic);
    EXPECT_NEAR(filter_velocity(flow, 0.35, 0.65) / steady, 1.0, 3e-3) << linear << ' ' << quadratic;
    EXPECT_NEAR(filter_velocity(flow, 0.0, 1.0) / steady, 1.0, 0.013) << linear << ' ' << quadratic;
  }
}

// The velocity of the water passes 20 cm/s, and all of it goes through the plug within 3 s: water and its particles
// stay.
TEST_P(PluggedChannel, KeepsTheWaterThatPassesIt) {
  CaseSpec spec = plugged_channel(0.4, 10.0, 0.0);
  spec.scheme.integrator = GetParam();
  Flow<2> flow = make_flow<2>(spec);
  const double before = water_of(flow);
  EXPECT_NEAR(before, 0.2 * (0.5 + 0.4 * 0.5), 1e-6 * before);  // the field is in single precision
  run_to(flow, 3.0);
  EXPECT_NEAR(water_of(flow) / before, 1.0, 1e-10);  // 400 steps of round-off
  const double space = sum_over(flow.state.particles.owned, 0.0, [&](std::size_t i) {
    return flow.state.particles.is_fluid(i) ? flow.state.particles.volume[i] : 0.0;
  });
  EXPECT_NEAR(space / 0.2, 1.0, 0.01);  // it still fills the channel, with the density error of the bulk
}

/// Error (rms) of the pressure of water at rest beyond `from`, over that of the whole depth, after some steps.
template <int Dim>
double pressure_error(const CaseSpec& spec, double depth, double from) {
  Flow<Dim> flow = make_flow<Dim>(spec);
  for (int k = 0; k < 20; ++k) step(flow);
  const Particles<Dim>& particles = flow.state.particles;
  const Vec<2> nothing = Vec<2>::Zero();
  const Vec<2> squares_and_count = sum_over(particles.owned, nothing, [&](std::size_t i) {
    if (!particles.is_fluid(i) || particles.position[i][0] < from) return nothing;
    const double height = particles.position[i][Dim - 1];
    return Vec<2>(std::pow(particles.pressure[i] / (1000.0 * g * depth) - (1.0 - height / depth), 2), 1.0);
  });
  return std::sqrt(squares_and_count[0] / squares_and_count[1]);
}

template <class D>
class PorousTank : public testing::Test {};
TYPED_TEST_SUITE(PorousTank, Dimensions);

// The rows of water at rest are those of open water times the conductance, and where that varies the weight has the
// same two-point form as they have. So the pressure has the error of open water, from the first rows, and no other.
TYPED_TEST(PorousTank, StillWaterHasThePressuresOfOpenWater) {
  constexpr int Dim = TypeParam::value;
  constexpr double depth = Dim == 2 ? 0.4 : 0.3;
  constexpr double width = 2.0 * depth;
  CaseSpec spec = tank_case<Dim>(0.05, width, depth);
  const double open = pressure_error<Dim>(spec, depth, 0.0);
  Coordinates min(Dim, 0.0);
  min[0] = depth;
  spec.porous = {layer_of(min, Coordinates(Dim, width), 0.4, 50.0)};
  EXPECT_LT(pressure_error<Dim>(spec, depth, 0.0), 1.1 * open);
  EXPECT_LT(pressure_error<Dim>(spec, depth, depth), 1.1 * open);
}

// A standing wave in a tank full of a medium with linear resistance: with u = grad phi, (1 + c_A) s phi + r phi = -g
// eta at the surface and s eta = phi_z give s^2 (1 + c_A) + s r + g k tanh kh = 0. In open water the same wave (20 rows
// in the depth) has its period to 0.3 % (target of the robustness suite) and decays at 0.03 1/s.
TEST(PorousTank2D, AStandingWaveDecaysAsLinearTheorySays) {
  constexpr double depth = 0.5;
  constexpr double n = 0.45;
  constexpr double speed = 0.1;
  for (const double a : {0.2, 1.0}) {
    CaseSpec spec = tank_case<2>(0.025, 1.0, depth);
    spec.fluid[0].velocity = {
        fmt::format("{}*sin(pi*x)*cosh(pi*y)/sinh(pi*{})", speed, depth),
        fmt::format("-{}*cos(pi*x)*sinh(pi*y)/sinh(pi*{})", speed, depth),
    };
    spec.porous = {layer_of({-1.0, -1.0}, {2.0, 2.0}, n, a)};
    const double inertia = 1.0 + spec.porous[0].added_mass;
    const double r = g * n * a;
    constexpr double k = std::numbers::pi;
    const double stiffness = g * k * std::tanh(k * depth);
    const std::complex<double> s =
        (-r + std::sqrt(std::complex<double>(r * r - 4.0 * inertia * stiffness))) / (2.0 * inertia);

    // The mean horizontal velocity, weighted with the shape of the wave, is its amplitude: d/dt of e^(s t).
    Flow<2> flow = make_flow<2>(spec);
    const auto amplitude = [&] {
      const Particles<2>& particles = flow.state.particles;
      return sum_over(particles.owned, 0.0, [&](std::size_t i) {
        if (!particles.is_fluid(i)) return 0.0;
        return particles.volume[i] * std::sin(k * particles.position[i][0]) * particles.velocity[i][0];
      });
    };
    const double start = amplitude();
    // u follows Re(B e^(st)) with u(0) = start and u'(0) = -r/(1+c) start, the surface being flat.
    const double slope = -r / inertia;
    const double cosine = start;
    const double sine = (slope - s.real()) * start / s.imag();
    double squares = 0.0;
    double count = 0.0;
    const double period = 2.0 * std::numbers::pi / s.imag();
    while (flow.state.time < 1.5 * period) {
      step(flow);
      const double t = flow.state.time;
      const double theory = std::exp(s.real() * t) * (cosine * std::cos(s.imag() * t) + sine * std::sin(s.imag() * t));
      squares += std::pow((amplitude() - theory) / start, 2);
      count += 1.0;
    }
    EXPECT_LT(std::sqrt(squares / count), 0.03) << a;
  }
}

std::string refusal_of(const CaseSpec& spec) {
  try {
    make_flow<2>(spec);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PorousTank2D, RefusesALayerInATankThatMoves) {
  CaseSpec spec = tank_case<2>(0.05, 1.0, 0.5);
  spec.walls[0].name = "tank";
  spec.porous = {layer_of({0.0, 0.0}, {1.0, 0.2}, 0.4, 1.0)};
  EXPECT_EQ(refusal_of(spec), "");
  spec.walls[0].displacement = {"0.1*sin(t)", 0.0};
  EXPECT_NE(refusal_of(spec).find("porous 'layer' lies at wall 'tank', which moves"), std::string::npos)
      << refusal_of(spec);
}

TEST(PorousTank2D, RefusesALayerOutsideOfTheCase) {
  CaseSpec spec = tank_case<2>(0.05, 1.0, 0.5);
  spec.porous = {layer_of({2.0, 0.0}, {3.0, 1.0}, 0.4, 1.0)};
  EXPECT_NE(refusal_of(spec).find("porous 'layer' reaches from (2, 0) to (3, 1), outside of the walls"),
            std::string::npos)
      << refusal_of(spec);
}

// Beyond a hole in a wall there is a lead of open water.
TEST(PorousTank2D, RefusesALayerBeyondAHole) {
  CaseSpec spec = tank_case<2>(0.05, 1.0, 0.5);
  WallTable floor;
  floor.points = {{0.0, 1.0}, {0.0, 0.0}, {1.0, 0.0}};
  WallTable above;
  above.points = {{1.0, 0.3}, {1.0, 1.0}};
  spec.walls = {floor, above};
  OutletTable outlet;
  outlet.name = "end";
  outlet.from = {1.0, 0.0};
  outlet.to = {1.0, 0.3};
  outlet.direction = {1.0, 0.0};
  outlet.level = 0.5;
  spec.outlets = {outlet};
  spec.porous = {layer_of({0.3, 0.0}, {1.0, 1.0}, 0.4, 1.0)};
  EXPECT_EQ(refusal_of(spec), "");
  spec.porous[0].max[0] = 1.2;  // beyond the opening
  EXPECT_NE(refusal_of(spec).find("outlet 'end': a porous layer is at"), std::string::npos) << refusal_of(spec);
}

constexpr double conduit_length = 0.4;  // m
constexpr double conduit_height = 0.2;  // m
constexpr double conduit_outlet = 0.4;  // m; level beyond
constexpr double conduit_head = 0.1;    // m; of the inlet over that

/// A conduit full of a layer, from its inlet to its outlet.
CaseSpec porous_conduit(double linear, double quadratic, Integrator integrator) {
  CaseSpec spec;
  spec.particles.spacing = 0.02;
  spec.scheme.integrator = integrator;
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {conduit_length, conduit_height};
  spec.fluid = {water};
  WallTable bottom;
  bottom.points = {{0.0, 0.0}, {conduit_length, 0.0}};
  WallTable top;
  top.points = {{conduit_length, conduit_height}, {0.0, conduit_height}};
  spec.walls = {bottom, top};
  spec.porous = {layer_of(water.min, water.max, 0.4, linear, quadratic)};
  InletTable inlet;
  inlet.from = {0.0, 0.0};
  inlet.to = {0.0, conduit_height};
  inlet.direction = {1.0, 0.0};
  inlet.level = conduit_outlet + conduit_head;
  spec.inlets = {inlet};
  OutletTable outlet;
  outlet.from = {conduit_length, 0.0};
  outlet.to = {conduit_length, conduit_height};
  outlet.direction = {1.0, 0.0};
  outlet.level = conduit_outlet;
  spec.outlets = {outlet};
  return spec;
}

/// Mean error [m] of the head in the middle of the conduit, where it falls evenly.
double head_error(const Flow<2>& flow) {
  const Particles<2>& particles = flow.state.particles;
  const Vec<2> nothing = Vec<2>::Zero();
  const Vec<2> sums = sum_over(particles.owned, nothing, [&](std::size_t i) {
    const Vec<2>& x = particles.position[i];
    if (!particles.is_fluid(i) || x[0] < 0.1 || x[0] > 0.3) return nothing;
    const double head = conduit_outlet + conduit_head * (1.0 - x[0] / conduit_length);
    return Vec<2>(particles.pressure[i] / (1000.0 * g) + x[1] - head, 1.0);
  });
  return sums[0] / sums[1];
}

class PorousConduit : public testing::TestWithParam<Integrator> {};

// The layer continues beyond both openings, so the flow is uniform and the head falls evenly, which the operators
// reproduce. The resistance has stopped every other flow after 1/r = 0.02 s.
TEST_P(PorousConduit, TakesTheHeadOfItsLawBetweenTwoLevels) {
  struct Law {
    double linear, quadratic, steady;
  };
  for (const Law law : {Law{20.0, 0.0, 0.0125}, Law{0.0, 400.0, 0.025}}) {
    Flow<2> flow = make_flow<2>(porous_conduit(law.linear, law.quadratic, GetParam()));
    start(flow);
    const double before = water_of(flow);
    while (flow.state.time < 1.0) pass_and_step(flow);
    EXPECT_NEAR(filter_velocity(flow, 0.1, 0.3) / law.steady, 1.0, 0.01) << law.linear;
    EXPECT_NEAR(head_error(flow), 0.0, 0.01 * conduit_head) << law.linear;
    EXPECT_GT(arrived_at(flow, 0).volume, 0.0);
    const double kept = water_of(flow) - arrived_at(flow, 0).volume + state_of_end(flow, 1).departed.volume;
    EXPECT_NEAR(kept / before, 1.0, 1e-6) << "water is counted in the pores, in single precision";
  }
}

// The discharge varies by 1 % while a column enters.
TEST_P(PorousConduit, TakesTheHeadOfItsLawWithADischarge) {
  CaseSpec spec = porous_conduit(20.0, 0.0, GetParam());
  spec.inlets[0].level.reset();
  spec.inlets[0].discharge = 0.0125 * conduit_height;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  while (flow.state.time < 1.0) pass_and_step(flow);
  EXPECT_NEAR(filter_velocity(flow, 0.1, 0.3) / 0.0125, 1.0, 0.02);
  EXPECT_NEAR(head_error(flow), 0.0, 0.01 * conduit_head);
}

constexpr std::array both{Integrator::explicit_projection, Integrator::implicit_projection};
INSTANTIATE_TEST_SUITE_P(Integrators, PluggedChannel, testing::ValuesIn(both));
INSTANTIATE_TEST_SUITE_P(Integrators, PorousConduit, testing::ValuesIn(both));

}  // namespace
}  // namespace tailwater
