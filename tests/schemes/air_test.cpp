// Pockets of air that water compresses. A column of water of height h on a closed column of air of height a, without
// gravity, moves in one dimension:
//
//   rho h y'' = P(y),    P = p_0 ((a/y)^n - 1)
//
// where y is the height of the air. Small oscillations have omega^2 = n p_0/(rho h a).
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "air/enclosed_air.h"
#include "flow/measure.h"
#include "flow/stages.h"
#include "schemes/cases.h"
#include "schemes/oscillation.h"
#include "support/dimensions.h"
#include "support/record.h"

namespace tailwater {
namespace {

constexpr double air_height = 0.4;
constexpr double water_height = 0.5;
constexpr double atmosphere = 101325.0;
constexpr double density = 1000.0;

struct Order {
  SchemeName name;
  Integrator integrator;
};
constexpr Order orders[] = {{SchemeName::farzin2014, Integrator::explicit_projection},
                            {SchemeName::farzin2014, Integrator::implicit_projection},
                            {SchemeName::farmani2020, Integrator::explicit_projection}};

/// The water lies on the air and moves down with `speed`.
template <int Dim>
CaseSpec column(double dx, double width, const Order& order, double speed) {
  CaseSpec spec = tank_case<Dim>(dx, width, 1.0);
  spec.physics.gravity = Coordinates(Dim, 0.0);
  spec.fluid[0].min[Dim - 1] = air_height;
  spec.fluid[0].max[Dim - 1] = air_height + water_height;
  spec.fluid[0].velocity = VectorField(Dim, 0.0);
  spec.fluid[0].velocity[Dim - 1] = -speed;
  spec.walls[0].max[Dim - 1] = 1.5;
  spec.air.pockets = AirPockets::adiabatic;
  spec.scheme.name = order.name;
  spec.scheme.integrator = order.integrator;
  apply_formulation(spec.scheme);
  return spec;
}

/// The column between periodic sides, without walls: it moves in one dimension. A ledge far above the water determines
/// the height of the air.
template <int Dim>
CaseSpec free_column(double dx, double width, const Order& order, double speed) {
  CaseSpec spec = column<Dim>(dx, width, order, speed);
  spec.domain.periodic_x = {0.0, width};
  if (Dim == 3) spec.domain.periodic_y = {0.0, width};
  const auto faces =
      Dim == 2 ? std::vector<std::string>{"-x", "+x", "+y"} : std::vector<std::string>{"-x", "+x", "-y", "+y", "+z"};
  spec.walls[0].open = faces;
  WallTable ledge;
  ledge.shape = WallShape::box;
  ledge.fluid_side = FluidSide::outside;
  ledge.min.assign(Dim, 0.4 * width);
  ledge.max.assign(Dim, 0.6 * width);
  ledge.min[Dim - 1] = 1.4;
  ledge.max[Dim - 1] = 1.5;
  spec.walls.push_back(ledge);
  return spec;
}

template <int Dim>
double mean_velocity(const Flow<Dim>& flow) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (!flow.state.particles.is_fluid(i)) continue;
    sum += flow.state.particles.velocity[i][Dim - 1];
    ++count;
  }
  return sum / count;
}

/// The motion of the column by the differential equation, with negligibly short steps.
struct Exact {
  double period = 0.0;            ///< s
  double largest_pressure = 0.0;  ///< Pa
  double impulse_time = 0.0;      ///< s; with more than half of the largest pressure
};
Exact exact_motion(double speed) {
  constexpr double dt = 1e-6;
  std::vector<double> pressures;  // until the water turns
  std::vector<double> turns;
  double y = air_height;
  double v = -speed;
  for (int n = 0; turns.size() < 2; ++n) {
    const double before = v;
    const double pressure = atmosphere * (std::pow(air_height / y, 1.4) - 1.0);
    if (turns.empty()) pressures.push_back(pressure);
    v += dt * pressure / (density * water_height);
    y += dt * v;
    if (before < 0.0 && v >= 0.0) turns.push_back(n * dt);
  }
  Exact exact{.period = turns[1] - turns[0], .largest_pressure = pressures.back()};
  for (const double pressure : pressures) {
    if (pressure > 0.5 * exact.largest_pressure) exact.impulse_time += 2.0 * dt;
  }
  return exact;
}

struct Motion {
  double period = 0.0;            ///< s
  double kept = 0.0;              ///< of the largest velocity, per period
  double energy_rise = 0.0;       ///< of water and gas, over their initial energy
  double largest_pressure = 0.0;  ///< Pa
  double impulse_time = 0.0;      ///< s; with more than `half_pressure`
};

