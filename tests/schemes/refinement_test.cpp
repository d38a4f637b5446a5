// Zones of finer particles: what splits and merges keep, and water that stands and flows through a zone.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "flow/stages.h"
#include "parts/refinement.h"
#include "parts/section_counters.h"
#include "schemes/cases.h"
#include "schemes/open_ends.h"
#include "support/particle_set.h"

namespace tailwater {
namespace refinement_test {

constexpr double dx = 0.05;

/// Water 1.6 m long that flows at 1 m/s past a bed, in a domain that repeats, with a zone in its middle.
CaseSpec stream() {
  CaseSpec spec;
  spec.particles.spacing = dx;
  spec.domain.periodic_x = {0.0, 1.6};
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {1.6, 0.4};
  water.velocity = {1.0, 0.0};
  WallTable bed;
  bed.points = {{0.0, 0.0}, {1.6, 0.0}};
  spec.fluid = {water};
  spec.walls = {bed};
  RefinementTable zone;
  zone.name = "middle";
  zone.min = {0.4, -1.0};
  zone.max = {1.2, 2.0};
  spec.refinement = {zone};
  return spec;
}

struct Totals {
  double volume = 0.0;
  Vec<2> momentum = Vec<2>::Zero();
  Vec<2> moment = Vec<2>::Zero();  ///< of the volume
  double energy = 0.0;             ///< kinetic
};

Totals totals_of(const Flow<2>& flow) {
  Totals totals;
  const Particles<2>& particles = flow.state.particles;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    totals.volume += particles.volume[i];
    totals.momentum += particles.volume[i] * particles.velocity[i];
    totals.moment += particles.volume[i] * particles.position[i];
    totals.energy += flow.kinetic_energy_of(i);
  }
  return totals;
}

/// The steps of a run, between which particles split and merge.
void advance_steps(Flow<2>& flow, int steps) {
  for (int n = 0; n < steps; ++n) {
    if (flow.state.step % 10 == 0) sort_particles(flow);
    adapt(flow);
    step(flow);
  }
}

TEST(RefinementTest, SplitsAndMergesKeepVolumeMomentumAndPlace) {
  Flow<2> flow = make_flow<2>(stream());
  tailwater::start(flow);
  const Refinement<2>& part = flow.part<Refinement<2>>();
  for (int n = 0; n < 60; ++n) {
    const std::int64_t before = part.splits() + part.merges();
    const double energy_before = part.energy();
    const Totals old = totals_of(flow);
    adapt(flow);
    const Totals now = totals_of(flow);
    const double rounding = 1e-13 * old.volume;
    EXPECT_NEAR(now.volume, old.volume, rounding);
    EXPECT_NEAR((now.momentum - old.momentum).norm(), 0.0, 10.0 * rounding);
    EXPECT_NEAR((now.moment - old.moment).norm(), 0.0, 10.0 * rounding);
    EXPECT_NEAR(now.energy - old.energy, part.energy() - energy_before, 1e-9 * old.energy);
    const bool changes = part.splits() + part.merges() > before;
    EXPECT_TRUE(changes || now.energy == old.energy);
    step(flow);
  }
  EXPECT_GT(part.splits(), 50);
  EXPECT_GT(part.merges(), 50);
}

TEST(RefinementTest, VolumesFollowTheFieldAndIdsAreUnique) {
  Flow<2> flow = make_flow<2>(stream());
  tailwater::start(flow);
  advance_steps(flow, 100);
  const Particles<2>& particles = flow.state.particles;
  std::vector<std::int64_t> ids(particles.id.begin(),
                                particles.id.begin() + static_cast<std::ptrdiff_t>(particles.owned));
  std::ranges::sort(ids);
  EXPECT_EQ(std::ranges::adjacent_find(ids), ids.end());
  std::size_t inside = 0;
  std::size_t fine = 0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    const double wanted = power<2>(dx * flow.setup.relative_spacing(particles.position[i]));
    // Between two adaptations water goes about a spacing, over which the wanted volume changes by less than a half.
    EXPECT_LT(particles.volume[i], 1.5 * volume_to_split * wanted);
    inside += wanted < 0.3 * dx * dx ? 1 : 0;
    fine += wanted < 0.3 * dx * dx && particles.volume[i] < 0.35 * dx * dx ? 1 : 0;
  }
  EXPECT_GT(inside, 100u);
  EXPECT_GT(fine, inside * 9 / 10);
}

