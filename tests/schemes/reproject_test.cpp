// The second projection: the divergence that it removes, and its invariants for any particles.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "pressure/operators.h"
#include "schemes/cases.h"

namespace tailwater {
namespace reproject_test {
namespace {

/// A case without any symmetry of the particles.
CaseSpec jittered_square() {
  CaseSpec spec = periodic_square(0.1);
  spec.particles.jitter = 0.2;
  return spec;
}

constexpr double dt = 0.01;

/// One second projection of the present velocity.
void reproject_here(Flow<2>& flow) {
  const StepStart<2> start = save_step_start(flow);
  locate(flow);
  WallDrive<2> drive = drive_walls(flow, start.wall_velocity, dt);
  Prediction<2> predicted = predict(flow, start, drive, dt);
  const std::vector<double> target = target_divergence(flow, std::move(predicted.velocity_gradient), dt);
  solve(flow, assemble(flow, predicted, target, drive, dt), drive);
  reproject(flow, drive, dt);
}

double rms_divergence(Flow<2>& flow) { return bulk_rms(flow, find_divergence(flow)); }

TEST(Reproject, TakesMostOfTheDivergenceAndNoMomentum) {
  constexpr double k = 2.0 * std::numbers::pi;
  Flow<2> flow = make_flow<2>(jittered_square());
  std::vector<Vec<2>>& velocity = flow.state.particles.velocity;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    const Vec<2>& x = flow.state.particles.position[i];
    velocity[i] = {std::sin(k * x[0]), std::sin(k * x[1]) * std::cos(k * x[0])};
  }
  save_step_start(flow);
  locate(flow);
  const double start = rms_divergence(flow);
  const auto momentum = [&] {
    return std::accumulate(velocity.begin(), velocity.begin() + flow.state.particles.owned, Vec<2>(Vec<2>::Zero()));
  };
  const Vec<2> before = momentum();
  reproject_here(flow);
  // Not all of it: the Laplacian is not D G. Without the correction, or with one of twice its size, all would remain.
  EXPECT_LT(rms_divergence(flow), 0.5 * start);
  EXPECT_LT((momentum() - before).norm(), 1e-12 * flow.state.particles.owned);
}

TEST(Reproject, LeavesAUniformVelocityAlone) {
  Flow<2> flow = make_flow<2>(jittered_square());
  const Vec<2> uniform{1.0, -2.0};
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) flow.state.particles.velocity[i] = uniform;
  reproject_here(flow);
  // Its divergence is a sum over differences, 0 up to the ghosts' round-off.
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    EXPECT_LT((flow.state.particles.velocity[i] - uniform).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace reproject_test
}  // namespace tailwater
