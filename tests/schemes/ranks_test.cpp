// Identical flows on one rank and on several ranks. They differ by the order of sums and, within the tolerance of the
// pressure solve, by its solution.
//
// Bound. With rows scaled to unit diagonal the solve leaves |r|_2 <= tau |b|_2. The inverse is not negative, and its
// row sums are at most those of the discrete Laplacian over the depth. So |A^-1|_inf |b|_inf is of the size of the
// largest pressure P, and |dp|_inf <= |A^-1|_inf |r|_2 <= tau sqrt(n) P over n unknowns, up to a factor of shape. A
// step turns dp into dt/(rho dx) 4 dp of velocity at most (the weights of a row of the gradient add up to less than
// 4/dx). N steps turn dp into N times that, as long as they do not amplify: a hundredfold amplification is allowed.
// Pairs are computed in single precision. Where the solutions differ at all, a pair may be rounded to the next number,
// and pressures differ by that.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "air/pocket_pressure.h"
#include "bodies/floating_bodies.h"
#include "neighbours/decomposition.h"
#include "neighbours/neighbourhood.h"
#include "parts/refinement.h"
#include "schemes/force_reader.h"
#include "schemes/open_ends.h"
#include "support/dimensions.h"
#include "support/liquids.h"
#include "support/rounding.h"

namespace tailwater {
namespace ranks_test {

constexpr double tau = 1e-11;
constexpr double granted = 100.0;
constexpr double dx = 0.05;
constexpr int steps = 12;  // particles are repartitioned twice

template <int Dim>
struct Particle {
  std::int64_t id;
  Vec<Dim> position;
  Vec<Dim> velocity;
  double pressure;
  double wall_distance;
  bool is_inside;
};

/// The fluid of all ranks by id, on the root.
template <int Dim>
std::vector<Particle<Dim>> fluid_of(const Flow<Dim>& flow) {
  std::vector<Particle<Dim>> own;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (!flow.state.particles.is_fluid(i)) continue;
    own.push_back({flow.state.particles.id[i], flow.neighbourhood->wrapped(flow.state.particles.position[i]),
                   flow.state.particles.velocity[i], flow.state.particles.pressure[i],
                   flow.state.particles.wall_distance[i], flow.is_inside(i)});
  }
  std::vector<Particle<Dim>> all = flow.setup.ranks.gather(own);
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return all;
}

template <int Dim>
void run(Flow<Dim>& flow, int count) {
  start(flow);
  for (int n = 0; n < count; ++n) pass_and_step(flow);
}

/// Checks the ghosts after a step, since probes and the next step read them.
template <int Dim>
void expect_ghosts_up_to_date(Flow<Dim>& flow) {
  Particles<Dim>& particles = flow.state.particles;
  const Particles<Dim> before = particles;
  flow.halo().exchange(particles.velocity, particles.pressure);
  EXPECT_EQ(particles.velocity, before.velocity);
  EXPECT_EQ(particles.pressure, before.pressure);
}

/// Runs the case on all ranks, and on the root alone, from velocities set by `prepare`, and compares the results.
template <int Dim, class Prepare>
void expect_same(CaseSpec spec, double depth, Prepare&& prepare) {
  spec.pressure_solver.tolerance = tau;
  const Communicator world = Communicator::world();
  Flow<Dim> shared = make_flow<Dim>(spec, world);
  prepare(shared);
  run(shared, steps);
  expect_ghosts_up_to_date(shared);
  EXPECT_EQ(world.least(shared.state.time), world.largest(shared.state.time));
  const auto owned = world.sum(shared.state.particles.owned);
  const std::vector<Particle<Dim>> found = fluid_of(shared);
  if (!world.is_root()) return;

  Flow<Dim> alone = make_flow<Dim>(spec);
  prepare(alone);
  run(alone, steps);
  ASSERT_EQ(owned, alone.state.particles.owned);
  const double unknowns = static_cast<double>(alone.state.particles.owned);
  const double dt = alone.state.time / steps;
  const double speed_scale = std::sqrt(2.0 * g * depth) + 1.0;
  const double P = 1000.0 * (g * depth + speed_scale * speed_scale);
  const double dp = (granted * (tau * std::sqrt(unknowns) + single_eps) + std::sqrt(tau)) * P;
  const double du = steps * 4.0 * dt / (1000.0 * spec.particles.spacing) * dp;
  EXPECT_NEAR(shared.state.time, alone.state.time,
              alone.state.time * du);  // steps depend on the largest speed, 1 m/s or more
  const std::vector<Particle<Dim>> expected = fluid_of(alone);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    ASSERT_EQ(found[k].id, expected[k].id);
    EXPECT_LT((found[k].velocity - expected[k].velocity).norm(), du) << "particle " << found[k].id;
    EXPECT_LT((found[k].position - expected[k].position).norm(), alone.state.time * du) << "particle " << found[k].id;
    EXPECT_LT(std::abs(found[k].pressure - expected[k].pressure), dp + P * du / speed_scale);
    // The distance propagates from neighbour to neighbour, one per step.
    EXPECT_NEAR(found[k].wall_distance, expected[k].wall_distance, 2.0 * steps * alone.state.time * du);
    EXPECT_EQ(found[k].is_inside, expected[k].is_inside) << "particle " << found[k].id;
  }
}