/// Splits and merges in the border of a zone move water through the sections there.
TEST(RefinementTest, SectionsInTheBorderOfAZoneCountAllWater) {
  CaseSpec spec = stream();
  spec.walls[0].friction = 0.0;
  for (const double x : {0.1, 0.3, 0.4, 0.5, 1.1, 1.2, 1.3}) {
    ProbeTable section;
    section.name = fmt::format("at {}", x);
    section.type = ProbeType::discharge;
    section.from = {x, 0.0};
    section.to = {x, 0.8};
    section.direction = {1.0, 0.0};
    spec.probes.push_back(section);
  }
  Flow<2> flow = make_flow<2>(spec);
  tailwater::start(flow);
  while (flow.state.time < 1.5) advance_steps(flow, 1);
  for (const double volume : flow.part<SectionCounters<2>>().volumes()) {
    EXPECT_NEAR(volume, 0.4 * flow.state.time, 0.4 * dx);
  }
}

TEST(RefinementTest, AZoneThatMovesWithTheStreamDividesNoWater) {
  CaseSpec spec = stream();
  spec.walls[0].friction = 0.0;
  spec.refinement[0].displacement = {"1.0*t", 0.0};
  Flow<2> flow = make_flow<2>(spec);
  tailwater::start(flow);
  const Totals old = totals_of(flow);
  advance_steps(flow, 100);
  EXPECT_GT(flow.state.time, 0.3);
  // At rest the zone divides and unites several hundreds of particles in this time.
  EXPECT_LT(flow.part<Refinement<2>>().splits() + flow.part<Refinement<2>>().merges(), 20);
  EXPECT_NEAR(totals_of(flow).energy, old.energy, 1e-2 * old.energy);
}

TEST(RefinementTest, AZoneMovesThroughStillWaterByItsDisplacement) {
  CaseSpec spec = stream();
  spec.fluid[0].velocity = {};
  spec.refinement[0].displacement = {"-0.8*t", 0.0};
  Flow<2> flow = make_flow<2>(spec);
  tailwater::start(flow);
  while (flow.state.time < 1.0) advance_steps(flow, 1);
  const Particles<2>& particles = flow.state.particles;
  std::size_t inside = 0;
  std::size_t fine = 0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    const double behind = particles.position[i][0] < 0.8 ? particles.position[i][0] + 1.6 : particles.position[i][0];
    // The finest part of the zone, now from 1.4 m to 1.8 m, over the end of the period.
    if (!particles.is_fluid(i) || behind < 1.4 || behind > 1.8) continue;
    ++inside;
    if (particles.volume[i] < 0.35 * dx * dx) ++fine;
  }
  EXPECT_GT(inside, 100u);
  EXPECT_GT(fine, inside * 9 / 10);
}

TEST(RefinementTest, AStreamThroughAZoneKeepsItsVelocity) {
  CaseSpec spec = stream();
  spec.walls[0].friction = 0.0;
  Flow<2> flow = make_flow<2>(spec);
  tailwater::start(flow);
  const Totals old = totals_of(flow);
  advance_steps(flow, 200);
  const Totals now = totals_of(flow);
  EXPECT_NEAR(now.volume, old.volume, 1e-12 * old.volume);
  // Pairs of water conserve momentum. Pressures of dummies push along a smooth bed where they vary: the same water at
  // one spacing gains half a percent in 5 s.
  EXPECT_NEAR(now.momentum[0], old.momentum[0], 5e-3 * old.momentum[0]);
  EXPECT_NEAR(now.energy, old.energy, 1e-2 * old.energy);
  // If delta of the surface were relative to the mean of the border, its force would speed the stream up by half a
  // percent.
  EXPECT_LT(now.energy, 1.002 * old.energy);
}

