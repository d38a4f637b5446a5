#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "geometry/cases.h"
#include "sampling/fluid_particles.h"
#include "support/circle.h"

namespace tailwater {
namespace fluid_particles_test {

using namespace testing_cases;

constexpr double round_off = 1e-13;

FluidParticles<2> fluid_of(const CaseSpec& spec) { return make_fluid_particles<2>(spec, make_boundary<2>(spec)); }

double min_distance(const std::vector<Vec<2>>& points) {
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) least = std::min(least, (points[i] - points[j]).norm());
  }
  return least;
}

TEST(FluidLattice, IsCellCentred) {
  const FluidParticles<2> fluid = fluid_of(tank());
  ASSERT_EQ(fluid.position.size(), 10u * 4u);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 10; ++i) {
      const Vec<2> expected((i + 0.5) * 0.1, (j + 0.5) * 0.1);
      EXPECT_LT((fluid.position[j * 10 + i] - expected).norm(), round_off);
    }
  }
}

TEST(FluidLattice, HasTheVolumeOfABlockWhoseExtentIsNotWhole) {
  CaseSpec spec = empty_case(0.1);
  spec.fluid = {box_fluid({0.03, 0.0}, {0.36, 0.04})};  // 3.3 and 0.4 spacings: cells of 0.11 m by 0.04 m
  const FluidParticles<2> fluid = fluid_of(spec);
  ASSERT_EQ(fluid.position.size(), 3u);
  EXPECT_NEAR(fluid.position[2][0], 0.36 - 0.055, round_off);
  for (const double volume : fluid.volume) EXPECT_NEAR(volume, 0.11 * 0.04, round_off);
}

TEST(FluidLattice, IsNodeCentredBesideRowsOnTheWall) {
  CaseSpec spec = tank();
  spec.scheme.formulation = Formulation::published;
  const FluidParticles<2> fluid = fluid_of(spec);
  // Nodes 0..10 by 0..4 without those on the two side walls and on the bed.
  ASSERT_EQ(fluid.position.size(), 9u * 4u);
  EXPECT_LT((fluid.position[0] - Vec<2>(0.1, 0.1)).norm(), round_off);
  EXPECT_LT((fluid.position.back() - Vec<2>(0.9, 0.4)).norm(), round_off);
}

TEST(FluidLattice, CarriesBlockAndVelocity) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.fluid = {box_fluid({0, 0, 0}, {0.2, 0.1, 0.1}), box_fluid({1, 0, 0}, {1.1, 0.1, 0.3})};
  spec.fluid[1].velocity = {1.0, 2.0, 3.0};
  const FluidParticles<3> fluid = make_fluid_particles<3>(spec, make_boundary<3>(spec));
  EXPECT_EQ(fluid.block, (std::vector<int>{0, 0, 1, 1, 1}));
  EXPECT_EQ(fluid.velocity[1], Vec<3>(0, 0, 0));
  EXPECT_EQ(fluid.velocity[2], Vec<3>(1, 2, 3));
}

TEST(FluidLattice, TakesAVelocityThatVariesWhereTheParticlesAre) {
  CaseSpec spec = empty_case(0.1);
  spec.particles.jitter = 0.2;
  spec.parameters = {{"A", 3.0}};
  spec.fluid = {box_fluid({0, 0}, {0.3, 0.2})};
  spec.fluid[0].velocity = {"A*x + dx", 2.0};
  const FluidParticles<2> fluid = fluid_of(spec);
  ASSERT_EQ(fluid.position.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(fluid.velocity[i][0], 3.0 * fluid.position[i][0] + 0.1, round_off);
    EXPECT_EQ(fluid.velocity[i][1], 2.0);
  }
}

TEST(FluidLattice, RefusesAVelocityThatIsNotFinite) {
  CaseSpec spec = empty_case(0.1);
  spec.fluid = {box_fluid({0, 0}, {0.1, 0.1})};
  spec.fluid[0].velocity = {1.0, "1/(x - x)"};
  try {
    fluid_of(spec);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("velocity[1] = \"1/(x - x)\""), std::string::npos) << error.what();
    EXPECT_NE(
        std::string(error.what()).find("is inf at (0.05, 0.05); give an expression that is a number of at most 1e+15"),
        std::string::npos)
        << error.what();
  }
}

double total_volume(const FluidParticles<2>& fluid) {
  return std::accumulate(fluid.volume.begin(), fluid.volume.end(), 0.0);
}