/// Energy [J] of water and gas, including the energy lost in vents, without that added by volume corrections. Where
/// water moves with its new velocity, its position is half a step of dt ahead: the potential energy is that of half a
/// step before.
template <int Dim>
double energy_of_all(const Flow<Dim>& flow, double dt) {
  const double ahead = flow.setup.formulation.moves_with_mean_velocity ? 0.0 : 0.5 * dt * mean_velocity(flow);
  const double weight = -fluid_sums_of_rank(flow).mass * flow.setup.gravity[Dim - 1];
  const AirState& air = air_of(flow).state;
  return measure(flow).energy() - weight * ahead + air_of(flow).measures().energy + air.energy_vented - air.energy_set;
}

/// Moves the column for a number of small oscillations, in steps of a fraction of one.
template <int Dim>
Motion move_column(const CaseSpec& spec, double periods, int steps_per_period, double half_pressure) {
  const double omega = std::sqrt(1.4 * atmosphere / (density * water_height * air_height));
  const double dt = 2.0 * std::numbers::pi / omega / steps_per_period;
  Flow<Dim> flow = make_flow<Dim>(spec);
  Oscillation oscillation(mean_velocity(flow));
  Motion found;
  const double first_energy = energy_of_all(flow, dt);
  double min_energy = first_energy;
  for (int n = 0; n < periods * steps_per_period; ++n) {
    if (n % 10 == 0) sort_particles(flow);
    advance(flow, dt);
    const double energy = energy_of_all(flow, dt);
    found.energy_rise = std::max(found.energy_rise, (energy - min_energy) / first_energy);
    min_energy = std::min(min_energy, energy);
    const double pressure = air_of(flow).measures().pressure;
    found.largest_pressure = std::max(found.largest_pressure, pressure);
    if (oscillation.turns() < 2 && pressure > half_pressure) found.impulse_time += dt;
    oscillation.add(flow.state.time, dt, mean_velocity(flow));
  }
  if (oscillation.turns() < 3) return found;
  found.period = oscillation.period();
  found.kept = oscillation.kept();
  return found;
}

constexpr double periods = 2.3;  // water that moves down turns upwards for the third time after 2.25

template <class D>
class AirColumn : public testing::Test {};
TYPED_TEST_SUITE(AirColumn, Dimensions);

// The force on the water is P times the area, and the volume of the air is the rest of the tank. Water and gas gain no
// energy; largest velocities are read every dt, which misses (omega dt)^2/8 at most.
TYPED_TEST(AirColumn, OscillatesAsTheGasLawSays) {
  constexpr int Dim = TypeParam::value;
  constexpr double dx = Dim == 2 ? 0.025 : 0.05;
  constexpr double speed = 0.01;
  constexpr int steps = 80;
  for (const Order& order : orders) {
    if (Dim == 3 && &order != &orders[0]) continue;
    const Motion found =
        move_column<Dim>(free_column<Dim>(dx, Dim == 2 ? 0.2 : 0.35, order, speed), periods, steps, 0.0);
    const double error = found.period / exact_motion(speed).period - 1.0;
    const std::string which = fmt::format("{} {}", name_of(order.name), name_of(order.integrator));
    EXPECT_NEAR(error, 0.0, 0.002) << which;
    EXPECT_GT(found.kept, 0.995) << which;
    EXPECT_LT(found.kept, 1.001) << which;
    EXPECT_LT(found.energy_rise, 1e-4) << which;
    record_error("air_column_period", Dim, dx, error);
    record_error("air_column_kept", Dim, dx, found.kept - 1.0);
  }
}

// Where a wall meets the surface, the air pressure of dummies above the water is extrapolated from the water below,
// which reduces the force by some 0.2 %. The volume follows the force, so the whole difference appears in the period,
// and water and gas gain no energy.
TYPED_TEST(AirColumn, OscillatesBetweenWalls) {
  constexpr int Dim = TypeParam::value;
  constexpr double dx = 0.025;
  constexpr double speed = 0.01;
  for (const Order& order : orders) {
    if (Dim == 3 && &order != &orders[0]) continue;
    const Motion found = move_column<Dim>(column<Dim>(dx, 0.2, order, speed), periods, 80, 0.0);
    const std::string which = fmt::format("{} {}", name_of(order.name), name_of(order.integrator));
    const double error = found.period / exact_motion(speed).period - 1.0;
    EXPECT_NEAR(error, 0.0, 0.003) << which;
    EXPECT_NEAR(found.kept, 1.0, 0.002) << which;
    EXPECT_LT(found.energy_rise, 1e-4) << which;
    record_error("air_column_between_walls_period", Dim, dx, error);
    record_error("air_column_between_walls_kept", Dim, dx, found.kept - 1.0);
    record_error("air_column_between_walls_energy_rise", Dim, dx, found.energy_rise);
  }
}