TEST(RefinementTest, TheImplicitIntegratorKeepsAStreamThroughAZone) {
  CaseSpec spec = stream();
  spec.walls[0].friction = 0.0;
  spec.scheme.integrator = Integrator::implicit_projection;
  Flow<2> flow = make_flow<2>(spec);
  tailwater::start(flow);
  const Totals old = totals_of(flow);
  advance_steps(flow, 60);
  const Totals now = totals_of(flow);
  EXPECT_GT(flow.part<Refinement<2>>().splits(), 50);
  EXPECT_NEAR(now.volume, old.volume, 1e-12 * old.volume);
  EXPECT_NEAR(now.momentum[0], old.momentum[0], 5e-3 * old.momentum[0]);
  EXPECT_NEAR(now.energy, old.energy, 1e-2 * old.energy);
}

/// Place [m] of the front 0.3 s after a gate before a column 0.5 m wide begins to rise at 1.5 m/s.
double front_behind_gate(const CaseSpec& tank) {
  CaseSpec spec = tank;
  spec.fluid[0].max = {0.5, 0.4};
  WallTable gate;
  gate.shape = WallShape::plate;
  gate.points = {{0.5, 0.0}, {0.5, 0.6}};
  gate.displacement = {0.0, "1.5*t"};
  spec.walls.push_back(gate);
  Flow<2> flow = make_flow<2>(spec);
  tailwater::start(flow);
  while (flow.state.time < 0.3) advance_steps(flow, 1);
  double front = 0.0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (flow.state.particles.is_fluid(i)) front = std::max(front, flow.state.particles.position[i][0]);
  }
  return front;
}

TEST(RefinementTest, AGateInAZoneReleasesWaterAsInAFineRun) {
  CaseSpec spec = tank_case<2>(dx, 2.0, 0.4);
  RefinementTable zone;
  zone.min = {-1.0, -1.0};
  zone.max = {1.5, 9.0};
  spec.refinement = {zone};
  const double in_zone = front_behind_gate(spec);
  spec.refinement.clear();
  spec.particles.spacing = 0.5 * dx;
  EXPECT_NEAR(in_zone, front_behind_gate(spec), 0.5 * dx);
  EXPECT_GT(in_zone, 0.8);
}

/// Kinetic energy of the water around a block that has set itself in motion for 0.4 s.
double energy_around_block(const CaseSpec& spec) {
  Flow<2> flow = make_flow<2>(spec);
  tailwater::start(flow);
  while (flow.state.time < 0.4) advance_steps(flow, 1);
  const Particles<2>& particles = flow.state.particles;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    const double wanted = power<2>(spec.particles.spacing * flow.setup.relative_spacing(particles.position[i]));
    EXPECT_LT(particles.volume[i], 1.5 * volume_to_split * wanted);
  }
  if (!spec.refinement.empty()) {
    EXPECT_LT(flow.setup.relative_spacing({1.4, 0.35}), 1.0) << "before the block, which has arrived at 1.08 m";
    EXPECT_EQ(flow.setup.relative_spacing({0.4, 0.35}), 1.0) << "the block has left";
  }
  return totals_of(flow).energy;
}

TEST(RefinementTest, AZoneMovesWithItsBlock) {
  CaseSpec spec = tank_case<2>(dx, 2.4, 0.7);
  WallTable block;
  block.name = "block";
  block.points = {{0.6, 0.25}, {0.8, 0.25}, {0.8, 0.45}, {0.6, 0.45}};
  block.shape = WallShape::polygon;
  block.fluid_side = FluidSide::outside;
  block.displacement = {"3*t^2", 0.0};  // to 0.48 m, farther than the width of the border
  spec.walls.push_back(block);
  RefinementTable zone;
  zone.shape = ZoneShape::walls;
  zone.walls = {"block"};
  zone.distance = 0.2;
  spec.refinement = {zone};
  const double in_zone = energy_around_block(spec);
  spec.refinement.clear();
  spec.particles.spacing = 0.5 * dx;
  const double fine = energy_around_block(spec);
  EXPECT_NEAR(in_zone, fine, 0.03 * fine);
}

