// The field of spacings of zones that are not boxes.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/finding.h"
#include "case/choices.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "geometry/rotation.h"
#include "operators/continuum_table.h"
#include "refinement/spacing_field.h"

namespace tailwater {
namespace spacing_field_test {

constexpr double dx = 0.1;
constexpr double border = border_per_level * dx;

/// Walls of a tank of 4 m x 3 m, and a block on its floor from x = 2 to 2.5 m, 0.6 m high, a wall with the name
/// "block".
CaseSpec tank_with_block() {
  CaseSpec spec;
  spec.particles.spacing = dx;
  WallTable tank;
  tank.name = "tank";
  tank.points = {{0.0, 3.0}, {0.0, 0.0}, {4.0, 0.0}, {4.0, 3.0}};
  tank.fluid_side = FluidSide::left;
  tank.displacement = {0.0, 0.0};
  WallTable block = tank;
  block.name = "block";
  block.points = {{2.0, 0.0}, {2.0, 0.6}, {2.5, 0.6}, {2.5, 0.0}};
  spec.walls = {tank, block};
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {4.0, 2.0};
  spec.fluid = {water};
  return spec;
}

SpacingField<2> field_of(CaseSpec spec, const RefinementTable& zone) {
  spec.refinement = {zone};
  return {spec, make_boundary<2>(spec)};
}

RefinementTable around_block(double distance) {
  RefinementTable zone;
  zone.shape = ZoneShape::walls;
  zone.walls = {"block"};
  zone.distance = distance;
  return zone;
}

/// A parallelogram with a vertical left edge, whose floor is that of the tank.
RefinementTable slanted() {
  RefinementTable zone;
  zone.shape = ZoneShape::polygon;
  zone.points = {{1.0, 0.0}, {4.0, 0.0}, {4.0, 2.5}, {1.0, 1.5}};
  return zone;
}

/// The slope is the derivative of h, and h varies only in borders.
void expect_consistent(const SpacingField<2>& field) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> along(0.0, 4.0);
  constexpr double step = 1e-6;
  int varies = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec<2> x(along(random), 0.75 * along(random));
    const Vec<2> slope = field.slope(x);
    Vec<2> difference;
    for (int axis = 0; axis < 2; ++axis) {
      const Vec<2> side = step * Vec<2>::Unit(axis);
      difference[axis] = (field.at(Vec<2>(x + side)) - field.at(Vec<2>(x - side))) / (2.0 * step);
    }
    // Steps of up to 1e-6 m beside a kink, of which none of these places is one.
    EXPECT_NEAR((slope - difference).norm(), 0.0, 1e-4 / dx) << x[0] << ' ' << x[1];
    const auto nearest = field.nearest_border(x);
    if (nearest.distance > 0.0) {
      EXPECT_EQ(slope.norm(), 0.0);
      Vec<2> place = field.drawn(x);
      EXPECT_EQ(field.varies_around(place, 0.99 * nearest.distance), false);
      EXPECT_EQ(field.varies_around(place, 1.01 * nearest.distance), true);
    }
    varies += slope.norm() > 0.0 ? 1 : 0;
  }
  EXPECT_GT(varies, 100);
}

TEST(SpacingField, IsFinestWithinTheDistanceFromWallsAndFadesBeyond) {
  const SpacingField<2> field = field_of(tank_with_block(), around_block(0.3));
  expect_consistent(field);
  for (const double distance : {0.0, 0.1, 0.299}) EXPECT_EQ(field.at({2.0 - distance, 0.2}), 0.5);
  EXPECT_EQ(field.at({2.2, 0.89}), 0.5);
  EXPECT_EQ(field.at({2.2, 0.3}), 0.5);  // inside the block, where its dummies are
  EXPECT_NEAR(field.at({2.0 - 0.3 - 0.5 * border, 0.2}), std::exp2(-0.5), 1e-12);
  EXPECT_EQ(field.at({2.0 - 0.301 - border, 0.2}), 1.0);
  EXPECT_LT(field.at({2.0 - 0.299 - border, 0.2}), 1.0);
  EXPECT_EQ(field.finest(), 0.5);
}

