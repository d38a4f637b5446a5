// Walls whose direction changes along the path of the water: curved walls and rotating walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "closures/free_surface.h"
#include "geometry/meshes.h"
#include "geometry/rotation.h"
#include "schemes/cases.h"

namespace tailwater {
namespace {

constexpr double pi = std::numbers::pi;

/// A round wall of `faces` flat faces, with radius 1 about the origin.
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

/// A round tank full of water, without gravity and viscosity.
CaseSpec round_tank() {
  CaseSpec spec = free_case(0.05);
  FluidTable water;
  water.shape = BlockShape::fill;
  water.seed = {0.0, 0.0};
  water.level = 2.0;
  spec.fluid = {water};
  spec.walls = {round_wall(96, FluidSide::left)};
  return spec;
}

template <class Velocity>
void set_velocity(Flow<2>& flow, const Velocity& of_place) {
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (flow.state.particles.is_fluid(i)) flow.state.particles.velocity[i] = of_place(flow.state.particles.position[i]);
  }
}

/// Fraction of its kinetic energy that water in rigid rotation loses in half a turn, in a round tank without friction
/// or gravity.
double loss_in_half_a_turn(Integrator integrator, double courant) {
  CaseSpec spec = round_tank();
  spec.scheme.integrator = integrator;
  spec.scheme.courant = courant;
  Flow<2> flow = make_flow<2>(spec);
  set_velocity(flow, [](const Vec<2>& x) { return Vec<2>(-x[1], x[0]); });
  const double start = measure(flow).kinetic_energy;
  while (flow.state.time < pi) step(flow);
  return 1.0 - measure(flow).kinetic_energy / start;
}

// If water leaves a wall along its tangent, the wall takes the energy dt |grad p|^2/rho of the rows beside it: 11 % per
// turn with explicit steps of 0.55 dx. With walls evaluated at mid-step the loss is less than a fifth of that.
TEST(TurningWall, TakesLittleEnergyFromWaterAlongIt) {
  const double loss = loss_in_half_a_turn(Integrator::explicit_projection, 0.55);
  EXPECT_LT(loss, 0.01);
  EXPECT_GT(loss, -0.0005);
  // The remaining loss decreases with the step.
  const double at_half_the_step = loss_in_half_a_turn(Integrator::explicit_projection, 0.275);
  EXPECT_LT(at_half_the_step, loss);
  EXPECT_GT(at_half_the_step, -0.0005);
}

/// Accelerations [m/s^2] towards the centre that the wall imposes at its wet dummies, in a step of dt along a chord.
/// They are averaged over both senses of rotation, since faces are not exactly perpendicular to the radius.
struct Asked {
  std::vector<double> by_rows, by_images;

  explicit Asked(double dt) {
    add(dt, 1.0);
    add(dt, -1.0);
  }

  void add(double dt, double omega) {
    Flow<2> flow = make_flow<2>(round_tank());
    const Mat<2> back = rotation_in_plane(-omega * dt);
    set_velocity(flow, [&](const Vec<2>& x) { return Vec<2>((x - back * x) / dt); });
    const StepStart<2> start = save_step_start(flow);
    locate(flow);
    std::vector<Vec<2>> images = flow.state.particles.velocity;
    set_wall_velocities<2>(flow, flow.state.wall_velocity, images);
    const std::vector<Vec<2>> mirrored_at_rest = images;
    set_wall_velocities_at_mid_step(flow, start, dt, images);
    by_rows.resize(flow.state.particles.owned, 0.0);
    by_images.resize(by_rows.size(), 0.0);
    for (std::size_t i = 0; i < by_rows.size(); ++i) {
      if (flow.state.particles.is_fluid(i) || flow.surroundings.is_wet[i] == 0) continue;
      const Vec<2>& n = flow.walls.particles.normal[flow.state.particles.wall_row[i]];
      by_rows[i] += 0.5 * n.dot(flow.walls.turn_acceleration[i]);
      by_images[i] += 0.5 * n.dot(images[i] + mirrored_at_rest[i]) / dt;  // the image less the water
    }
  }
};

/// Mean of all values other than 0.
double mean(const std::vector<double>& values) {
  const auto zeros = std::ranges::count(values, 0.0);
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(std::ssize(values) - zeros);
}

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) squares += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(squares / static_cast<double>(a.size()));
}