/// Largest speed within 0.1 s of still water 0.5 m deep before a beach of 1 : 5.
double speed_before_beach(const CaseSpec& spec) {
  Flow<2> flow = make_flow<2>(spec);
  tailwater::start(flow);
  double speed = 0.0;
  while (flow.state.time < 0.1) {
    advance_steps(flow, 1);
    speed = std::max(speed, measure(flow).largest_speed);
  }
  return speed;
}

TEST(RefinementTest, WaterOnABeachInAZoneStartsAsInAFineRun) {
  CaseSpec spec;
  spec.particles.spacing = dx;
  FluidTable water;
  water.shape = BlockShape::fill;
  water.seed = {0.1, 0.1};
  water.level = 0.5;
  WallTable bed;
  bed.points = {{0.0, 1.0}, {0.0, 0.0}, {2.0, 0.0}, {7.0, 1.0}, {7.0, 1.5}};
  bed.fluid_side = FluidSide::left;
  spec.fluid = {water};
  spec.walls = {bed};
  RefinementTable zone;
  zone.min = {1.0, -1.0};
  zone.max = {9.0, 9.0};
  spec.refinement = {zone};
  const double in_zone = speed_before_beach(spec);
  spec.refinement.clear();
  spec.particles.spacing = 0.5 * dx;
  // Cells of the case, divided after they have been fitted to the beach, start three times as fast.
  EXPECT_LT(in_zone, 1.5 * speed_before_beach(spec));
}

TEST(RefinementTest, WaterComesToRestBesideABorder) {
  CaseSpec spec = tank_case<2>(dx, 1.0, 0.5);
  RefinementTable zone;
  zone.min = {-1.0, -1.0};
  zone.max = {2.0, 0.3};
  spec.refinement = {zone};
  Flow<2> flow = make_flow<2>(spec);
  tailwater::start(flow);
  const double volume = totals_of(flow).volume;
  advance_steps(flow, 300);  // the lattice of the start settles, most of all where volumes change
  const double energy = totals_of(flow).energy;
  advance_steps(flow, 300);
  EXPECT_NEAR(totals_of(flow).volume, volume, 1e-12 * volume);
  // Without the terms of support_terms.h the water rolls: its energy rises between these steps by a half.
  EXPECT_LT(totals_of(flow).energy, 0.5 * energy);
  const FlowMeasures measures = measure(flow);
  EXPECT_LT(measures.largest_speed, 0.03 * std::sqrt(g * 0.5));
  EXPECT_LT(measures.density_error_rms, 0.006);
}

TEST(RefinementTest, PressureAndVelocityAreAdjointAndMomentumIsExactInside) {
  CaseSpec spec = tank_case<2>(dx, 1.0, 0.5);
  RefinementTable zone;
  zone.min = {0.4, -1.0};
  zone.max = {2.0, 2.0};
  spec.refinement = {zone};
  Flow<2> flow = make_flow<2>(spec);
  tailwater::start(flow);
  advance_steps(flow, 20);
  const Particles<2>& particles = flow.state.particles;
  Noise noise(5);
  std::vector<Vec<2>> velocity(particles.size(), Vec<2>::Zero());
  std::vector<double> pressure(particles.size(), 0.0);
  std::vector<std::size_t> walls;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) walls.push_back(i);
    if (!particles.is_fluid(i)) continue;
    velocity[i] = noise.vector<2>();
    pressure[i] = noise();
  }
  std::vector<double> divergence(particles.owned, 0.0);
  std::vector<Vec<2>> gradient(particles.owned, Vec<2>::Zero());
  std::vector<Vec<2>> pushes(walls.size());
  flow.discretisation().find_divergence(flow, velocity, divergence);
  flow.discretisation().find_gradient(flow, pressure, gradient);
  double on_volume = 0.0;  // work of the pressure
  double on_water = 0.0;
  double size = 0.0;
  std::size_t beside_border = 0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    on_volume += particles.volume[i] * pressure[i] * divergence[i];
    on_water -= particles.volume[i] * velocity[i].dot(gradient[i]);
    size += particles.volume[i] * std::abs(pressure[i] * divergence[i]);
    beside_border += flow.surroundings.support_terms.is_near_border(i) ? 1 : 0;
  }
  EXPECT_NEAR(on_volume, on_water, 1e-5 * size);  // the rounding of sums in single precision
  EXPECT_GT(beside_border, 50u);
  // Near the surface of a border the force that balances the tension of the surface acts on the water alone.
  for (std::size_t i = 0; i < particles.owned; ++i) pressure[i] *= flow.surroundings.interior[i] == 1.0 ? 1.0 : 0.0;
  flow.discretisation().find_gradient(flow, pressure, gradient);
  flow.discretisation().wall_reactions(flow, walls, pressure, pushes);
  Vec<2> force = Vec<2>::Zero();
  double forces = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    force += particles.volume[i] * gradient[i];
    forces += particles.volume[i] * gradient[i].norm();
  }
  for (std::size_t n = 0; n < walls.size(); ++n) force += particles.volume[walls[n]] * pushes[n];
  EXPECT_NEAR(force.norm(), 0.0, 1e-6 * forces);
}