const auto as_it_is = [](auto&) {};

template <class D>
class RanksTest : public testing::Test {};
TYPED_TEST_SUITE(RanksTest, Dimensions);

template <int Dim>
CaseSpec jittered_tank() {
  CaseSpec spec = tank_case<Dim>(dx, Dim == 2 ? 1.0 : 0.4, 0.3);
  spec.particles.jitter = 0.1;
  return spec;
}

TYPED_TEST(RanksTest, Tank) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = jittered_tank<Dim>();
  expect_same<Dim>(spec, 0.3, as_it_is);
  spec.scheme.integrator = Integrator::implicit_projection;
  expect_same<Dim>(spec, 0.3, as_it_is);
}

TYPED_TEST(RanksTest, AZoneOfRefinementAcrossTheCuts) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = jittered_tank<Dim>();
  RefinementTable zone;
  zone.min.assign(Dim, -1.0);
  zone.max.assign(Dim, 2.0);
  zone.max[Dim - 1] = 0.25;  // a border inside the water, which the cuts cross
  spec.refinement = {zone};
  expect_same<Dim>(spec, 0.3, as_it_is);
}

TEST(RanksTest, AZoneThatMovesWithABlock) {
  CaseSpec spec = tank_case<2>(0.05, 1.4, 0.7);
  WallTable block;
  block.name = "block";
  block.shape = WallShape::polygon;
  block.points = {{0.4, 0.25}, {0.6, 0.25}, {0.6, 0.45}, {0.4, 0.45}};
  block.fluid_side = FluidSide::outside;
  block.displacement = {"0.5*t", 0.0};
  spec.walls.push_back(block);
  RefinementTable zone;
  zone.shape = ZoneShape::walls;
  zone.walls = {"block"};
  zone.distance = 0.2;
  spec.refinement = {zone};
  expect_same<2>(spec, 0.7, as_it_is);
}

TEST(RanksTest, ParticlesSplitAndMergeOnAllRanks) {
  CaseSpec spec = zhou_case(0.05, Integrator::explicit_projection);
  RefinementTable zone;
  zone.min = {1.0, -1.0};
  zone.max = {9.0, 9.0};
  spec.refinement = {zone};
  const Communicator world = Communicator::world();
  Flow<2> flow = make_flow<2>(spec, world);
  start(flow);
  const double volume = 1.2 * 0.6;
  for (int n = 0; n < 80; ++n) {
    if (flow.state.step % 5 != 0) adapt(flow);
    pass_and_step(flow);
  }
  const Refinement<2>& part = flow.part<Refinement<2>>();
  EXPECT_GT(part.splits(), 20);
  EXPECT_EQ(part.splits(), world.least(part.splits()));
  EXPECT_EQ(part.splits(), world.largest(part.splits()));
  EXPECT_EQ(part.merges(), world.largest(part.merges()));
  const auto own_fluid = [&](std::size_t i) { return flow.state.particles.is_fluid(i); };
  EXPECT_NEAR(world.sum(sum_over(flow.state.particles.owned, 0.0,
                                 [&](std::size_t i) { return own_fluid(i) ? flow.state.particles.volume[i] : 0.0; })),
              volume, 1e-12 * volume);
  const std::vector<Particle<2>> all = fluid_of(flow);  // by id
  for (std::size_t k = 1; k < all.size(); ++k) ASSERT_NE(all[k].id, all[k - 1].id);
}

