#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "base/error.h"
#include "geometry/cases.h"
#include "motion/wall_motion.h"
#include "support/rounding.h"

namespace tailwater {
namespace {

using namespace testing_cases;

/// A plate in a channel that rotates by a right angle in 1 s about its foot and moves to the right by t^2.
CaseSpec flap_case() {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{-2.0, -3.0}, {4.0, -3.0}}), box_wall({0.0, 0.2}, {0.3, 1.2}, {}, FluidSide::outside)};
  spec.walls[1].displacement = {"t^2", 0.0};
  spec.walls[1].rotation = "-pi/2*t";
  spec.walls[1].pivot = {0.0, 0.2};
  return spec;
}

TEST(WallMotion, TurnsAboutThePivotAndThenMoves) {
  const CaseSpec spec = flap_case();
  const WallPath<2> path(spec, spec.walls[1], CaseLabel("wall", "flap"));
  // (0, 1.2) is 1 m above the pivot. After the rotation to the right it is 1 m beside the pivot, and then 1 m further.
  EXPECT_LT((path.at(1.0)(Vec<2>(0.0, 1.2)) - Vec<2>(2.0, 0.2)).norm(), 4.0 * eps);
  EXPECT_LT((path.at(0.0)(Vec<2>(0.3, 0.7)) - Vec<2>(0.3, 0.7)).norm(), 4.0 * eps);
  const AffineMap<2> way = displacement_between(path.at(0.3), path.at(0.8));
  EXPECT_LT((way(path.at(0.3)(Vec<2>(0.3, 0.7))) - path.at(0.8)(Vec<2>(0.3, 0.7))).norm(), 8.0 * eps);
}

TEST(WallMotion, CarriesFacesAndParticles) {
  const CaseSpec spec = flap_case();
  Boundary<2> boundary = make_boundary<2>(spec);
  WallParticles<2> particles = make_dummy_particles<2>(boundary, 0.1, 3);
  const Boundary<2> drawn = boundary;
  const WallParticles<2> at_start = particles;
  const WallMotion<2> motion(spec, boundary, particles);
  ASSERT_EQ(motion.moving().size(), 1u);
  motion.place(1.0, {}, boundary, particles);
  const Mat<2> turn{{0.0, 1.0}, {-1.0, 0.0}};
  for (std::size_t f = 0; f < drawn.faces.size(); ++f) {
    const bool moves = drawn.faces[f].wall == 1;
    const Vec<2> expected = moves ? Vec<2>(turn * drawn.faces[f].normal) : drawn.faces[f].normal;
    EXPECT_LT((boundary.faces[f].normal - expected).norm(), 4.0 * eps);
    for (const Vec<2>& corner : boundary.faces[f].corners) {
      EXPECT_LT(std::abs(boundary.faces[f].height(corner)), 8.0 * eps);  // still on its plane
    }
  }
  std::vector<Vec<2>> velocity(particles.size(), Vec<2>(9.0, 9.0));
  motion.get_velocity(0.5, {}, velocity);
  for (std::size_t row = 0; row < particles.size(); ++row) {
    if (particles.wall[row] == 0) {
      EXPECT_EQ(particles.position[row], at_start.position[row]);
      EXPECT_EQ(velocity[row], Vec<2>(9.0, 9.0));
      continue;
    }
    // The depth behind the faces of the body and the blocked directions move with the body.
    EXPECT_NEAR(boundary.nearest(particles.position[row], 1.0).signed_distance,
                drawn.nearest(at_start.position[row], 1.0).signed_distance, 8.0 * eps);
    EXPECT_LT((particles.blocked[row] - turn * at_start.blocked[row] * turn.transpose()).norm(), 8.0 * eps);
    EXPECT_LT((particles.beyond_edges[row] - turn * at_start.beyond_edges[row]).norm(), 8.0 * eps);
    // d/dt: 2t to the right, and -pi/2 about the pivot, which is at (t^2, 0.2).
    const Vec<2> arm = motion.moving()[0].path.at(0.5)(at_start.position[row]) - Vec<2>(0.25, 0.2);
    const Vec<2> expected(1.0 + std::numbers::pi / 2.0 * arm[1], -std::numbers::pi / 2.0 * arm[0]);
    EXPECT_LT((velocity[row] - expected).norm(), 1e-8);
  }
  EXPECT_NEAR(motion.largest_displacement(0.0, 0.0, {}), 0.0, 0.0);
}

