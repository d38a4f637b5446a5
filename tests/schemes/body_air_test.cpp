// Bodies that float on water, on enclosed air, or on both.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "air/enclosed_air.h"
#include "bodies/floating_bodies.h"
#include "flow/measure.h"
#include "flow/stages.h"
#include "schemes/cases.h"
#include "schemes/oscillation.h"
#include "support/dimensions.h"
#include "support/record.h"

namespace tailwater {
namespace body_air_test {
namespace {

constexpr double atmosphere = 101325.0;

/// Adds the hull and its body, as the reader does.
void add_body(CaseSpec& spec, WallTable hull, double mass, const Coordinates& centre, double inertia,
              const std::vector<std::string>& free) {
  hull.name = "hull";
  hull.fluid_side = FluidSide::outside;
  hull.drive = {Drive::By::body, spec.bodies.size()};
  spec.walls.push_back(hull);
  BodyTable body;
  body.name = "body";
  body.walls = {hull.name};
  body.mass = mass;
  body.centre = centre;
  body.inertia = std::vector<double>(centre.size() == 2 ? 1 : 3, inertia);
  body.free = free;
  body.velocity = Coordinates(centre.size(), 0.0);
  spec.bodies.push_back(body);
}

WallTable box_of(const Coordinates& min, const Coordinates& max) {
  WallTable box;
  box.shape = WallShape::box;
  box.min = min;
  box.max = max;
  return box;
}

void start_pocket(CaseSpec& spec, const Coordinates& at, double overpressure) {
  spec.air.pockets = AirPockets::adiabatic;
  spec.pockets.resize(1);
  spec.pockets[0].at = at;
  spec.pockets[0].overpressure = overpressure;
}

template <int Dim>
const BodyState<Dim>& body_of(const Flow<Dim>& flow) {
  return flow.state.motion.bodies.each[0];
}

constexpr Integrator integrators[] = {Integrator::explicit_projection, Integrator::implicit_projection};

// A box as wide as its shaft encloses the air below it, which supports it. The box oscillates as a mass m on the spring
// n p A^2/V of the gas, with the supporting pressure p. The water below cannot move.
TEST(BodyOnAir, BouncesAsTheGasLawSays) {
  constexpr double dx = 0.025;
  constexpr double width = 0.2;
  constexpr double air = 0.4;
  constexpr double gap = 0.001;  // narrower than half a cell of the air
  constexpr double area = width - 2.0 * gap;
  constexpr double mass = 100.0;
  constexpr double speed = 0.02;
  for (const Integrator integrator : integrators) {
    CaseSpec spec = tank_case<2>(dx, width, 0.2);
    spec.scheme.integrator = integrator;
    spec.walls[0].max[1] = 1.2;
    add_body(spec, box_of({gap, 0.2 + air}, {width - gap, 0.4 + air}), mass, {0.5 * width, 0.3 + air}, 1.0, {"y"});
    spec.bodies[0].velocity = {0.0, -speed};
    const double carried = mass * g / area;
    start_pocket(spec, {0.5 * width, 0.4}, carried);
    Flow<2> flow = make_flow<2>(spec);
    start(flow);
    const double omega = std::sqrt(1.4 * (atmosphere + carried) * area * area / (mass * width * air));
    const double dt = 2.0 * std::numbers::pi / omega / 80.0;
    Oscillation oscillation(-speed);
    while (oscillation.turns() < 4 && flow.state.step < 400) {
      if (flow.state.step % 10 == 0) sort_particles(flow);
      advance(flow, dt);
      oscillation.add(flow.state.time, dt, body_of(flow).velocity[1]);
    }
    ASSERT_EQ(oscillation.turns(), 4U);
    const double error = oscillation.period() * omega / (2.0 * std::numbers::pi) - 1.0;
    EXPECT_NEAR(error, 0.0, 0.01);
    EXPECT_NEAR(oscillation.kept(), 1.0, 0.02);
    record_error("body_on_air_period", 2, dx, error);
  }
}

// Air of any pressure above all water of a closed tank only adds a uniform pressure. A box stays at its draught,
// although half of its surface is in water and half in air.
template <class D>
class BodyBelowAir : public testing::Test {};
TYPED_TEST_SUITE(BodyBelowAir, Dimensions);

TYPED_TEST(BodyBelowAir, StaysAtItsDraught) {
  constexpr int Dim = TypeParam::value;
  constexpr double dx = Dim == 2 ? 0.025 : 0.05;
  const double scale = dx / 0.025;
  for (const Integrator integrator : integrators) {
    if (Dim == 3 && integrator == Integrator::implicit_projection) continue;
    CaseSpec spec = tank_case<Dim>(dx, scale * (Dim == 2 ? 1.0 : 0.5), scale * 0.4);
    spec.scheme.integrator = integrator;
    spec.walls[0].open.clear();
    Coordinates min(Dim, scale * (Dim == 2 ? 0.35 : 0.1));
    Coordinates max(Dim, scale * (Dim == 2 ? 0.65 : 0.4));
    Coordinates centre(Dim, scale * (Dim == 2 ? 0.5 : 0.25));
    min[Dim - 1] = scale * 0.3;
    max[Dim - 1] = scale * 0.5;
    centre[Dim - 1] = scale * 0.4;
    const double mass = 500.0 * std::pow(scale * 0.3, Dim - 1) * scale * 0.2;
    const std::vector<std::string> free = Dim == 2 ? std::vector<std::string>{"x", "y", "rotation"}
                                                   : std::vector<std::string>{"x", "y", "z", "rotation_x"};
    add_body(spec, box_of(min, max), mass, centre, mass * 0.01 * scale * scale, free);
    Coordinates at(Dim, 2.0 * dx);
    at[Dim - 1] = scale * 0.7;
    start_pocket(spec, at, 5e3 * scale);
    Flow<Dim> flow = make_flow<Dim>(spec);
    start(flow);
    const Vec<Dim> drawn = bodies_of(flow).bodies[0].drawn.centre;
    double worst = 0.0;
    while (flow.state.time < (Dim == 2 ? 0.5 : 0.1)) {
      step(flow);
      worst = std::max(worst, (body_of(flow).centre - drawn).norm());
    }
    record_error("body_below_air_moves", Dim, dx, worst / dx);
    EXPECT_LT(worst, 0.1 * dx);
  }
}

/// A bell that is open below and floats on its enclosed air: legs of `thickness` on both sides of it.
struct Bell {
  double dx = 0.025;
  double width = 0.3;
  double thickness = 0.15;
  double bottom = 0.4;
  double surface = 0.6;  ///< of the water around the bell
  double level = 0.5;    ///< of the water in the bell
  double roof = 0.8;