TYPED_TEST(RanksTest, PublishedFormulations) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = tank_case<Dim>(dx, Dim == 2 ? 1.0 : 0.4, 0.3);
  spec.scheme.formulation = Formulation::published;
  for (const Integrator integrator : {Integrator::explicit_projection, Integrator::implicit_projection}) {
    if (Dim == 3) continue;  // the operators are those of ConsistentOperatorsStressAndFriction
    spec.scheme.integrator = integrator;
    apply_formulation(spec.scheme);
    expect_same<Dim>(spec, 0.3, as_it_is);
  }
  spec.scheme.name = SchemeName::farmani2020;
  apply_formulation(spec.scheme);
  expect_same<Dim>(spec, 0.3, as_it_is);
}

// Half of the force of a pair acts through its water particle, which may be on another rank than its wall particle;
// friction does as well. The cut between two ranks passes through the corner where the walls meet.
TEST(RanksTest, ForcesOnWallsThatMeetAreTheSame) {
  CaseSpec spec = jittered_tank<2>();
  spec.walls.clear();
  spec.probes.clear();
  const Coordinates corner{0.5, 0.0};
  const std::array<std::vector<Coordinates>, 2> walls{{{{0.0, 0.6}, corner}, {corner, {1.0, 0.6}}}};
  for (const auto& points : walls) {
    WallTable wall;
    wall.name = spec.walls.empty() ? "down" : "up";
    wall.points = points;
    wall.slip = Slip::no_slip;
    wall.roughness = 0.05;
    spec.walls.push_back(wall);
    spec.probes.push_back(force_probe(corner, {wall.name}));
  }
  FluidTable water;
  water.shape = BlockShape::fill;
  water.seed = {0.5, 0.2};
  water.level = 0.4;
  water.velocity = {0.0, -1.5};
  spec.fluid = {water};
  spec.pressure_solver.tolerance = tau;
  for (const bool moves : {false, true}) {  // walls at rest keep their first result
    for (WallTable& wall : spec.walls) {
      if (moves) wall.displacement = {"0.1*t", "0"};
    }
    Flow<2> alone = make_flow<2>(spec);
    Flow<2> shared = make_flow<2>(spec, Communicator::world());
    run(alone, 2);
    run(shared, 2);
    // An error dp of the pressure everywhere causes less than 2 dp on each unit of a wall.
    const double P = 1000.0 * (g * 0.4 + (std::sqrt(2.0 * g * 0.4) + 1.0) * (std::sqrt(2.0 * g * 0.4) + 1.0));
    const double unknowns = static_cast<double>(alone.state.particles.owned);
    const double dp = (granted * (tau * std::sqrt(unknowns) + single_eps) + std::sqrt(tau)) * P;
    for (std::size_t k = 0; k < spec.walls.size(); ++k) {
      const Vec<2> expected = Reader<2>(spec, alone, k).force();
      EXPECT_GT(expected.norm(), 400.0);
      EXPECT_LT((Reader<2>(spec, shared, k).force() - expected).norm(), 2.0 * dp) << spec.walls[k].name;
    }
  }
}

// The cut between ranks and the plate are at the same position.
TYPED_TEST(RanksTest, WaterOnBothSidesOfAPlate) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = jittered_tank<Dim>();
  const double width = spec.fluid[0].max[0];
  WallTable plate;
  plate.shape = WallShape::plate;
  if constexpr (Dim == 2) {
    plate.points = {{0.5 * width, 0.0}, {0.5 * width, 0.2}};
  } else {
    plate.points = {
        {0.5 * width, 0.0, 0.0}, {0.5 * width, width, 0.0}, {0.5 * width, width, 0.2}, {0.5 * width, 0.0, 0.2}};
  }
  spec.walls.push_back(plate);
  expect_same<Dim>(spec, 0.3, as_it_is);
}