TEST(SpacingField, IsCarriedByWallsThatMove) {
  CaseSpec spec = tank_with_block();
  const SpacingField<2> drawn = field_of(spec, around_block(0.3));
  EXPECT_EQ(drawn.carrier(), -1);
  spec.walls[1].displacement = {"0.1*t", 0.0};
  const SpacingField<2> field = field_of(spec, around_block(0.3));
  const SpacingField<2> copy = field;
  ASSERT_EQ(field.carrier(), 1);
  EXPECT_EQ(copy.at({1.5, 0.2}), drawn.at({1.5, 0.2}));
  const Mat<2> turn = rotation_in_plane(0.3);
  const Vec<2> shift(0.4, 0.7);
  field.carry(turn, shift);
  expect_consistent(copy);
  const Kernel<2> kernel = make_kernel<2>(KernelName::wendland_c2, 3.0 * dx);
  const GradedSums<2> sums(kernel, dx, copy);
  const GradedSums<2> sums_at_rest(kernel, dx, drawn);
  ContinuumTable<2> table;
  ContinuumTable<2> table_at_rest;
  for (double x = 1.203; x < 2.0; x += 0.053) {  // between the nodes of the table, where its slope jumps
    const Vec<2> place(x, 0.207);
    const auto at_rest = table_at_rest.at(sums_at_rest, place);
    const auto carried = table.at(sums, Vec<2>(turn * place + shift));
    EXPECT_NEAR(copy.at(Vec<2>(turn * place + shift)), drawn.at(place), 1e-12);
    EXPECT_NEAR(carried.sums.concentration, at_rest.sums.concentration, 1e-9);
    EXPECT_NEAR((carried.slope - turn * at_rest.slope).norm(), 0.0, 1e-7);
    EXPECT_NEAR((carried.sums.gradient - turn * at_rest.sums.gradient).norm(), 0.0, 1e-7);
    const Vec<2> e(0.6, 0.8);
    const double along = (unpacked<2>(at_rest.sums.first_moment) * e).dot(e);
    const Vec<2> turned = turn * e;
    EXPECT_NEAR((unpacked<2>(carried.sums.first_moment) * turned).dot(turned), along, 1e-9);
  }
}

/// A zone that enters the tank during the run counts as where it has its most particles.
TEST(SpacingField, AZoneThatEntersTheTankCountsThere) {
  CaseSpec spec = tank_with_block();
  spec.time.end = 3.0;
  RefinementTable zone;
  zone.min = {1.0, 0.9};
  zone.max = {2.4, 2.3};
  const auto particles = [&] {
    const Boundary<2> boundary = make_boundary<2>(spec);
    return particles_of_full_zone<2>(field_of(spec, zone), 0, spec, box_around(boundary.faces), boundary);
  };
  const double at_rest = particles();
  zone.displacement = {"t - 2.6", 0.0};
  EXPECT_NEAR(particles(), at_rest, 1e-3 * at_rest);
}

TEST(SpacingField, APolygonIsAPrismInThreeDimensions) {
  CaseSpec spec = tank_with_block();
  const SpacingField<2> in_plan = field_of(spec, slanted());
  spec.general.dimension = 3;
  WallTable tank;
  tank.shape = WallShape::box;
  tank.min = {0.0, 0.0, -1.0};
  tank.max = {4.0, 3.0, 2.0};
  tank.displacement = {0.0, 0.0, 0.0};
  spec.walls = {tank};
  spec.refinement = {slanted()};
  const SpacingField<3> field(spec, make_boundary<3>(spec));
  for (double x = 0.9; x < 4.0; x += 0.13) {
    for (const double z : {-1.5, 0.3, 2.0}) {
      const Vec<3> place(x, 0.4 * x, z);
      EXPECT_EQ(field.at(place), in_plan.at({x, 0.4 * x}));
      EXPECT_NEAR(
          (field.slope(place) - Vec<3>(in_plan.slope({x, 0.4 * x})[0], in_plan.slope({x, 0.4 * x})[1], 0.0)).norm(),
          0.0, 1e-12);
    }
  }
}