TEST(WallMotion, TakesAGivenPathThatBeginsWhereTheWallIs) {
  const CaseSpec spec = flap_case();
  Boundary<2> boundary = make_boundary<2>(spec);
  WallParticles<2> particles = make_dummy_particles<2>(boundary, 0.1, 3);
  const WallParticles<2> drawn = particles;
  WallMotion<2> motion(spec, boundary, particles);
  // At t = 0.5 the plate has moved by 0.25 and rotated by pi/4; then it moves to the right at 3 m/s.
  const auto path = [](double ahead) {
    return GivenMotion<2>{[=](double time) {
      return Placement<2>{{0.25 + ahead + 3.0 * (time - 0.5), 0.0}, -std::numbers::pi / 4.0};
    }};
  };
  try {
    motion.steer(0, path(0.01), 0.5, {}, 1e-3, "wall 'flap'");
    ADD_FAILURE() << "a jump of 10 mm is taken";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("wall 'flap': the path of a script begins 0.01 m from"), 0u)
        << error.what();
  }
  const AffineMap<2> before = motion.moving()[0].at(0.5, {});
  motion.steer(0, path(0.0), 0.5, {}, 1e-9, "wall 'flap'");
  motion.place(0.7, {}, boundary, particles);
  std::vector<Vec<2>> velocity(particles.size(), Vec<2>::Zero());
  motion.get_velocity(0.7, {}, velocity);
  for (std::size_t row = 0; row < particles.size(); ++row) {
    const bool moves = particles.wall[row] == 1;
    const Vec<2> expected = moves ? Vec<2>(before(drawn.position[row]) + Vec<2>(0.6, 0.0)) : drawn.position[row];
    EXPECT_LT((particles.position[row] - expected).norm(), 16.0 * eps);
    EXPECT_LT((velocity[row] - Vec<2>(moves ? 3.0 : 0.0, 0.0)).norm(), 1e-8);
  }
  EXPECT_NEAR(motion.largest_displacement(0.5, 0.7, {}), 0.6, 16.0 * eps);
}

// A gate that stands on the bed: the rows of the bed continue under the gate, and no particle of the gate is in the
// bed.
TEST(WallMotion, ABodyAndWhatItStandsOnAreSampledApart) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0.0, 1.0}, {0.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}}),
                box_wall({1.0, 0.0}, {1.3, 0.8}, {}, FluidSide::outside)};
  const std::size_t without = [&] {
    CaseSpec bed = spec;
    bed.walls.pop_back();
    return make_dummy_particles<2>(make_boundary<2>(bed), 0.1, 3).size();
  }();
  spec.walls[1].displacement = {0.0, "t"};
  const WallParticles<2> particles = make_dummy_particles<2>(make_boundary<2>(spec), 0.1, 3);
  EXPECT_EQ(particles.size(), without + 3u * 8u);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT((particles.position[i] - particles.position[j]).norm(), 0.1 - 1e-9);
    }
  }
}

TEST(WallMotion, WhatSlidesAlongAPeriodicDomainAlwaysCoversIt) {
  CaseSpec spec = empty_case(0.1);
  spec.domain.periodic_x = {0.0, 1.0};
  spec.walls = {polyline({{0.0, 0.0}, {1.0, 0.0}})};
  spec.walls[0].displacement = {"-0.7*t", 0.0};
  Boundary<2> boundary = make_boundary<2>(spec);
  WallParticles<2> particles = make_dummy_particles<2>(boundary, 0.1, 3);
  const WallMotion<2> motion(spec, boundary, particles);
  for (const double time : {0.0, 0.4, 1.0, 30.0}) {
    motion.place(time, {}, boundary, particles);
    for (double x = 0.05; x < 1.0; x += 0.1) {
      EXPECT_NEAR(boundary.nearest(Vec<2>(x, 0.02), 1.0).signed_distance, 0.02, 4.0 * eps) << x << ", t = " << time;
    }
  }
}

/// Samples of `value` every h from 0 to 1.
template <class Function>
Spline sampled(double h, Function&& value) {
  std::vector<double> times, values;
  for (int k = 0; k <= std::lround(1.0 / h); ++k) {
    times.push_back(k * h);
    values.push_back(value(k * h));
  }
  return {times, values};
}

TEST(Spline, KeepsStraightLinesAlsoBeyondItsEnds) {
  const Spline line({0.0, 0.1, 0.5, 2.0}, {1.0, 1.2, 2.0, 5.0});
  for (const double t : {-1.0, 0.0, 0.03, 0.3, 1.7, 2.0, 4.0}) EXPECT_NEAR(line.at(t), 1.0 + 2.0 * t, 16.0 * eps) << t;
}

// The second derivative of the sine is 0 at both ends, as that of the spline. The error of the spline is therefore at
// most 5/384 h^4 times the largest fourth derivative (C.A. Hall, W.W. Meyer 1976), also at the ends.
TEST(Spline, IsOfFourthOrderOnASmoothFunction) {
  const double w = 2.0 * std::numbers::pi;
  for (const double h : {0.1, 0.05}) {
    const Spline spline = sampled(h, [&](double t) { return std::sin(w * t); });
    double largest = 0.0;
    for (double t = 0.0; t < 1.0; t += 0.003) largest = std::max(largest, std::abs(spline.at(t) - std::sin(w * t)));
    EXPECT_LT(largest, 5.0 / 384.0 * std::pow(h * w, 4));
    EXPECT_GT(largest, 0.1 * std::pow(h * w, 4) * 5.0 / 384.0);
  }
}