TYPED_TEST(RanksTest, ConsistentOperatorsStressAndFriction) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = tank_case<Dim>(dx, Dim == 2 ? 1.0 : 0.4, 0.3);
  spec.scheme.formulation = Formulation::published;
  apply_formulation(spec.scheme);
  spec.physics.viscosity = 1e-3;
  spec.walls[0].slip = Slip::no_slip;
  expect_same<Dim>(spec, 0.3, as_it_is);
}

TYPED_TEST(RanksTest, AYieldingLiquid) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = jittered_tank<Dim>();
  for (WallTable& wall : spec.walls) {
    wall.slip = Slip::no_slip;
    wall.friction = 1.0;
  }
  LiquidTable liquid = bingham(10.0, 5.0);
  liquid.rest_viscosity = 1e3;
  fill_with(spec, liquid);
  expect_same<Dim>(spec, 0.3, [](Flow<Dim>& flow) {
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      if (flow.state.particles.is_fluid(i)) flow.state.particles.velocity[i][0] = flow.state.particles.position[i][1];
    }
  });
}

TYPED_TEST(RanksTest, WaterThatEntersAPorousLayer) {
  constexpr int Dim = TypeParam::value;
  for (const Integrator integrator : {Integrator::explicit_projection, Integrator::implicit_projection}) {
    CaseSpec spec = jittered_tank<Dim>();
    spec.scheme.integrator = integrator;
    PorousTable layer;
    layer.min = Coordinates(Dim, -0.1);
    layer.max = Coordinates(Dim, Dim == 2 ? 1.1 : 0.7);
    layer.min[0] = Dim == 2 ? 0.5 : 0.2;
    layer.porosity = 0.4;
    layer.grain_size = 0.02;
    layer.added_mass = 0.5;
    spec.porous = {layer};
    expect_same<Dim>(spec, 0.3, [](Flow<Dim>& flow) {
      for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
        if (flow.state.particles.is_fluid(i)) flow.state.particles.velocity[i][0] = 1.0;
      }
    });
  }
}

TYPED_TEST(RanksTest, BoundaryLayers) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = jittered_tank<Dim>();
  spec.walls[0].slip = Slip::no_slip;
  spec.walls[0].roughness = 0.02;
  expect_same<Dim>(spec, 0.3, [](Flow<Dim>& flow) {
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      if (flow.state.particles.is_fluid(i)) flow.state.particles.velocity[i][0] = 1.0;
    }
  });
}

TYPED_TEST(RanksTest, PeriodicVortex) {
  constexpr int Dim = TypeParam::value;
  constexpr double k = 2.0 * std::numbers::pi;
  CaseSpec spec;
  spec.general.dimension = Dim;
  spec.particles.spacing = Dim == 2 ? dx : 0.1;
  spec.physics.gravity = Coordinates(Dim, 0.0);
  spec.domain.periodic_x = {0.0, 1.0};
  spec.domain.periodic_y = {0.0, 1.0};
  if (Dim == 3) spec.domain.periodic_z = {0.0, 1.0};
  FluidTable water;
  water.min = Coordinates(Dim, 0.0);
  water.max = Coordinates(Dim, 1.0);
  spec.fluid = {water};
  expect_same<Dim>(spec, 0.0, [](Flow<Dim>& flow) {
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      const Vec<Dim>& x = flow.state.particles.position[i];
      flow.state.particles.velocity[i][0] = std::sin(k * x[0]) * std::cos(k * x[1]);
      flow.state.particles.velocity[i][1] = -std::cos(k * x[0]) * std::sin(k * x[1]);
    }
  });
}

/// Values of the last step in ghosts have no effect, since ghosts of water are updated.
TEST(RanksTest, StaleGhostsChangeNothing) {
  const auto pressure_after = [](double left) {
    Flow<2> flow = make_flow<2>(jittered_tank<2>(), Communicator::world());
    start(flow);
    Particles<2>& particles = flow.state.particles;
    for (std::size_t i = particles.owned; i < particles.size(); ++i) {
      particles.pressure[i] = left;
      particles.velocity[i].fill(left);
    }
    advance(flow, next_time_step(flow));
    return particles.pressure;
  };
  EXPECT_EQ(pressure_after(0.0), pressure_after(1e6));
}