TEST(FluidLattice, RefusesWaterThatIsTooFastToBeIncompressible) {
  CaseSpec spec = tank();
  spec.fluid[0].velocity = {0.0, 149.0};
  EXPECT_NO_THROW(make_fluid_particles(spec, make_boundary<2>(spec)));
  for (const Varying& fast : {Varying(1e14), Varying("200*x")}) {
    spec.fluid[0].velocity = {fast, 0.0};
    try {
      make_fluid_particles(spec, make_boundary<2>(spec));
      ADD_FAILURE() << "was taken";
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find("fluid 'fluid1': velocity is "), std::string::npos) << message;
      EXPECT_NE(message.find("limits it to 150 m/s"), std::string::npos) << message;
    }
  }
  const auto places = make_fluid_particles(spec, make_boundary<2>(spec), {}, 0, StartVelocities::left_out);
  EXPECT_EQ(places.velocity.at(0), Vec<2>(Vec<2>::Zero()));
}

TEST(FluidLattice, PolygonHasItsVolume) {
  const double dx = 0.05;
  CaseSpec spec = empty_case(dx);
  spec.fluid = {polygon_fluid({{0, 0}, {1, 0}, {0, 1}})};
  spec.walls = {polyline({{1, 0}, {0, 1}})};
  ASSERT_GT(make_boundary<2>(spec).nearest({0, 0}, 10.0).signed_distance, 0.0);
  const FluidParticles<2> triangle = fluid_of(spec);
  EXPECT_EQ(triangle.position.size(), 190u + 10u);  // the hypotenuse halves 20 cells
  EXPECT_NEAR(total_volume(triangle), 0.5, round_off);

  spec.walls.clear();
  spec.fluid = {polygon_fluid(circle(60))};
  const double area = 30.0 * std::sin(2 * std::numbers::pi / 60);
  const FluidParticles<2> disc = fluid_of(spec);
  // Up to eight cells are images of each other, and all of them are particles or none.
  EXPECT_NEAR(static_cast<double>(disc.position.size()), area / (dx * dx), 4.0);
  EXPECT_NEAR(total_volume(disc), area, 1e-12);
}

TEST(FluidLattice, BoxHasTheVolumeThatASlopeLeaves) {
  CaseSpec spec = empty_case(0.05);
  spec.fluid = {box_fluid({0, 0}, {1, 0.8})};
  spec.walls = {polyline({{0, 1}, {0, 0}, {1, 0.1}, {1, 1}})};
  const FluidParticles<2> fluid = fluid_of(spec);
  EXPECT_NEAR(total_volume(fluid), 0.8 - 0.5 * 0.1, 1e-12);
  EXPECT_EQ(fluid.position.size(), 300u);
}

// A slanted body, and one whose planes the lattice leaves out. Walls count as flat over dx/3: at each of the four
// corners an error below the area of a third of a cell.
TEST(FluidLattice, BoxHasTheVolumeThatBodiesLeave) {
  const double dx = 0.05;
  CaseSpec spec = empty_case(dx);
  spec.fluid = {box_fluid({0, 0}, {1, 0.8})};
  spec.walls = {box_wall({0, 0}, {1, 1}, {"+y"}),
                polygon({{0.3, 0.2}, {0.6, 0.3}, {0.5, 0.6}, {0.2, 0.5}}, FluidSide::outside)};
  EXPECT_NEAR(total_volume(fluid_of(spec)), 0.8 - 0.1, 4.0 * dx * dx / 9.0);
  spec.walls[1] = box_wall({0.33, 0.31}, {0.46, 0.44}, {}, FluidSide::outside);
  EXPECT_NEAR(total_volume(fluid_of(spec)), 0.8 - 0.13 * 0.13, 4.0 * dx * dx / 9.0);
}

// The gap between a body and a wall is less than half a spacing wide.
TEST(FluidLattice, NoParticleStandsWhereThereIsNoRoom) {
  const double dx = 0.05;
  CaseSpec spec = empty_case(dx);
  spec.fluid = {box_fluid({0, 0}, {1, 0.8})};
  spec.walls = {box_wall({0, 0}, {1, 1}, {"+y"}),
                polygon({{0.018, 0.2}, {0.5, 0.2}, {0.5, 0.6}, {0.024, 0.6}}, FluidSide::outside)};
  const Boundary<2> boundary = make_boundary<2>(spec);
  for (const Vec<2>& x : make_fluid_particles<2>(spec, boundary).position) {
    EXPECT_GE(boundary.nearest(x, 1.0).signed_distance, (0.25 - 1e-5) * dx) << x.transpose();
  }
}