// Velocity and acceleration are continuous where pieces meet: one-sided differences from the left and from the right
// differ by O(e).
TEST(Spline, HasNoJumpsOfVelocityOrAcceleration) {
  const Spline spline({0.0, 0.3, 0.4, 1.0}, {0.0, 0.5, -0.2, 0.1});
  const double e = 1e-4;
  for (const double t : {0.3, 0.4}) {
    const double before = spline.at(t) - spline.at(t - e);
    const double after = spline.at(t + e) - spline.at(t);
    EXPECT_NEAR(after, before, 1e3 * e * e);  // the second derivative is below 1000 here
    const double bend_before = spline.at(t) - 2.0 * spline.at(t - e) + spline.at(t - 2.0 * e);
    const double bend_after = spline.at(t + 2.0 * e) - 2.0 * spline.at(t + e) + spline.at(t);
    EXPECT_NEAR(bend_after / (e * e), bend_before / (e * e), 1e-2 * std::abs(bend_before) / (e * e) + 1e5 * e);
  }
}

TEST(WallMotion, OfAFilePassesThroughItsLines) {
  CaseSpec spec = flap_case();
  WallTable& wall = spec.walls[1];
  wall.displacement.clear();
  wall.rotation = 0.0;
  wall.series = {"roll.csv", {2, 3, 4}, {0.0, 0.5, 1.0}, {{0.0, 0.1, 0.4}, {}, {}, {0.0, 0.3, -0.2}}};
  const WallPath<2> path(spec, wall, CaseLabel("wall", "flap"));
  for (std::size_t k = 0; k < 3; ++k) {
    const double angle = wall.series.columns[3][k];
    const Vec<2> expected(wall.series.columns[0][k] - std::sin(angle), 0.2 + std::cos(angle));
    EXPECT_LT((path.at(wall.series.time[k])(Vec<2>(0.0, 1.2)) - expected).norm(), 8.0 * eps);
  }
  EXPECT_TRUE(make_boundary<2>(spec).walls[1].moves());
}

TEST(WallMotion, InSpaceTurnsAboutAnAxis) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {1, 1, 1}, {"+z"})};
  spec.walls[0].rotation = "pi/2*t";
  spec.walls[0].pivot = {1, 0, 0};
  spec.walls[0].axis = {0, 2, 0};
  const WallPath<3> path(spec, spec.walls[0], CaseLabel("wall", "tank"));
  // About +y, counter-clockwise as seen against it: z turns to x. (1, 0.5, 1) moves to a position beside the pivot.
  EXPECT_LT((path.at(1.0)(Vec<3>(1, 0.5, 1)) - Vec<3>(2, 0.5, 0)).norm(), 8.0 * eps);
  EXPECT_LT((path.at(1.0)(Vec<3>(0, 0.25, 0)) - Vec<3>(1, 0.25, 1)).norm(), 8.0 * eps);
}

GateTable gate_of(GateMotion motion) {
  GateTable gate;
  gate.from = {1.0, 0.0};
  gate.to = {1.0, 0.5};
  gate.motion = motion;
  gate.start = 0.2;
  return gate;
}

TEST(GateLaw, BeginsStopsAndMovesAsItsTableSays) {
  GateTable steady = gate_of(GateMotion::speed);
  steady.speed = 2.0;
  EXPECT_EQ(GateLaw(steady, 0.5).displacement(0.2), 0.0);
  EXPECT_NEAR(GateLaw(steady, 0.5).displacement(0.3), 0.2, 4.0 * eps);
  EXPECT_EQ(GateLaw(steady, 0.5).displacement(9.0), 0.5);
  steady.travel = 3.0;
  EXPECT_EQ(GateLaw(steady, 0.5).displacement(9.0), 3.0);

  GateTable pulled = gate_of(GateMotion::acceleration);
  pulled.acceleration = 5.0;
  pulled.travel = 10.0;
  EXPECT_NEAR(GateLaw(pulled, 0.5).displacement(1.2), 0.5 * 5.0, 16.0 * eps);

  GateTable filmed = gate_of(GateMotion::file);
  filmed.series = {"gate.csv", {2, 3}, {0.0, 1.0}, {{0.0, 0.4}}};
  EXPECT_EQ(GateLaw(filmed, 0.5).displacement(0.1), 0.0);
  EXPECT_NEAR(GateLaw(filmed, 0.5).displacement(0.7), 0.2, 4.0 * eps);
}

}  // namespace
}  // namespace tailwater