/// A piston, and a rotating drum where parts meet at the surface, past which the water flows.
TEST(RanksTest, MovingWalls) {
  CaseSpec spec = jittered_tank<2>();
  WallTable piston;
  piston.name = "piston";
  piston.shape = WallShape::box;
  piston.min = {-0.5, 0.0};
  piston.max = {0.0, 0.6};
  piston.fluid_side = FluidSide::outside;
  piston.displacement = {"0.2*t", "0"};
  spec.walls[0].open.emplace_back("-x");
  spec.walls.push_back(piston);
  WallTable drum;
  drum.name = "drum";
  drum.shape = WallShape::polygon;
  for (int k = 0; k < 24; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 24;
    drum.points.push_back({0.5 + 0.15 * std::cos(angle), 0.25 + 0.15 * std::sin(angle)});
  }
  drum.fluid_side = FluidSide::outside;
  drum.rotation = "5*t";
  drum.pivot = {0.5, 0.25};
  spec.walls.push_back(drum);
  spec.fluid[0].velocity = {1.0, 0.0};
  spec.physics.viscosity = 0.01;
  for (WallTable& wall : spec.walls) wall.slip = Slip::no_slip;
  expect_same<2>(spec, 0.3, as_it_is);
}

TEST(RanksTest, WaterThatLeavesIsBookedOnAllRanks) {
  CaseSpec spec = jittered_tank<2>();
  open_end(spec);
  spec.fluid[0].velocity = {2.0, 0.0};
  const auto water_in = [](const Flow<2>& flow) {
    std::int64_t count = 0;
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) count += flow.state.particles.is_fluid(i);
    return flow.setup.ranks.sum(count);
  };
  Flow<2> flow = make_flow<2>(spec, Communicator::world());
  const std::int64_t at_start = water_in(flow);
  run(flow, 40);
  EXPECT_GT(state_of_end(flow, 0).departed.particles, 0);
  EXPECT_EQ(water_in(flow) + state_of_end(flow, 0).departed.particles, at_start);
  expect_same<2>(spec, 0.3, as_it_is);
}

TEST(RanksTest, WaterThatEntersIsMadeOnceAndBookedOnAllRanks) {
  CaseSpec spec = jittered_tank<2>();
  open_start(spec).discharge = 0.3;
  spec.fluid[0].velocity = {1.0, 0.0};
  Flow<2> flow = make_flow<2>(spec, Communicator::world());
  const std::size_t at_start = flow.setup.ranks.sum(count_fluid(flow));
  run(flow, 40);
  EXPECT_GT(state_of_end(flow, 0).arrived.particles, 0);
  EXPECT_EQ(flow.setup.ranks.sum(count_fluid(flow)),
            at_start + static_cast<std::size_t>(state_of_end(flow, 0).arrived.particles));
  expect_same<2>(spec, 0.3, as_it_is);
}

/// A level beyond an open end, above or below the water, lets water in or out.
TEST(RanksTest, ALevelBeyondIsHeldTogether) {
  for (const double level : {0.4, 0.2}) {
    CaseSpec spec = jittered_tank<2>();
    open_end(spec).level = level;
    Flow<2> flow = make_flow<2>(spec, Communicator::world());
    const std::size_t at_start = flow.setup.ranks.sum(count_fluid(flow));
    run(flow, 40);
    const OpenEndState& state = state_of_end(flow, 0);
    EXPECT_GT(level > 0.3 ? state.arrived.particles : state.departed.particles, 0) << "level " << level;
    EXPECT_EQ(flow.setup.ranks.sum(count_fluid(flow)) + static_cast<std::size_t>(state.departed.particles),
              at_start + static_cast<std::size_t>(state.arrived.particles));
    expect_same<2>(spec, 0.3, as_it_is);
  }
}