  double overpressure() const { return 1000.0 * g * (surface - level); }
  /// kg/m; of the water that legs and air displace
  double mass() const { return 1000.0 * (2.0 * thickness * (surface - bottom) + width * (surface - level)); }
  double volume() const { return width * (roof - level); }

  CaseSpec spec() const {
    constexpr double tank = 1.2;
    CaseSpec spec = tank_case<2>(dx, tank, level);
    spec.walls[0].max[1] = 1.4;
    const double out = 0.5 * tank - 0.5 * width - thickness;
    const double in = out + thickness;
    for (const double x : {0.0, tank - out}) {
      FluidTable beside;
      beside.min = {x, level};
      beside.max = {x + out, surface};
      spec.fluid.push_back(beside);
    }
    WallTable hull;
    hull.shape = WallShape::polygon;
    const double top = roof + thickness;
    hull.points = {{out, bottom},        {in, bottom},         {in, roof},        {in + width, roof},
                   {in + width, bottom}, {tank - out, bottom}, {tank - out, top}, {out, top}};
    add_body(spec, hull, mass(), {0.5 * tank, 0.5}, 10.0, {"x", "y", "rotation"});
    start_pocket(spec, {0.5 * tank, 0.7}, overpressure());
    return spec;
  }
};

// The equilibrium by Archimedes' principle and the gas law.
TEST(Bell, StaysAtItsDraught) {
  const Bell bell;
  for (const Integrator integrator : integrators) {
    CaseSpec spec = bell.spec();
    spec.scheme.integrator = integrator;
    Flow<2> flow = make_flow<2>(spec);
    start(flow);
    const Vec<2> drawn = bodies_of(flow).bodies[0].drawn.centre;
    const auto energy = [&] {
      const BodyState<2>& body = body_of(flow);
      const double of_body =
          bodies_of(flow).bodies[0].mass * (0.5 * body.linear_velocity().squaredNorm() + g * body.centre[1]);
      return measure(flow).energy() + of_body + air_of(flow).measures().energy - air_of(flow).state.energy_set;
    };
    const double at_start = energy();
    double worst = 0.0;
    double rise = 0.0;
    while (flow.state.time < 0.5) {
      step(flow);
      worst = std::max(worst, (body_of(flow).centre - drawn).norm());
      rise = std::max(rise, energy() - at_start);
    }
    record_error("bell_moves", 2, bell.dx, worst / bell.dx);
    EXPECT_LT(worst, 0.1 * bell.dx);
    EXPECT_NEAR(air_of(flow).measures().pressure, bell.overpressure(), 0.03 * bell.overpressure());
    EXPECT_LT(rise, 1e-4 * at_start);
  }
}

// A vent in the roof moves with the bell and lets the air out: the bell sinks, and the water in it rises.
TEST(Bell, SinksWithAVentInItsRoof) {
  const Bell bell;
  CaseSpec spec = bell.spec();
  spec.bodies[0].free = {"y"};
  VentTable vent;
  vent.at = {0.6, bell.roof};
  vent.area = 5e-3;
  spec.vents = {vent};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  const double drawn = body_of(flow).centre[1];
  const double gas = air_of(flow).measures().gas;
  while (flow.state.time < 0.3) step(flow);
  EXPECT_LT(body_of(flow).centre[1], drawn - bell.dx);
  const AirState& air = air_of(flow).state;
  EXPECT_NEAR(air_of(flow).measures().gas + air.gas_vented + air.gas_lost, gas, 1e-12 * gas);
  EXPECT_GT(air.gas_vented, 0.2 * gas);
}

// A piston displaces water and air in a closed tank. Water keeps its volume, so the volume of the air decreases by the
// whole volume of the piston's displacement, including the part beside the water.
TEST(Piston, PressesTheAirBesideTheWaterItDrives) {
  constexpr double dx = 0.025;
  constexpr double height = 0.4;
  constexpr double gap = 0.001;  // narrower than half a cell of the air
  constexpr double speed = 0.1;
  for (const Integrator integrator : integrators) {
    CaseSpec spec = tank_case<2>(dx, 0.6, 0.5 * height);
    spec.scheme.integrator = integrator;
    spec.walls[0].open.clear();
    WallTable piston = box_of({gap, gap}, {0.2, height - gap});
    piston.fluid_side = FluidSide::outside;
    piston.displacement = VectorField(2, 0.0);
    piston.displacement[0] = "0.1*t";
    spec.walls.push_back(piston);
    spec.air.pockets = AirPockets::adiabatic;
    Flow<2> flow = make_flow<2>(spec);
    start(flow);
    ASSERT_EQ(air_of(flow).state.pockets.size(), 1U);
    const double volume = air_of(flow).measures().volume;
    while (flow.state.time < 0.2) step(flow);
    const double taken = speed * flow.state.time * (height - 2.0 * gap);
    const double change = volume - air_of(flow).measures().volume;
    EXPECT_NEAR(change / taken, 1.0, 0.03);
  }
}

}  // namespace
}  // namespace body_air_test
}  // namespace tailwater