// Bagnold's (1939) cushion: the column falls onto the air, at the speeds of falls from 0.2 to 5 m. A pocket that begins
// while water closes it at full speed may add no energy. The fastest column rebounds at 65 g, at which any disturbance
// grows: with 400 steps instead of 800 it gains 4e-4 after its turn.
TEST(AirCushion, HasThePressureAndTheDurationOfBagnolds) {
  for (const double speed : {2.0, 6.0, 10.0}) {
    for (const Order& order : orders) {
      if (speed != 6.0 && &order != &orders[0]) continue;
      const Exact exact = exact_motion(speed);
      const double half = 0.5 * exact.largest_pressure;
      const Motion between_walls = move_column<2>(column<2>(0.025, 0.2, order, speed), 0.4, 800, half);
      EXPECT_NEAR(between_walls.largest_pressure / exact.largest_pressure, 1.0, 0.01) << speed;
      EXPECT_NEAR(between_walls.impulse_time / exact.impulse_time, 1.0, 0.03) << speed;
      EXPECT_LT(between_walls.energy_rise, 1e-4) << speed;
      record_error("air_cushion_between_walls_time", 2, speed, between_walls.impulse_time / exact.impulse_time - 1.0);
      record_error("air_cushion_between_walls_energy_rise", 2, speed, between_walls.energy_rise);
      const Motion found = move_column<2>(free_column<2>(0.025, 0.2, order, speed), 0.4, 800, half);
      EXPECT_NEAR(found.largest_pressure / exact.largest_pressure, 1.0, 0.01) << speed;
      EXPECT_NEAR(found.impulse_time / exact.impulse_time, 1.0, 0.03) << speed;
      EXPECT_LT(found.energy_rise, 1e-4) << speed;
      record_error("air_cushion_energy_rise", 2, speed, found.energy_rise);
      record_error("air_cushion_pressure", 2, speed, found.largest_pressure / exact.largest_pressure - 1.0);
      record_error("air_cushion_time", 2, speed, found.impulse_time / exact.impulse_time - 1.0);
    }
  }
}

/// The column falls onto air that leaves through a vent, by P = zeta/2 rho_a u^2 for the velocity u in the vent.
struct Fall {
  double velocity = 0.0;  ///< m/s
  double height = air_height;
  double gas = air_height;  ///< m; per area

  double pressure() const { return atmosphere * (std::pow(gas / height, 1.4) - 1.0); }
  void go_on(double dt, double opening) {
    constexpr double air_density = atmosphere / (287.05 * 293.15);
    velocity += dt * (pressure() / (density * water_height) - g);
    height += dt * velocity;
    gas -= dt * opening * std::copysign(std::sqrt(2.0 * std::abs(pressure()) / air_density), pressure());
  }
};

// The air is compressible and the vent small: the column bounces, and then sinks at the speed at which its weight
// drives the air out. Its energy loss is that in the vent. Including this loss, water and gas gain no more than 1e-4 of
// the available energy, which is that of a fall by half of the water's height (pressure/energy.cpp).
TEST(VentedColumn, SinksAsTheDifferentialEquationSays) {
  constexpr double width = 0.2;
  constexpr double area = 2e-3;
  constexpr double dt = 2e-3;
  for (const Order& order : orders) {
    CaseSpec spec = free_column<2>(0.025, width, order, 0.0);
    spec.physics.gravity = {0.0, -g};
    VentTable vent;
    vent.at = {0.5 * width, 0.0};
    vent.area = area;
    vent.loss = 4.0;
    spec.vents = {vent};
    Flow<2> flow = make_flow<2>(spec);
    start(flow);
    const double energy = energy_of_all(flow, dt);
    Fall exact;
    double error_of_velocity = 0.0;
    double error_of_pressure = 0.0;
    double largest_velocity = 0.0;
    double largest_pressure = 0.0;
    double min_energy = energy;
    double energy_rise = 0.0;
    while (flow.state.time < 0.3) {
      if (flow.state.step % 10 == 0) sort_particles(flow);
      advance(flow, dt);
      const double energy_now = energy_of_all(flow, dt);
      energy_rise = std::max(energy_rise, energy_now - min_energy);
      min_energy = std::min(min_energy, energy_now);
      for (int n = 0; n < 200; ++n) exact.go_on(dt / 200.0, area / std::sqrt(vent.loss) / width);
      largest_velocity = std::max(largest_velocity, std::abs(exact.velocity));
      largest_pressure = std::max(largest_pressure, exact.pressure());
      error_of_velocity = std::max(error_of_velocity, std::abs(mean_velocity(flow) - exact.velocity));
      error_of_pressure = std::max(error_of_pressure, std::abs(air_of(flow).measures().pressure - exact.pressure()));
    }
    const std::string which = fmt::format("{} {}", name_of(order.name), name_of(order.integrator));
    EXPECT_LT(error_of_velocity, 0.02 * largest_velocity) << which;
    EXPECT_LT(error_of_pressure, 0.02 * largest_pressure) << which;
    const double lost = energy - measure(flow).energy() - air_of(flow).measures().energy;
    EXPECT_NEAR(air_of(flow).state.energy_vented / lost, 1.0, 0.02) << which;
    EXPECT_LT(energy_rise, 1e-4 * 0.5 * density * width * water_height * g * water_height) << which;
    record_error("vented_column_energy_rise", 2, 0.025, energy_rise / (0.5 * density * width * g * 0.25));
    record_error("vented_column_velocity", 2, 0.025, error_of_velocity / largest_velocity);
    record_error("vented_column_pressure", 2, 0.025, error_of_pressure / largest_pressure);
  }
}

