// Thick liquids that slide along walls with Coulomb friction.
#include <gtest/gtest.h>

#include <numbers>

#include "base/finding.h"
#include "rheology/liquids.h"
#include "rheology/thick_liquid.h"
#include "support/dimensions.h"
#include "support/record.h"

namespace tailwater {
namespace {

constexpr double gravity = 10.0;
constexpr double layer_depth = 0.5;
constexpr double degree = std::numbers::pi / 180.0;

WallTable sliding_bed(double mu) {
  WallTable bed;
  bed.slip = Slip::coulomb;
  bed.friction = mu;
  return bed;
}

/// A periodic layer on a bed with the slope `angle` and the coefficient of friction `mu`. It starts with `speed` down
/// the slope, which is 30 degrees off the x axis in 3D.
template <int Dim>
CaseSpec layer_on_slope(double mu, double angle, double speed, const LiquidTable& liquid, double spacing = 0.1) {
  CaseSpec spec;
  const double length = 12.0 * spacing;
  std::array<double, 2> down{1.0, 0.0};
  if (Dim == 3) down = {std::cos(30.0 * degree), std::sin(30.0 * degree)};
  spec.general.dimension = Dim;
  spec.particles.spacing = spacing;
  spec.physics.gravity = Coordinates(Dim, -gravity * std::cos(angle));
  spec.domain.periodic_x = {0.0, length};
  FluidTable layer;
  layer.min = Coordinates(Dim, 0.0);
  layer.max = Coordinates(Dim, length);
  layer.max[Dim - 1] = layer_depth;
  layer.velocity = VectorField(Dim, 0.0);
  for (int a = 0; a < Dim - 1; ++a) {
    spec.physics.gravity[a] = down[a] * gravity * std::sin(angle);
    layer.velocity[a] = down[a] * speed;
  }
  spec.fluid = {layer};
  WallTable bed = sliding_bed(mu);
  if (Dim == 2) {
    bed.points = {{0.0, 0.0}, {length, 0.0}};
  } else {
    spec.domain.periodic_y = {0.0, length};
    bed.shape = WallShape::box;
    bed.min = Coordinates(Dim, 0.0);
    bed.max = Coordinates(Dim, length);
    bed.open = {"-x", "+x", "-y", "+y", "+z"};
    bed.fluid_side = FluidSide::inside;
  }
  spec.walls = {bed};
  fill_with(spec, liquid);
  return spec;
}

/// Mean velocity down the slope [m/s].
template <int Dim>
double speed_of(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  Vec<Dim> sum = Vec<Dim>::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    sum += particles.velocity[i];
    count += 1.0;
  }
  const Vec<Dim> mean = sum / count;
  if constexpr (Dim == 2) return mean[0];
  return std::cos(30.0 * degree) * mean[0] + std::sin(30.0 * degree) * mean[1];
}

/// The friction on the walls along the bed over the weight of the liquid across it.
template <int Dim>
double friction_over_weight(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  Vec<Dim> friction = Vec<Dim>::Zero();
  double weight = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    friction += flow.walls.forces.friction[i];
    if (particles.is_fluid(i)) weight -= 1000.0 * particles.volume[i] * flow.setup.gravity[Dim - 1];
  }
  friction[Dim - 1] = 0.0;
  return friction.norm() / weight;
}

template <int Dim>
void begin(Flow<Dim>& flow) {
  flow.walls.forces.are_requested = true;
  start(flow);
}

template <int Dim>
void run_to(Flow<Dim>& flow, double end) {
  while (flow.state.time < end) step(flow);
}

template <class D>
class SlidingLayers : public testing::Test {};
TYPED_TEST_SUITE(SlidingLayers, Dimensions);

TYPED_TEST(SlidingLayers, AccelerateByGravityLessFriction) {
  constexpr int Dim = TypeParam::value;
  constexpr double mu = 0.3;
  constexpr double angle = 30.0 * degree;
  Flow<Dim> flow = make_flow<Dim>(layer_on_slope<Dim>(mu, angle, 0.0, newtonian(1e5)));
  begin(flow);
  run_to(flow, 0.1);
  const double t = flow.state.time;
  const double v = speed_of(flow);
  run_to(flow, 0.35);
  const double acceleration = (speed_of(flow) - v) / (flow.state.time - t);
  const double error = acceleration / (gravity * (std::sin(angle) - mu * std::cos(angle))) - 1.0;
  record_error("sliding_layer", Dim, 0.1, error);
  EXPECT_NEAR(error, 0.0, 0.02);
  EXPECT_NEAR(friction_over_weight(flow) / mu, 1.0, 0.02);
}

// tan 30 degrees = 0.577: the layer creeps as a film of no slip.
TYPED_TEST(SlidingLayers, StayBelowTheAngleOfFriction) {
  constexpr int Dim = TypeParam::value;
  constexpr double angle = 30.0 * degree;
  constexpr double viscosity = 1e5;
  Flow<Dim> flow = make_flow<Dim>(layer_on_slope<Dim>(0.62, angle, 0.0, newtonian(viscosity)));
  begin(flow);
  run_to(flow, 0.3);
  const double film = 1000.0 * gravity * std::sin(angle) * layer_depth * layer_depth / (3.0 * viscosity);
  EXPECT_NEAR(speed_of(flow) / film, 1.0, 0.02);
}