// Water that rotates with Omega = 1 needs the acceleration r, averaged over the water within the support, between 0.85
// and 1 m. The rows give r^2/R, and the images the remainder r - r^2/R; the curvature is known to 5 %. Neither has an
// error of first order in the step.
TEST(TurningWall, TurnsTheWaterToSecondOrderInTheStep) {
  const std::array<Asked, 3> asked{Asked(0.08), Asked(0.04), Asked(0.02)};
  EXPECT_GT(mean(asked[2].by_rows), 0.95 * 0.85 * 0.85);
  EXPECT_LT(mean(asked[2].by_rows), 1.05);
  EXPECT_GT(mean(asked[2].by_images), -0.05);
  EXPECT_LT(mean(asked[2].by_images), 0.85 - 0.95 * 0.85 * 0.85);
  for (const auto part : {&Asked::by_rows, &Asked::by_images}) {
    const double change = rms_difference(asked[0].*part, asked[1].*part);
    EXPECT_NEAR(change / rms_difference(asked[1].*part, asked[2].*part), 4.0, 0.05);
  }
}

/// Asserts that the mean of the curvatures of all rows is `sign`/`radius` in each direction.
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
  spec.walls = {round_wall(24, FluidSide::right)};  // faces of 5 dx: most rows have no corner within the support
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

// Water that flows around a wall must be accelerated towards it. A row that treats the gap behind it as a free surface
// is not, and the gap then grows.
TEST(TurningWall, IsNoSurfaceForWaterThatHasLeftItByPartOfARow) {
  const double dx = 0.05;
  CaseSpec spec = round_tank();
  spec.walls = {round_wall(96, FluidSide::right)};
  FluidTable around;
  around.min = {-1.5, -1.5};
  around.max = {1.5, 1.5};
  spec.fluid = {around};
  Flow<2> flow = make_flow<2>(spec);
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (flow.state.particles.is_fluid(i)) flow.state.particles.position[i][0] += 0.2 * dx;
  }
  locate(flow);
  std::vector<double> by_neighbours(flow.surroundings.interior.size());
  find_interior<2>(flow.pairs(), flow.state.particles, flow.surroundings.concentration,
                   flow.setup.scale.kernel_values.W_0, by_neighbours);
  double least = 1.0;
  double min_by_neighbours = 1.0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    const Vec<2>& x = flow.state.particles.position[i];
    if (!flow.state.particles.is_fluid(i) || x.norm() > 1.0 + dx || x[0] < 0.95 * x.norm()) continue;
    least = std::min(least, flow.surroundings.interior[i]);
    min_by_neighbours = std::min(min_by_neighbours, by_neighbours[i]);
  }
  EXPECT_LT(min_by_neighbours, 0.1);
  EXPECT_GT(least, 0.7);
}

// Water slips at speed s along a plate that rotates with omega about the origin. It must therefore gain 2 omega s
// across the plate (Coriolis), which is in the rows. The images mirror the water with its incoming velocity, omega s
// dt.
TEST(TurningWall, GivesTheWaterAlongATurningPlateItsCoriolisAcceleration) {
  const double omega = 0.5;
  const double slip_velocity = 1.5;
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
    if (flow.state.particles.is_fluid(i))
      flow.state.particles.velocity[i] = Vec<2>(slip_velocity - omega * x[1], omega * x[0]);
  }
  const StepStart<2> start = save_step_start(flow);
  locate(flow);
  std::vector<Vec<2>> velocity = flow.state.particles.velocity;
  set_wall_velocities<2>(flow, flow.state.wall_velocity, velocity);
  const std::vector<Vec<2>> plain = velocity;
  const double dt = 1e-3;
  set_wall_velocities_at_mid_step(flow, start, dt, velocity);
  std::size_t wet = 0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (flow.state.particles.is_fluid(i) || flow.surroundings.is_wet[i] == 0) continue;
    ++wet;
    // The mean of the water within the support, 0.1 m above the plate, slips more slowly, because the plate moves
    // faster there.
    EXPECT_NEAR(flow.walls.turn_acceleration[i][1], 2.0 * omega * slip_velocity, 0.1 * omega * slip_velocity);
    EXPECT_LT(std::abs(flow.walls.turn_acceleration[i][0]), 1e-9);
    EXPECT_LT((velocity[i] - plain[i] + dt * flow.walls.turn_acceleration[i]).norm(), 1e-12);
  }
  EXPECT_GT(wet, 20u);
}

}  // namespace
}  // namespace tailwater
