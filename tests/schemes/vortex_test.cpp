// Taylor-Green vortex in a doubly periodic square of edge 1, U = 1, Re = 100: u = e^(-2 nu k^2 t) (sin kx cos ky, - cos
// kx sin ky), k = 2 pi, so the kinetic energy falls as exp(-4 nu k^2 t).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "schemes/cases.h"

namespace tailwater {
namespace vortex_test {

constexpr double k = 2.0 * std::numbers::pi;
constexpr double nu = 0.01;
constexpr double end = 0.6;  // the fastest particles cross more than half the box

/// Relative error of the rate at which kinetic energy decays; the momentum must stay 0.
double decay_rate_error(double dx) {
  CaseSpec spec = periodic_square(dx);
  spec.study.noise_viscosity = StudyTable{}.noise_viscosity;
  spec.physics.viscosity = nu;
  Flow<2> flow = make_flow<2>(spec);
  EXPECT_TRUE(flow.setup.is_closed);
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    const Vec<2>& x = flow.state.particles.position[i];
    flow.state.particles.velocity[i] = {std::sin(k * x[0]) * std::cos(k * x[1]),
                                        -std::cos(k * x[0]) * std::sin(k * x[1])};
  }
  const double start = measure(flow).kinetic_energy;
  while (flow.state.time < end) step(flow);

  // All forces act in pairs, so the sum of the velocities stays at its initial value, 0 by symmetry. Its round-off is
  // that of some 30 terms of size U per particle and step.
  Vec<2> momentum = Vec<2>::Zero();
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) momentum += flow.state.particles.velocity[i];
  const double round_off =
      30.0 * 2.2e-16 * static_cast<double>(flow.state.particles.owned) * static_cast<double>(flow.state.step);
  EXPECT_LT(momentum.norm(), round_off);
  return std::log(start / measure(flow).kinetic_energy) / flow.state.time / (4.0 * nu * k * k) - 1.0;
}

TEST(TaylorGreen, KineticEnergyDecaysAtTheViscousRate) {
  // Smoothing with the kernel, with radius R = 3 dx and mean square 5/72 R^2 along an axis, reduces this wave by 5/72
  // (k R)^2. Viscosity and pressure are both smoothed, so the error of the rate is less than twice that, 0.014 for the
  // finest set. The time step is of first order, dt 4 nu k^2/2 < 0.006 there. Shifting by each particle's own speed
  // would let the particles line up at the stagnation points until the run fails (docs/theory/closures.md).
  double coarser = std::numeric_limits<double>::infinity();
  for (const double cells : {20.0, 40.0, 60.0}) {
    const double error = std::abs(decay_rate_error(1.0 / cells));
    EXPECT_LT(error, 5.0 / 36.0 * std::pow(k * 3.0 / cells, 2)) << cells;
    EXPECT_LT(error, coarser) << cells;
    coarser = error;
  }
}

}  // namespace vortex_test
}  // namespace tailwater
