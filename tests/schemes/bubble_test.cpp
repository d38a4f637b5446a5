// A half cylinder of air at a wall, under water, pulsates like the air that a breaking wave encloses (Topliss, Cooker
// and Peregrine 1992). The water around it moves as around a line source at the wall, at the depth d below a surface
// that keeps its pressure and above a floor, H deep. The images of such a source of strength q in the half plane give
// the potential at the small distance R,
//
//   phi = -q/pi ln(4 H/(pi R) tan(pi d/(2 H))),
//
// so the kinetic energy is rho q^2/(2 pi) times this logarithm. The gas has the stiffness n p_0/V, V = pi R^2/2.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "air/enclosed_air.h"
#include "flow/measure.h"
#include "flow/stages.h"
#include "schemes/cases.h"
#include "schemes/oscillation.h"
#include "support/record.h"

namespace tailwater {
namespace bubble_test {
namespace {

using std::numbers::pi;

constexpr double dx = 1.0 / 60.0;
constexpr double radius = 6.0 * dx;
constexpr double water_depth = 0.6;
constexpr double length = 0.9;  ///< m; images by the far wall would increase the logarithm by 2 %

CaseSpec bubble_at_wall(double depth) {
  CaseSpec spec = tank_case<2>(dx, length, water_depth);
  spec.physics.gravity = {0.0, 0.0};
  FluidTable& water = spec.fluid[0];
  water.shape = BlockShape::polygon;
  const double middle = water_depth - depth;
  water.points = {{0.0, 0.0}, {length, 0.0}, {length, water_depth}, {0.0, water_depth}};
  constexpr int sides = 32;
  for (int k = 0; k <= sides; ++k) {
    const double angle = pi * (0.5 - static_cast<double>(k) / sides);
    water.points.push_back({radius * std::max(0.0, std::cos(angle)), middle + radius * std::sin(angle)});
  }
  water.min.clear();
  water.max.clear();
  spec.air.pockets = AirPockets::adiabatic;
  PocketTable start;
  start.at = {0.5 * radius, middle};
  start.overpressure = 1000.0;
  spec.pockets = {start};
  return spec;
}

double exact_frequency(double volume, double depth) {
  const double R = std::sqrt(2.0 * volume / pi);
  const double log = std::log(4.0 * water_depth / (pi * R) * std::tan(0.5 * pi * depth / water_depth));
  return std::sqrt(1.4 * 101325.0 * pi / (1000.0 * volume * log));
}

/// Ratio to the exact frequency, less 1.
double error_of_frequency(const CaseSpec& spec, double depth) {
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  const AirPocket& pocket = air_of(flow).state.pockets.at(0);
  const double period = 2.0 * pi / exact_frequency(pocket.gas, depth);
  const double dt = period / 40.0;
  Oscillation oscillation(air_of(flow).measures().pressure);
  while (oscillation.turns() < 2 && flow.state.step < 150) {
    if (flow.state.step % 10 == 0) sort_particles(flow);
    advance(flow, dt);
    oscillation.add(flow.state.time, dt, air_of(flow).measures().pressure);
  }
  return oscillation.turns() == 2 ? period / oscillation.period() - 1.0 : -1.0;
}

// Within 10 %; the source is small compared with the depth.
TEST(BubbleAtWall, PulsatesWithTheWaterAroundIt) {
  for (const double depth : {0.2, 0.4}) {
    const double error = error_of_frequency(bubble_at_wall(depth), depth);
    EXPECT_NEAR(error, 0.0, 0.1) << depth;
    record_error("bubble_at_wall_frequency", 2, depth, error);
  }
  CaseSpec two_step = bubble_at_wall(0.3);
  two_step.scheme.name = SchemeName::farmani2020;
  apply_formulation(two_step.scheme);
  EXPECT_NEAR(error_of_frequency(two_step, 0.3), 0.0, 0.1);
}

}  // namespace
}  // namespace bubble_test
}  // namespace tailwater