/// A column of water on a closed column of air: the pocket is below the water of all ranks.
TYPED_TEST(RanksTest, APocketOfAirAcrossTheCuts) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = tank_case<Dim>(dx, Dim == 2 ? 1.0 : 0.4, 0.8);
  spec.fluid[0].min[Dim - 1] = 0.5;
  spec.fluid[0].velocity = VectorField(Dim, 0.0);
  spec.fluid[0].velocity[Dim - 1] = -1.0;
  spec.air.pockets = AirPockets::adiabatic;
  spec.particles.jitter = 0.1;
  Flow<Dim> flow = make_flow<Dim>(spec, Communicator::world());
  start(flow);
  ASSERT_EQ(air_of(flow).state.pockets.size(), 1u);
  std::vector<double> response = air_of(flow).watch.response(air_of(flow).state.pockets[0].number).pressure;
  flow.halo().exchange(response);
  EXPECT_EQ(response, air_of(flow).watch.response(air_of(flow).state.pockets[0].number).pressure)
      << "ghosts, which water feels too";
  for (int n = 0; n < steps; ++n) pass_and_step(flow);
  EXPECT_GT(std::abs(air_of(flow).measures().pressure), 500.0)
      << "the gas is pressed together, or has thrown the water back";
  spec.vents.resize(1);
  spec.vents[0].at = Coordinates(Dim, 0.2);
  spec.vents[0].area = 1e-3;
  spec.pockets.resize(1);
  spec.pockets[0].at = spec.vents[0].at;
  spec.pockets[0].overpressure = 2000.0;
  expect_same<Dim>(spec, 0.8, as_it_is);
  if (Dim == 3) return;
  spec.scheme.integrator = Integrator::implicit_projection;  // the second solve is without the air
  expect_same<Dim>(spec, 0.8, as_it_is);
}

/// Sloshing water in a closed tank, whose air has one reference pocket on all ranks.
TYPED_TEST(RanksTest, ASealedTankAcrossTheCuts) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = tank_case<Dim>(dx, Dim == 2 ? 1.0 : 0.4, 0.4);
  spec.walls[0].open.clear();
  spec.fluid[0].max[0] *= 0.5;
  spec.fluid[0].velocity = VectorField(Dim, 0.0);
  spec.fluid[0].velocity[0] = 3.0;
  spec.air.pockets = AirPockets::adiabatic;
  spec.particles.jitter = 0.1;
  spec.pockets.resize(1);
  spec.pockets[0].at = Coordinates(Dim, 0.3);
  spec.pockets[0].at[Dim - 1] = 0.7;
  spec.pockets[0].overpressure = -2000.0;
  expect_same<Dim>(spec, 0.5, as_it_is);
}

/// All ranks know the water in the sump, though each rank has removed only its own particles.
TEST(RanksTest, WaterThatCirculatesIsTheSameOnAllRanks) {
  CaseSpec spec = jittered_tank<2>();
  OutletTable& end = open_end(spec);
  end.name = "end";
  end.level = 0.3;
  InletTable& start = open_start(spec);
  start.discharge = 0.3;
  start.water_from = "end";
  spec.fluid[0].velocity = {1.0, 0.0};
  Flow<2> flow = make_flow<2>(spec, Communicator::world());
  const std::size_t at_start = flow.setup.ranks.sum(count_fluid(flow));
  run(flow, 60);
  EXPECT_GT(state_of_end(flow, 0).arrived.particles, 0);
  EXPECT_EQ(flow.setup.ranks.sum(count_fluid(flow)) + static_cast<std::size_t>(sump_of(flow, 1).particles), at_start);
}

/// Fewer particles than ranks: some ranks have none.
TYPED_TEST(RanksTest, RanksWithoutParticlesWork) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = free_case(dx);
  spec.general.dimension = Dim;
  spec.physics.gravity = Coordinates(Dim, 0.0);
  spec.physics.gravity[0] = g;
  spec.study.length = 1.0;
  FluidTable drop;
  drop.min = Coordinates(Dim, 0.0);
  drop.max = Coordinates(Dim, dx);
  spec.fluid = {drop};
  expect_same<Dim>(spec, 1.0, as_it_is);
}

