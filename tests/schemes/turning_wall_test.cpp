// Walls that turn along the way of the water: curved ones, and those that rotate.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/meshes.h"
#include "schemes/cases.h"

namespace tailwater {
namespace {

constexpr double pi = std::numbers::pi;

/// A round wall of so many flat faces, of radius 1 about the origin.
WallTable round_wall(int faces, FluidSide side) {
  WallTable wall;
  for (int k = 0; k <= faces; ++k) {
    const double angle = 2.0 * pi * k / faces;
    wall.points.push_back({std::cos(angle), std::sin(angle)});
  }
  wall.points.back() = wall.points.front();
  wall.fluid_side = side;
  return wall;
}

/// Share of its kinetic energy that water loses in one turn, as a rigid body, in a round tank without friction or
/// gravity.
double loss_in_a_turn(Integrator integrator, double courant) {
  CaseSpec spec = free_case(0.05);
  spec.scheme.integrator = integrator;
  spec.scheme.courant = courant;
  FluidTable water;
  water.shape = BlockShape::fill;
  water.seed = {0.0, 0.0};
  water.level = 2.0;
  spec.fluid = {water};
  spec.walls = {round_wall(96, FluidSide::left)};
  Flow<2> flow = make_flow<2>(spec);
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (!flow.state.particles.is_fluid(i)) continue;
    const Vec<2>& x = flow.state.particles.position[i];
    flow.state.particles.velocity[i] = {-x[1], x[0]};
  }
  const double start = measure(flow).kinetic_energy;
  while (flow.state.time < 2.0 * pi) step(flow);
  return 1.0 - measure(flow).kinetic_energy / start;
}

// A wall whose tangent the water leaves along takes from it the energy dt |grad p|^2/rho of the rows beside it: 11 % in
// a turn with explicit steps of 0.55 dx. Walls seen halfway leave less than a fifth of that.
TEST(TurningWall, TakesLittleEnergyFromWaterAlongIt) {
  const double loss = loss_in_a_turn(Integrator::explicit_projection, 0.55);
  EXPECT_LT(loss, 0.02);
  EXPECT_GT(loss, -0.001);
  // The rest falls with the step.
  const double at_half_the_step = loss_in_a_turn(Integrator::explicit_projection, 0.275);
  EXPECT_LT(at_half_the_step, loss);
  EXPECT_GT(at_half_the_step, -0.001);
}

/// The mean of the curvatures of all rows is `sign`/`radius` in each direction.
template <int Dim>
void expect_curvature(const CaseSpec& spec, double radius, double sign, double tolerance) {
  const Flow<Dim> flow = make_flow<Dim>(spec);
  ASSERT_TRUE(flow.walls.is_curved);
  ASSERT_GT(flow.walls.curvature.size(), 0u);
  double trace = 0.0;
  for (std::size_t row = 0; row < flow.walls.curvature.size(); ++row) {
    const Mat<Dim>& S = flow.walls.curvature[row];
    EXPECT_LT((S - S.transpose()).norm(), 1e-12 / radius);
    trace += S.trace() / static_cast<double>(flow.walls.curvature.size());
  }
  EXPECT_NEAR(trace * radius, sign * (Dim - 1), tolerance);
}

TEST(TurningWall, HasTheCurvatureOfItsArc) {
  CaseSpec spec = free_case(0.05);
  spec.walls = {round_wall(96, FluidSide::left)};
  expect_curvature<2>(spec, 1.0, -1.0, 0.05);
  spec.walls = {round_wall(24, FluidSide::right)};  // faces of 5 dx: most rows see none of their corners
  expect_curvature<2>(spec, 1.0, 1.0, 0.3);
}

TEST(TurningWall, HasTheCurvatureOfItsMesh) {
  const testing_cases::MeshFolder folder;
  CaseSpec spec = testing_cases::empty_case(0.1, 3);
  spec.fluid = {testing_cases::box_fluid({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0})};
  spec.walls = {folder.wall(testing_cases::sphere_mesh({0.0, 0.0, 0.0}, 0.6, 24), FluidSide::outside)};
  expect_curvature<3>(spec, 0.6, 1.0, 0.1);
}

TEST(TurningWall, HasNoCurvatureAtItsCorners) {
  EXPECT_FALSE((make_flow<2>(tank_case<2>(0.05, 1.0, 0.5)).walls.is_curved));
  CaseSpec spec = free_case(0.05);
  WallTable roof;
  roof.points = {{-1.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}};
  roof.fluid_side = FluidSide::left;
  spec.walls = {roof};
  EXPECT_FALSE(make_flow<2>(spec).walls.is_curved);
}

// Water glides at speed s along a plate that turns with omega about the origin, so it must gain 2 omega s across the
// plate (Coriolis), which is in the rows. The images mirror it at the velocity that it comes with, omega s dt.
TEST(TurningWall, GivesTheWaterAlongATurningPlateItsCoriolisAcceleration) {
  const double omega = 0.5;
  const double glide = 1.5;
  CaseSpec spec = free_case(0.05);
  WallTable plate;
  plate.points = {{-2.0, 0.0}, {2.0, 0.0}};
  plate.fluid_side = FluidSide::left;
  plate.rotation = "0.5*t";
  FluidTable water;
  water.min = {-0.5, 0.0};
  water.max = {0.5, 0.5};
  spec.walls = {plate};
  spec.fluid = {water};
  Flow<2> flow = make_flow<2>(spec);
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    const Vec<2>& x = flow.state.particles.position[i];
    if (flow.state.particles.is_fluid(i)) flow.state.particles.velocity[i] = Vec<2>(glide - omega * x[1], omega * x[0]);
  }
  const StepStart<2> start = remember(flow);
  locate(flow);
  std::vector<Vec<2>> velocity = flow.state.particles.velocity;
  show_walls<2>(flow, flow.state.wall_velocity, velocity);
  const std::vector<Vec<2>> plain = velocity;
  const double dt = 1e-3;
  see_walls_halfway(flow, start, dt, velocity);
  std::size_t wet = 0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (flow.state.particles.is_fluid(i) || flow.here.is_wet[i] == 0) continue;
    ++wet;
    // The mean of the water in reach, 0.1 m above, glides slower by what the plate turns faster there.
    EXPECT_NEAR(flow.turning[i][1], 2.0 * omega * glide, 0.1 * omega * glide);
    EXPECT_LT(std::abs(flow.turning[i][0]), 1e-9);
    EXPECT_LT((velocity[i] - plain[i] + dt * flow.turning[i]).norm(), 1e-12);
  }
  EXPECT_GT(wet, 20u);
}

}  // namespace
}  // namespace tailwater