/// The water that comes in within 0.4 s of even flow through a channel.
WaterAmount inflow_of_channel(CaseSpec spec) {
  spec.inlets[0].discharge = "0.15";
  spec.fluid[0].velocity = {0.5, 0.0};
  spec.walls[0].friction = 0.0;
  Flow<2> flow = make_flow<2>(spec);
  tailwater::start(flow);
  while (flow.state.time < 0.4) {
    adapt(flow);
    pass_and_step(flow);
  }
  return flow.part<OpenEnds<2>>().arrived();
}

TEST(RefinementTest, WaterEntersAZoneAtItsSpacing) {
  CaseSpec spec = channel<2>(1.6, 0.3);
  RefinementTable zone;
  zone.min = {-1.0, -1.0};
  zone.max = {1.0, 9.0};  // the inlet, with its buffer
  spec.refinement = {zone};
  const WaterAmount in_zone = inflow_of_channel(spec);
  spec.refinement.clear();
  spec.particles.spacing = 0.5 * dx;
  const WaterAmount fine = inflow_of_channel(spec);
  constexpr double column = 12.0;  // particles
  EXPECT_GT(fine.particles, 5 * column);
  EXPECT_NEAR(static_cast<double>(in_zone.particles), static_cast<double>(fine.particles), column);
  EXPECT_NEAR(in_zone.volume, fine.volume, column * 0.25 * dx * dx);
}

TEST(RefinementTest, WallsInAZoneHaveItsSpacing) {
  CaseSpec spec = tank_case<2>(dx, 1.0, 0.5);
  const Flow<2> coarse = make_flow<2>(spec);
  RefinementTable zone;
  zone.min = {-1.0, -1.0};
  zone.max = {2.0, 2.0};  // the whole tank
  spec.refinement = {zone};
  const Flow<2> zoned = make_flow<2>(spec);
  CaseSpec may_move = spec;
  for (WallTable& wall : may_move.walls) wall.displacement = {"0*t", "0"};
  const Flow<2> moving = make_flow<2>(may_move);
  spec.refinement.clear();
  spec.particles.spacing = 0.5 * dx;
  const Flow<2> fine = make_flow<2>(spec);
  const auto cells_behind_floor = [](const Flow<2>& flow) {
    return std::ranges::count_if(flow.walls.particles.position,
                                 [](const Vec<2>& x) { return x[1] > -dx && x[1] < 0.0 && x[0] > 0.0 && x[0] < 1.0; });
  };
  EXPECT_EQ(cells_behind_floor(zoned), cells_behind_floor(fine));
  EXPECT_EQ(cells_behind_floor(moving), cells_behind_floor(fine));
  EXPECT_EQ(cells_behind_floor(fine), 4 * cells_behind_floor(coarse));
  // No rows behind those; the edges are rounded to whole rows of the case.
  EXPECT_LT(zoned.walls.particles.size(), 1.2 * static_cast<double>(fine.walls.particles.size()));
  const auto water = [](const Flow<2>& flow) {
    return count_each(flow.state.particles.owned, [&](std::size_t i) { return flow.state.particles.is_fluid(i); });
  };
  EXPECT_EQ(water(zoned), water(fine));
}

}  // namespace refinement_test
}  // namespace tailwater
