// Water at rest. Below the surface p is linear, which the operators differentiate exactly on a lattice up to a factor.
// The position of p = 0 is known only to dx, so every pressure is within rho g dx of the hydrostatic one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "schemes/cases.h"
#include "support/dimensions.h"

namespace tailwater {
namespace tank_test {

constexpr double dx = 0.05;

template <class D>
class TankTest : public testing::Test {};
TYPED_TEST_SUITE(TankTest, Dimensions);

template <int Dim>
void expect_hydrostatic(const Flow<Dim>& flow, double depth) {
  const double unit = flow.setup.liquid.density * g * flow.setup.scale.spacing;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (!flow.state.particles.is_fluid(i)) continue;
    const double height = flow.state.particles.position[i][Dim - 1];
    EXPECT_LT(std::abs(flow.state.particles.pressure[i] - flow.setup.liquid.density * g * (depth - height)), unit)
        << "at " << height;
  }
}

TYPED_TEST(TankTest, StaysAtRestForFiftySteps) {
  constexpr int Dim = TypeParam::value;
  const double width = Dim == 2 ? 1.0 : 0.4;
  const double depth = Dim == 2 ? 0.5 : 0.3;
  for (const auto& [name, integrator] : {std::pair{SchemeName::farzin2014, Integrator::explicit_projection},
                                         std::pair{SchemeName::farzin2014, Integrator::implicit_projection},
                                         std::pair{SchemeName::farmani2020, Integrator::explicit_projection}}) {
    CaseSpec spec = tank_case<Dim>(dx, width, depth);
    spec.scheme.name = name;
    spec.scheme.integrator = integrator;
    if (name == SchemeName::farmani2020) apply_formulation(spec.scheme);
    Flow<Dim> flow = make_flow<Dim>(spec);
    const std::size_t count = flow.state.particles.owned;
    // Only the three rows whose support the surface cuts can be unbalanced, by g at most, for a quarter of the shortest
    // wave's period, omega^2 = g pi/dx: speed g/omega.
    const double settling = std::sqrt(g * dx / std::numbers::pi);
    const double mass = flow.setup.liquid.density * depth * std::pow(width, Dim - 1);
    const double kinetic_bound = 0.5 * mass * settling * settling * 3.0 * dx / depth;
    for (int n = 0; n < 50; ++n) {
      EXPECT_EQ(step(flow).interventions.stopped_at_walls, 0u);
      const FlowMeasures measures = measure(flow);
      ASSERT_LT(measures.largest_speed, settling);
      ASSERT_LT(measures.kinetic_energy, kinetic_bound);
      if (n == 0) expect_hydrostatic<Dim>(flow, depth);
    }
    EXPECT_EQ(flow.state.particles.owned, count);
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      if (!flow.state.particles.is_fluid(i)) continue;
      EXPECT_GT(flow.walls.boundary.nearest(flow.state.particles.position[i], 1.0).signed_distance, 0.0);
    }
    expect_hydrostatic<Dim>(flow, depth);
  }
}

// Disorder weakens the pressure of water, but the matrix must not amplify this beyond the effect on the force. With the
// missing weights of disordered rows as air, the pressure at the bottom was 2.5 or 2.0 times the weight at this time,
// after it had been almost 0.
TEST(JitteredTank, CarriesItsWeightAfterAFewSteps) {
  constexpr double depth = 1.0;
  constexpr double spacing = 0.01;
  for (const Integrator integrator : {Integrator::explicit_projection, Integrator::implicit_projection}) {
    CaseSpec spec = tank_case<2>(spacing, 0.3, depth);
    spec.particles.jitter = 0.1;
    spec.scheme.integrator = integrator;
    apply_formulation(spec.scheme);
    Flow<2> flow = make_flow<2>(spec);
    const double energy_at_start = measure(flow).energy();
    while (flow.state.time < 0.02) step(flow);
    double pressure = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      if (!flow.state.particles.is_fluid(i) || flow.state.particles.position[i][1] > 2.0 * spacing) continue;
      pressure += flow.state.particles.pressure[i];
      ++count;
    }
    // Observed, not derived: 1.00 of the weight (explicit), still settling; the target excludes the failure above.
    EXPECT_NEAR(pressure / count, flow.setup.liquid.density * g * depth, 0.5 * flow.setup.liquid.density * g * depth);
    // Observed, not derived: shifting and the correction of too light water lower the energy of a disordered block by
    // 1.5e-3. With disorder as air, before the matrix took its diagonal from the force, it was 1.9e-3. The target lies
    // between.
    EXPECT_GT(measure(flow).energy(), (1.0 - 1.7e-3) * energy_at_start);
  }
}

TEST(PublishedTank, StaysHydrostatic) {
  for (const Integrator integrator : {Integrator::explicit_projection, Integrator::implicit_projection}) {
    const double depth = 0.5;
    CaseSpec spec = tank_case<2>(dx, 1.0, depth);
    spec.scheme.formulation = Formulation::published;
    spec.scheme.integrator = integrator;
    apply_formulation(spec.scheme);
    Flow<2> flow = make_flow<2>(spec);
    const std::size_t count = flow.state.particles.owned;
    for (int n = 0; n < 10; ++n) {
      const StepReport report = step(flow);
      if (integrator == Integrator::explicit_projection) {
        ASSERT_EQ(report.passes, 1);
      } else {                        // the whole step is repeated until the pressure settles to 1e-3, 30 times at most
        ASSERT_GE(report.passes, 2);  // the first pass cannot detect that it has settled
        ASSERT_LE(report.passes, 30);
        if (report.passes < 30) {
          ASSERT_LT(report.pressure_change, 1e-3);
        }
      }
      expect_hydrostatic<2>(flow, depth);
    }
    EXPECT_EQ(flow.state.particles.owned, count);
  }
}

// Water that fills its box has no surface that would fix its pressure. The pressure stays that of water at rest, with
// its minimum 0. The speed stays below the settling speed of a tank with a surface.
TYPED_TEST(TankTest, FullOfWaterStaysAtRest) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = tank_case<Dim>(0.1, 1.0, 1.0);
  if (Dim == 3) spec.fluid[0].max[1] = 0.5;
  spec.walls[0].max = spec.fluid[0].max;
  spec.walls[0].open = {};
  Flow<Dim> flow = make_flow<Dim>(spec);
  start(flow);
  const double settling = std::sqrt(g * 0.1 / std::numbers::pi);
  const double weight = flow.setup.liquid.density * g * 1.0;
  while (flow.state.time < 1.5) {
    step(flow);
    ASSERT_LT(measure(flow).largest_speed, settling) << "t = " << flow.state.time;
    double highest = 0.0;
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      if (flow.state.particles.is_fluid(i)) highest = std::max(highest, flow.state.particles.pressure[i]);
    }
    ASSERT_LT(highest, 2.0 * weight) << "t = " << flow.state.time;
  }
}

}  // namespace tank_test
}  // namespace tailwater