/// All ranks name the place at which the density error is largest, whichever of them owns it.
TEST(RanksTest, TheDensestWaterIsTheSameOnAllRanks) {
  Flow<2> flow = make_flow<2>(jittered_tank<2>(), Communicator::world());
  start(flow);
  const Particles<2>& particles = flow.state.particles;
  flow.surroundings.interior.assign(particles.size(), 1.0);
  for (std::int64_t dense = 0; dense < 40; dense += 13) {
    Vec<2> expected = Vec<2>::Zero();
    for (std::size_t i = 0; i < particles.owned; ++i) {
      const bool is_dense = particles.is_fluid(i) && particles.id[i] == dense;
      flow.surroundings.concentration[i] = is_dense ? 2.5 : 1.0;
      if (is_dense) expected = particles.position[i];
    }
    flow.setup.ranks.sum_each(expected[0], expected[1]);
    const DensestWater<2> densest = densest_water(flow);
    EXPECT_EQ(densest.position, expected) << dense;
    EXPECT_EQ(densest.error, 1.5);
    EXPECT_FALSE(densest.is_prescribed);
  }
}

/// From the collapse to the impact, after which the flow is chaotic. In scheme B particles and ghosts move between the
/// prediction and its divergence.
TEST(RanksTest, DamBreakWithinTheSolversTolerance) {
  const double end = 2.0 * std::sqrt(0.6 / g);
  constexpr int max_steps = 500;  // far more than needed; with a water explosion the steps would become ever smaller
  const auto energy_at_end = [&](Flow<2>& flow) {
    start(flow);
    while (flow.state.time < end && flow.state.step < max_steps) pass_and_step(flow);
    EXPECT_GE(flow.state.time, end);
    return measure(flow).energy();
  };
  for (const SchemeName name : {SchemeName::farzin2014, SchemeName::farmani2020}) {
    CaseSpec spec = zhou_case(0.06, Integrator::explicit_projection);
    spec.scheme.name = name;
    apply_formulation(spec.scheme);
    const Communicator world = Communicator::world();
    Flow<2> shared = make_flow<2>(spec, world);
    const double found = energy_at_end(shared);
    if (!world.is_root()) continue;
    Flow<2> alone = make_flow<2>(spec);
    const double expected = energy_at_end(alone);
    EXPECT_NEAR(found, expected, spec.pressure_solver.tolerance * expected) << name_of(name);
  }
}

/// Work is measured in pairs; the parts follow the motion of the water.
TEST(RanksTest, WorkStaysSharedEvenly) {
  CaseSpec spec = zhou_case(0.02, Integrator::explicit_projection);
  Flow<2> flow = make_flow<2>(spec, Communicator::world());
  start(flow);
  repartition(flow);
  for (int n = 0; n < 60; ++n) {
    if (n % 5 == 0) {
      const Repartition result = repartition(flow);
      // A cut cannot divide a column of the lattice of 60 x 30, which is 1 in 60 of all the work.
      if (n > 5) {
        EXPECT_LT(result.imbalance, spec.parallel.imbalance + flow.setup.ranks.size() / 60.0);
      }
    }
    advance(flow, next_time_step(flow));
  }
}

// In a mostly dry tank, a rank has the wall rows of its home region, and those of its particles and ghosts.
TYPED_TEST(RanksTest, HaveAShareOfTheWallsAndThoseTheyNeed) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = jittered_tank<Dim>();
  spec.walls[0].max[Dim - 1] = 2.4;  // eight times as high as the water
  const Communicator world = Communicator::world();
  const Flow<Dim> alone = make_flow<Dim>(spec);
  Flow<Dim> flow = make_flow<Dim>(spec, world);
  run(flow, 6);
  const auto all = static_cast<double>(alone.walls.particles.size());
  EXPECT_EQ(flow.walls.all, alone.walls.all);
  EXPECT_LE(static_cast<double>(flow.walls.kept), 1.1 * all / world.size());
  if (!world.is_alone()) {
    EXPECT_LT(static_cast<double>(flow.walls.particles.size()), 0.9 * all);
  }
  locate(flow);
  const Particles<Dim>& particles = flow.state.particles;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (particles.is_fluid(i)) continue;
    ASSERT_GE(particles.wall_row[i], 0);
    EXPECT_EQ(flow.walls.particles.position[particles.wall_row[i]], particles.position[i]);
    EXPECT_EQ(flow.walls.particles.number[particles.wall_row[i]], particles.id[i] - flow.setup.first_wall_id);
  }
}