// The cells that a round body cuts have up to seven others alike: all of them are water or none, whatever the volume.
TEST(FluidLattice, BoxAroundARoundBodyIsAsSymmetricAsTheBody) {
  const double dx = 0.05;
  CaseSpec spec = empty_case(dx);
  spec.fluid = {box_fluid({-1, -1}, {1, 1})};
  for (const double radius : {0.27, 0.3, 0.33}) {
    spec.walls = {box_wall({-1, -1}, {1, 1}, {"+y"}), polygon(circle(48, radius), FluidSide::outside)};
    const FluidParticles<2> fluid = fluid_of(spec);
    Vec<2> first_moment = Vec<2>::Zero();
    double diagonal = 0.0;
    double across = 0.0;
    for (std::size_t i = 0; i < fluid.position.size(); ++i) {
      const Vec<2>& x = fluid.position[i];
      first_moment += fluid.volume[i] * x;
      diagonal += fluid.volume[i] * (x[0] * x[0] - x[1] * x[1]);
      across += fluid.volume[i] * x[0] * x[1];
      EXPECT_NEAR(fluid.volume[i], dx * dx, 0.005 * dx * dx);
    }
    EXPECT_LT(first_moment.norm(), 1e-12) << radius;
    EXPECT_LT(std::abs(diagonal), 1e-12) << radius;
    EXPECT_LT(std::abs(across), 1e-12) << radius;
    const double turn = 2.0 * std::numbers::pi / 48;
    const double area = 24.0 * radius * radius * std::sin(turn);
    EXPECT_NEAR(total_volume(fluid), 4.0 - area, 48.0 * 0.5 * dx * dx / 9.0 * std::tan(turn)) << radius;
  }
}

TEST(FluidLattice, PolygonStandsOffASlantedWall) {
  const double dx = 0.05;
  CaseSpec spec = empty_case(dx);
  spec.walls = {polyline({{0, 1}, {0, 0}, {1, 0.37}, {1, 1}})};
  spec.fluid = {polygon_fluid({{0, 0}, {1, 0.37}, {1, 0.8}, {0, 0.8}})};
  const Boundary<2> boundary = make_boundary<2>(spec);
  for (const double jitter : {0.0, 0.2}) {
    spec.particles.jitter = jitter;
    const FluidParticles<2> fluid = make_fluid_particles<2>(spec, boundary);
    for (const Vec<2>& x : fluid.position) {
      EXPECT_GE(boundary.nearest(x, 1.0).signed_distance, (0.25 - 1e-9) * dx) << x.transpose();
    }
    if (jitter == 0.0) {
      EXPECT_GE(min_distance(fluid.position), 0.75 * dx - round_off) << "moved by at most dx/4";
      EXPECT_NEAR(total_volume(fluid), 0.8 - 0.5 * 0.37, 1e-12);
      EXPECT_EQ(fluid.position.size(), 246u) << "cells in this area";
    }
  }
}

TEST(FluidLattice, JitterIsBoundedReproducibleAndSeeded) {
  CaseSpec spec = tank();
  const FluidParticles<2> regular = fluid_of(spec);
  spec.particles.jitter = 0.2;
  const FluidParticles<2> first = fluid_of(spec);
  EXPECT_EQ(first.position, fluid_of(spec).position);
  spec.particles.seed = 2;
  const FluidParticles<2> second = fluid_of(spec);
  ASSERT_EQ(first.position.size(), regular.position.size());
  double largest = 0.0;
  Vec<2> sum = Vec<2>::Zero();
  for (std::size_t i = 0; i < first.position.size(); ++i) {
    const Vec<2> shift = (first.position[i] - regular.position[i]) / 0.02;
    largest = std::max(largest, shift.cwiseAbs().maxCoeff());
    sum += shift;
    EXPECT_NE(first.position[i], second.position[i]);
  }
  EXPECT_LE(largest, 1.0 + round_off);
  EXPECT_GT(largest, 0.9) << "80 uniform numbers all below 0.9: probability 2e-4";
  // The mean of 40 uniform numbers in [-1, 1) has standard deviation 0.091.
  EXPECT_LT((sum / 40.0).cwiseAbs().maxCoeff(), 4 * 0.0913);
}

TEST(FluidLattice, BadBlocksAreNamed) {
  CaseSpec spec = empty_case(0.1);
  spec.fluid = {box_fluid({1, 0}, {0, 1})};
  spec.fluid[0].name = "lake";
  try {
    fluid_of(spec);
    FAIL() << "a block without extent";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("fluid 'lake' has no extent in x"), std::string::npos) << error.what();
  }
  spec.fluid = {box_fluid({0, 0, 0}, {1, 1, 1})};
  EXPECT_THROW(fluid_of(spec), InputError);
  spec.fluid = {polygon_fluid({{0, 0}, {1, 0}})};
  EXPECT_THROW(fluid_of(spec), InputError);
}

}  // namespace fluid_particles_test
}  // namespace tailwater