TYPED_TEST(SlidingLayers, StopOnALevelBed) {
  constexpr int Dim = TypeParam::value;
  constexpr double mu = 0.4;
  constexpr double speed = 1.0;
  Flow<Dim> flow = make_flow<Dim>(layer_on_slope<Dim>(mu, 0.0, speed, newtonian(1e5)));
  begin(flow);
  double way = 0.0;
  while (flow.state.time < 1.3 * speed / (mu * gravity)) {
    const double before = speed_of(flow);
    const double dt = step(flow).dt;
    way += 0.5 * dt * (before + speed_of(flow));
  }
  EXPECT_NEAR(way / (speed * speed / (2.0 * mu * gravity)), 1.0, 0.02);
  EXPECT_LT(std::abs(speed_of(flow)), 1e-4 * speed);
}

// A film with slip: u - u(0) = tau/mu (y - y^2/(2 h)) with the stress tau of friction on the bed.
TEST(SlidingFilm, HasTheExactProfile) {
  constexpr double mu = 0.3;
  constexpr double angle = 30.0 * degree;
  constexpr double viscosity = 500.0;
  Flow<2> flow = make_flow<2>(layer_on_slope<2>(mu, angle, 0.0, newtonian(viscosity), 0.05));
  begin(flow);
  run_to(flow, 1.5);
  const double h = layer_depth;
  const double stress = mu * 1000.0 * gravity * std::cos(angle) * h;
  const auto exact = [&](double y) { return stress / viscosity * (y - y * y / (2.0 * h) - h / 3.0); };
  const double mean = speed_of(flow);
  const Particles<2>& particles = flow.state.particles;
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    squares += std::pow(particles.velocity[i][0] - mean - exact(particles.position[i][1]), 2);
    count += 1.0;
  }
  const double error = std::sqrt(squares / count) / (exact(h) - exact(0.0));
  record_error("sliding_film", 2, 0.05, error);
  EXPECT_LT(error, 0.02);
}

// A stiff block rests on viscous stress as well as on pressure. Its way is 2 % short, because the pressure of the wall
// before its front pushes it back (docs/theory/rheology.md), so the friction is compared.
TEST(SlidingBlock, StopsOnALevelBed) {
  constexpr double mu = 0.4;
  constexpr double speed = 1.5;
  CaseSpec spec;
  spec.particles.spacing = 0.06;
  spec.physics.gravity = {0.0, -gravity};
  FluidTable block;
  block.min = {0.0, 0.0};
  block.max = {0.6, 0.3};
  block.velocity = {speed, 0.0};
  spec.fluid = {block};
  WallTable bed = sliding_bed(mu);
  bed.points = {{-0.6, 0.0}, {1.5, 0.0}};
  spec.walls = {bed};
  LiquidTable liquid = bingham(1000.0, 1e4);
  fill_with(spec, liquid);
  Flow<2> flow = make_flow<2>(spec);
  begin(flow);
  double way = 0.0;
  double friction = 0.0;
  double sliding = 0.0;
  while (flow.state.time < 0.6) {
    const double before = speed_of(flow);
    const double dt = step(flow).dt;
    way += 0.5 * dt * (before + speed_of(flow));
    if (before < 0.1 * speed) continue;
    friction += dt * friction_over_weight(flow);
    sliding += dt;
  }
  record_error("way_of_a_block", 2, spec.particles.spacing, way / (speed * speed / (2.0 * mu * gravity)) - 1.0);
  EXPECT_NEAR(friction / sliding / mu, 1.0, 0.02);
  EXPECT_LT(std::abs(speed_of(flow)), 1e-3 * speed);
}

// Walls without friction leave the acceleration and the pressure of a stiff layer as they are.
TYPED_TEST(SlidingLayers, AccelerateFreelyOnAFreeSlipBed) {
  constexpr int Dim = TypeParam::value;
  constexpr double angle = 30.0 * degree;
  CaseSpec spec = layer_on_slope<Dim>(0.3, angle, 0.0, newtonian(1e5));
  spec.walls[0].slip = Slip::free;
  Flow<Dim> flow = make_flow<Dim>(spec);
  begin(flow);
  run_to(flow, 0.2);
  EXPECT_NEAR(speed_of(flow) / (gravity * std::sin(angle) * flow.state.time), 1.0, 0.001);
  const Particles<Dim>& particles = flow.state.particles;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    const double y = particles.position[i][Dim - 1];
    if (!particles.is_fluid(i) || y > spec.particles.spacing) continue;
    EXPECT_NEAR(particles.pressure[i] / (1000.0 * gravity * std::cos(angle) * (layer_depth - y)), 1.0, 0.02);
  }
}

// Only the implicit solve contains this friction.
TEST(SlidingWalls, AreRefusedBesideWaterAndThinLiquids) {
  CaseSpec spec = layer_on_slope<2>(0.3, 0.0, 0.0, newtonian(1e-3));
  EXPECT_THROW(make_flow<2>(spec), CaseError);
  spec.liquids.clear();
  spec.fluid[0].liquid.clear();
  EXPECT_THROW(make_flow<2>(spec), CaseError);
  spec.walls[0].slip = Slip::no_slip;
  EXPECT_NO_THROW(make_flow<2>(spec));
}

}  // namespace
}  // namespace tailwater
