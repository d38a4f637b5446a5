// Pockets of air that water compresses. A column of water, h high, on a closed column of air, a high, without gravity
// moves in one dimension:
//
//   rho h y'' = P(y),    P = p_0 ((a/y)^n - 1)
//
// where y is the height of the air. Small oscillations have omega^2 = n p_0/(rho h a).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "flow/measure.h"
#include "flow/verbs.h"
#include "schemes/cases.h"
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

/// The water stands on the air, and moves down with `speed`.
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

struct Oscillation {
  double period = 0.0;
  double kept = 0.0;  ///< of the largest velocity, per period
  double volume_error = 0.0;
};

/// Over `periods` of the column's small oscillations, in steps of a fraction of one.
template <int Dim>
Oscillation oscillate(double dx, double width, const Order& order, int periods, int steps_per_period) {
  const double omega = std::sqrt(1.4 * atmosphere / (density * water_height * air_height));
  const double period = 2.0 * std::numbers::pi / omega;
  const double speed = 0.001 * air_height * omega;
  Flow<Dim> flow = make_flow<Dim>(column<Dim>(dx, width, order, speed));
  const double dt = period / steps_per_period;
  std::vector<double> crossings;
  std::vector<double> largest;  // between them
  double before = -speed;
  double most = speed;
  for (int n = 0; n < periods * steps_per_period; ++n) {
    if (n % 10 == 0) sort_particles(flow);
    advance(flow, dt);
    const double now = mean_velocity(flow);
    if (before < 0.0 && now >= 0.0) {
      crossings.push_back(flow.state.time - dt * now / (now - before));
      largest.push_back(most);
      most = 0.0;
    }
    most = std::max(most, std::abs(now));
    before = now;
  }
  Oscillation found;
  if (crossings.size() < 3) return found;
  const auto rounds = static_cast<double>(crossings.size() - 1);
  found.period = (crossings.back() - crossings.front()) / rounds / period;
  found.kept = std::pow(largest.back() / largest[1], 1.0 / (rounds - 1.0));
  return found;
}

template <class D>
class AirColumn : public testing::Test {};
TYPED_TEST_SUITE(AirColumn, Dimensions);

// The operators are of first order in the outermost rows: where the water has the pressure of the air is known no
// better than dx, at both surfaces. So the gradient in water h high is P/h to a share of 2 dx/h, and the period to
// dx/h.
TYPED_TEST(AirColumn, OscillatesAsTheGasLawSays) {
  constexpr int Dim = TypeParam::value;
  const double dx = Dim == 2 ? 0.025 : 0.05;
  for (const Order& order : orders) {
    if (Dim == 3 && order.integrator == Integrator::implicit_projection) continue;
    const Oscillation found = oscillate<Dim>(dx, Dim == 2 ? 0.2 : 0.25, order, 4, 40);
    EXPECT_NEAR(found.period, 1.0, dx / water_height)
        << static_cast<int>(order.name) << static_cast<int>(order.integrator);
    EXPECT_GT(found.kept, 0.5);
    EXPECT_LT(found.kept, 1.0);  // it gains nothing
    record_error("air_column_period", Dim, dx, found.period - 1.0);
  }
}

// Air above water in a closed tank is at rest with it. A lattice that settles lifts the surface by no more than dx/10,
// from where on a run warns of its energy.
TYPED_TEST(AirColumn, RestsAboveWaterAtRest) {
  constexpr int Dim = TypeParam::value;
  for (const Order& order : orders) {
    CaseSpec spec = tank_case<Dim>(0.05, 0.5, 0.3);
    spec.walls[0].open.clear();
    spec.air.pockets = AirPockets::adiabatic;
    spec.scheme.name = order.name;
    spec.scheme.integrator = order.integrator;
    apply_formulation(spec.scheme);
    Flow<Dim> flow = make_flow<Dim>(spec);
    start(flow);
    ASSERT_EQ(flow.state.air.pockets.size(), 1u);
    const double volume = flow.state.air.pockets[0].volume;
    spec.air.pockets = AirPockets::none;
    Flow<Dim> without = make_flow<Dim>(spec);
    start(without);
    double work = 0.0;
    for (int n = 0; n < 20; ++n) {
      work += step(flow).work.air;
      step(without);
    }
    ASSERT_EQ(flow.state.air.pockets.size(), 1u);
    EXPECT_EQ(flow.state.air.pockets[0].number, 0);
    const double lift = 0.1 * 0.05;
    EXPECT_NEAR(flow.state.air.pockets[0].volume, volume, lift * std::pow(0.5, Dim - 1));
    const double energy = measure(without).energy();
    EXPECT_LE(measure(flow).energy() - work, energy + lift * g * density * 0.3 * std::pow(0.5, Dim - 1));
  }
}

}  // namespace
}  // namespace tailwater