TYPED_TEST(RanksTest, BodyFloats) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = tank_case<Dim>(dx, Dim == 2 ? 0.8 : 0.6, 0.3);
  spec.particles.jitter = 0.1;  // on a lattice, rounding decides which cells are air
  spec.particles.seed = 2;      // with seed 1 the motion of four ranks meets a switch in 2D, which rounding decides
  WallTable hull;
  hull.name = "hull";
  hull.shape = WallShape::box;
  const double middle = 0.5 * spec.fluid[0].max[0];
  hull.min = Coordinates(Dim, middle - 0.1);
  hull.max = Coordinates(Dim, middle + 0.1);
  hull.min[Dim - 1] = 0.2;
  hull.max[Dim - 1] = 0.5;
  hull.fluid_side = FluidSide::outside;
  hull.drive = {Drive::By::body, 0};
  spec.walls.push_back(hull);
  BodyTable body;
  body.name = "barge";
  body.walls = {"hull"};
  body.mass = Dim == 2 ? 30.0 : 6.0;
  body.centre = Coordinates(Dim, middle);
  body.centre[Dim - 1] = 0.4;
  body.inertia = std::vector<double>(Dim == 2 ? 1 : 3, 0.3);
  body.velocity = Coordinates(Dim, 0.0);
  body.free = Dim == 2 ? std::vector<std::string>{"x", "y", "rotation"}
                       : std::vector<std::string>{"x", "y", "z", "rotation_x", "rotation_y", "rotation_z"};
  spec.bodies = {body};
  if (Dim == 2) expect_same<Dim>(spec, 0.15, as_it_is);
  spec.walls[0].open.clear();
  spec.air.pockets = AirPockets::adiabatic;
  spec.pockets.resize(1);
  spec.pockets[0].at = Coordinates(Dim, 0.55);
  spec.pockets[0].overpressure = 1000.0;
  if (Dim == 2) {
    Flow<Dim> flow = make_flow<Dim>(spec, Communicator::world());
    start(flow);
    std::vector<double> less(flow.state.particles.size(), 1.0);
    subtract_seen_air<Dim>(flow, air_of(flow), std::vector{1.0}, less);
    const std::vector<double> before = less;
    flow.halo().exchange(less);
    EXPECT_EQ(less, before) << "a force on walls is that of ghosts too";
  }
  expect_same<Dim>(spec, 0.15, as_it_is);
}

/// Water under a body on the bed, whose underside rises across the cut between two ranks. Some of the water is
/// stagnant, with a pressure computed from the water at both ends of the gap.
TEST(RanksTest, WaterIsHeldInTheNarrowGapUnderABody) {
  CaseSpec spec = tank_case<2>(dx, 0.8, 0.3);
  spec.particles.jitter = 0.1;
  WallTable hull;
  hull.name = "hull";
  hull.shape = WallShape::polygon;
  hull.points = {{0.2, 0.3 * dx}, {0.35, 0.3 * dx}, {0.5, dx}, {0.5, 0.4}, {0.2, 0.4}};
  hull.fluid_side = FluidSide::outside;
  hull.drive = {Drive::By::body, 0};
  spec.walls.push_back(hull);
  BodyTable body;
  body.name = "wedge";
  body.walls = {"hull"};
  body.mass = 90.0;
  body.centre = {0.35, 0.2};
  body.inertia = {1.0};
  body.velocity = {0.0, 0.0};
  body.free = {"y"};
  spec.bodies = {body};
  Flow<2> flow = make_flow<2>(spec, Communicator::world());
  run(flow, 1);
  EXPECT_GT(flow.setup.ranks.sum(static_cast<int>(bodies_of(flow).stagnant.size())), 0);
  expect_same<2>(spec, 0.3, as_it_is);
}

}  // namespace ranks_test
}  // namespace tailwater