// Air above water at rest in a closed tank is at rest as well. A lattice that settles lifts the surface by no more than
// dx/10, above which a run warns of its energy.
TYPED_TEST(AirColumn, RestsAboveWaterAtRest) {
  constexpr int Dim = TypeParam::value;
  for (const Order& order : orders) {
    if (Dim == 3 && &order != &orders[0]) continue;
    CaseSpec spec = tank_case<Dim>(0.05, 0.5, 0.3);
    spec.walls[0].open.clear();
    spec.air.pockets = AirPockets::adiabatic;
    spec.scheme.name = order.name;
    spec.scheme.integrator = order.integrator;
    apply_formulation(spec.scheme);
    Flow<Dim> flow = make_flow<Dim>(spec);
    start(flow);
    ASSERT_EQ(air_of(flow).state.pockets.size(), 1u);
    const double volume = air_of(flow).state.pockets[0].volume;
    spec.air.pockets = AirPockets::none;
    Flow<Dim> without = make_flow<Dim>(spec);
    start(without);
    double work = 0.0;
    for (int n = 0; n < 20; ++n) {
      work += step(flow).work.air;
      step(without);
    }
    ASSERT_EQ(air_of(flow).state.pockets.size(), 1u);
    EXPECT_EQ(air_of(flow).state.pockets[0].number, 0);
    const double lift = 0.1 * 0.05;
    EXPECT_NEAR(air_of(flow).state.pockets[0].volume, volume, lift * std::pow(0.5, Dim - 1));
    const double energy = measure(without).energy();
    EXPECT_LE(measure(flow).energy() - work, energy + lift * g * density * 0.3 * std::pow(0.5, Dim - 1));
  }
}

// A pocket in the closed leg of a U-tube, at rest. A lattice that settles moves its surface by dx/10 at most.
TEST(ClosedLeg, KeepsItsVolumeAtRest) {
  constexpr double dx = 0.05;
  CaseSpec spec;
  spec.particles.spacing = dx;
  WallTable tube;  // open on the right
  tube.points = {{0.7, 1.0}, {0.7, 0.3}, {0.3, 0.3}, {0.3, 1.0}, {0.0, 1.0}, {0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}};
  tube.fluid_side = FluidSide::left;
  spec.walls = {tube};
  FluidTable left;
  left.min = {0.0, 0.0};
  left.max = {0.3, 0.7};
  FluidTable middle;
  middle.min = {0.3, 0.0};
  middle.max = {0.7, 0.3};
  FluidTable right;
  right.min = {0.7, 0.0};
  right.max = {1.0, 0.7};
  spec.fluid = {left, middle, right};
  spec.air.pockets = AirPockets::adiabatic;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  const double air = 0.3 * 0.3;
  while (flow.state.time < 1.0) {
    step(flow);
    ASSERT_EQ(air_of(flow).state.pockets.size(), 1u);
    EXPECT_NEAR(air_of(flow).state.pockets[0].volume, air, 0.01 * air);
  }
  EXPECT_EQ(air_of(flow).state.pockets[0].number, 0);
  EXPECT_EQ(air_of(flow).state.gas_lost, 0.0);
}

}  // namespace
}  // namespace tailwater