TEST(SpacingField, APolygonHasNoBorderWhereItEndsAtTheOutermostWalls) {
  const SpacingField<2> field = field_of(tank_with_block(), slanted());
  expect_consistent(field);
  for (const double y : {-0.2, 0.0, 0.5}) EXPECT_EQ(field.at({3.0, y}), 0.5) << y;
  for (const double x : {3.9, 4.0, 4.2}) EXPECT_EQ(field.at({x, 0.5}), 0.5) << x;
  EXPECT_EQ(field.at({1.0, 0.5}), 1.0);
  EXPECT_NEAR(field.at({1.0 + 0.5 * border, 0.5}), std::exp2(-0.5), 1e-12);
  EXPECT_EQ(field.at({1.0 + 1.01 * border, 0.5}), 0.5);
  // Beside the slanted edge, across it.
  const Vec<2> down = Vec<2>(1.0, -3.0) / std::sqrt(10.0);
  EXPECT_NEAR(field.at(Vec<2>(Vec<2>(2.5, 2.0) + 0.5 * border * down)), std::exp2(-0.5), 1e-12);
}

TEST(SpacingField, AZoneBelowTheSurfaceReachesUpwardsWithoutEnd) {
  RefinementTable zone;
  zone.shape = ZoneShape::surface;
  zone.distance = 0.25;
  const SpacingField<2> field = field_of(tank_with_block(), zone);
  expect_consistent(field);
  for (const double y : {1.75, 2.0, 9.0}) EXPECT_EQ(field.at({1.0, y}), 0.5);
  EXPECT_NEAR(field.at({1.0, 1.75 - 0.5 * border}), std::exp2(-0.5), 1e-12);
  EXPECT_EQ(field.at({1.0, 1.75 - border}), 1.0);
  CaseSpec dry = tank_with_block();
  dry.fluid.clear();
  EXPECT_THROW(field_of(dry, zone), CaseError);
  CaseSpec tilted = tank_with_block();
  tilted.physics.gravity = {1.0, -9.0};
  EXPECT_EQ(field_of(tilted, zone).at({1.0, 1.75}), 0.5);  // a channel along a sloping bed
  tilted.physics.gravity = {9.0, -1.0};
  EXPECT_THROW(field_of(tilted, zone), CaseError);
  tilted.physics.gravity = {1.0, -9.0};
  tilted.fluid[0].shape = BlockShape::polygon;
  tilted.fluid[0].points = {{0.0, 0.0}, {4.0, 0.0}, {4.0, 2.25}, {0.0, 1.75}};
  EXPECT_THROW(field_of(tilted, zone), CaseError);
}

TEST(SpacingField, RepeatsItselfWithThePeriod) {
  CaseSpec spec = tank_with_block();
  spec.walls = {spec.walls[0]};
  spec.walls[0].points = {{0.0, 0.0}, {4.0, 0.0}};
  spec.domain.periodic_x = {0.0, 4.0};
  RefinementTable zone;
  zone.shape = ZoneShape::polygon;
  zone.points = {{3.0, -1.0}, {5.2, -1.0}, {5.2, 1.5}, {3.0, 1.5}};
  const SpacingField<2> field = field_of(spec, zone);
  for (const double x : {3.5, 3.99, 4.01, 0.01, 0.7}) EXPECT_EQ(field.at({x, 0.5}), 0.5) << x;
  EXPECT_EQ(field.at({1.3, 0.5}), 1.0);
  EXPECT_EQ(field.at({2.9, 0.5}), 1.0);
}

}  // namespace spacing_field_test
}  // namespace tailwater
