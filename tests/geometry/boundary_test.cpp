#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/error.h"
#include "geometry/boundary.h"
#include "geometry/cases.h"

namespace tailwater {
namespace boundary_test {

using namespace testing_cases;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double round_off = 1e-14;

std::string input_error_of(const CaseSpec& spec) {
  try {
    spec.general.dimension == 2 ? void(make_boundary<2>(spec)) : void(make_boundary<3>(spec));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Boundary, NormalsPointIntoTheFluid) {
  CaseSpec spec = empty_case(0.1);
  const std::vector<Coordinates> clockwise{{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  spec.walls = {polyline({{0, 0}, {1, 0}}, FluidSide::left),     polyline({{0, 0}, {1, 0}}, FluidSide::right),
                polygon(clockwise, FluidSide::inside),           polygon(clockwise, FluidSide::outside),
                box_wall({0, 0}, {1, 1}, {}, FluidSide::inside), box_wall({0, 0}, {1, 1}, {}, FluidSide::outside)};
  const Boundary<2> boundary = make_boundary<2>(spec);
  ASSERT_EQ(boundary.faces.size(), 2u + 4 * 4);
  const Vec<2> centre(0.5, 0.5);
  for (const WallFace<2>& face : boundary.faces) {
    const Vec<2> along = face.corners[1] - face.corners[0];
    EXPECT_NEAR(along[0] * face.normal[1] - along[1] * face.normal[0], along.norm(), round_off) << "fluid on the left";
    const bool fluid_at_centre = face.wall == 0 || face.wall == 2 || face.wall == 4;
    EXPECT_EQ(face.height(centre) > 0.0, fluid_at_centre) << "wall " << face.wall;
  }
}

TEST(Boundary, BoxIn3DHasTwoTrianglesPerClosedFace) {
  for (const FluidSide side : {FluidSide::inside, FluidSide::outside}) {
    CaseSpec spec = empty_case(0.1, 3);
    spec.walls = {box_wall({0, 0, 0}, {1, 2, 3}, {"+z"}, side)};
    const Boundary<3> boundary = make_boundary<3>(spec);
    ASSERT_EQ(boundary.faces.size(), 10u);
    double area = 0.0;
    for (const WallFace<3>& face : boundary.faces) {
      const Vec<3> winding = (face.corners[1] - face.corners[0]).cross(face.corners[2] - face.corners[0]);
      EXPECT_GT(winding.dot(face.normal), 0.0) << "counter-clockwise as the fluid sees it";
      EXPECT_EQ(face.height(Vec<3>(0.5, 0.5, 0.5)) > 0.0, side == FluidSide::inside);
      area += face.measure();
    }
    EXPECT_NEAR(area, 2.0 * (1 * 3 + 2 * 3) + 1 * 2, 20 * round_off);
  }
}

TEST(Boundary, FrictionFollowsSlip) {
  CaseSpec spec = empty_case(0.1);
  for (const Slip slip : {Slip::free, Slip::no_slip, Slip::partial, Slip::coulomb}) {
    spec.walls.push_back(polyline({{0, 0}, {1, 0}}));
    spec.walls.back().slip = slip;
    spec.walls.back().friction = 0.25;
  }
  const Boundary<2> boundary = make_boundary<2>(spec);
  EXPECT_EQ(boundary.walls[0].friction, 0.0);
  EXPECT_EQ(boundary.walls[1].friction, 1.0);
  EXPECT_EQ(boundary.walls[2].friction, 0.25);
  EXPECT_EQ(boundary.walls[2].coulomb_friction, 0.0);
  EXPECT_EQ(boundary.walls[3].friction, 1.0);
  EXPECT_EQ(boundary.walls[3].coulomb_friction, 0.25);
  EXPECT_EQ(boundary.walls[1].name, "wall2");
}

TEST(Boundary, RoughnessOfManningIsThatOfStrickler) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0, 0}, {1, 0}}), polyline({{0, 0}, {1, 0}})};
  spec.walls[0].manning = 0.012;
  spec.walls[1].roughness = 0.003;
  const Boundary<2> boundary = make_boundary<2>(spec);
  // Then U/u_tau = 8.1 (h/k_s)^(1/6) is Manning's U = h^(2/3) S^(1/2)/n, with u_tau = sqrt(g h S), for any h and S.
  const double k_s = boundary.walls[0].roughness;
  EXPECT_NEAR(std::pow(k_s, 1.0 / 6.0) / (8.1 * std::sqrt(9.81)), 0.012, 1e-15);
  EXPECT_EQ(boundary.walls[1].roughness, 0.003);
}

// Fluid in the quadrant x, y > 0: a concave corner.
TEST(Boundary, SignedDistanceAtAConcaveCorner) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0, 1}, {0, 0}, {1, 0}})};
  const Boundary<2> boundary = make_boundary<2>(spec);
  EXPECT_NEAR(boundary.nearest({0.3, 0.2}, infinite).signed_distance, 0.2, round_off);
  EXPECT_NEAR(boundary.nearest({-0.3, 0.5}, infinite).signed_distance, -0.3, round_off);
  EXPECT_NEAR(boundary.nearest({-0.3, -0.4}, infinite).signed_distance, -0.5, round_off);
  EXPECT_EQ(boundary.nearest({0.3, 0.2}, 0.1).face, -1);
}

// A solid wedge of 2 x 0.1 rad with its tip at the origin: near the tip the planes of the two faces give different
// distances.
TEST(Boundary, SignedDistanceAtASharpConvexCorner) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{-std::cos(0.1), std::sin(0.1)}, {0, 0}, {-std::cos(0.1), -std::sin(0.1)}})};
  const Boundary<2> boundary = make_boundary<2>(spec);
  for (const Vec<2>& x : {Vec<2>(0.2, 0.0), Vec<2>(0.05, 0.3), Vec<2>(0.05, -0.3), Vec<2>(0.2, 0.2)}) {
    EXPECT_NEAR(boundary.nearest(x, infinite).signed_distance, x.norm(), round_off);
  }
  EXPECT_NEAR(boundary.nearest({-0.5, 0.0}, infinite).signed_distance, -0.5 * std::sin(0.1), round_off);
}

TEST(Boundary, SignedDistanceToABoxIn3D) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {1, 1, 1}, {"+z"})};
  const Boundary<3> boundary = make_boundary<3>(spec);
  const auto distance = [&](double x, double y, double z) {
    return boundary.nearest({x, y, z}, infinite).signed_distance;
  };
  EXPECT_NEAR(distance(0.5, 0.4, 0.1), 0.1, round_off);
  EXPECT_NEAR(distance(0.9, 0.5, 0.5), 0.1, round_off);
  EXPECT_NEAR(distance(0.5, 0.5, -0.2), -0.2, round_off);
  EXPECT_NEAR(distance(-0.3, 0.5, -0.4), -0.5, round_off);                // an edge
  EXPECT_NEAR(distance(-0.2, -0.3, -0.6), -0.7, round_off);               // a corner
  EXPECT_NEAR(distance(0.5, 0.5, 1.5), std::hypot(0.5, 0.5), round_off);  // above the open top
}

TEST(Boundary, ClosestPointOfATriangleIsNearestOfAll) {
  const WallFace<3> face{{Vec<3>(0, 0, 0), Vec<3>(2, 0, 0), Vec<3>(0.5, 1, 0)}, Vec<3>(0, 0, 1)};
  constexpr int n = 40;
  for (double x = -1.0; x <= 3.0; x += 0.37) {
    for (double y = -1.0; y <= 2.0; y += 0.29) {
      const Vec<3> p(x, y, 0.3);
      const double distance = (p - closest_point(face, p)).norm();
      double brute = infinite;
      for (int i = 0; i <= n; ++i) {
        for (int j = 0; i + j <= n; ++j) {
          const Vec<3> q = face.corners[0] + i * (face.corners[1] - face.corners[0]) / n +
                           j * (face.corners[2] - face.corners[0]) / n;
          brute = std::min(brute, (p - q).norm());
        }
      }
      EXPECT_LE(distance, brute + round_off);
      EXPECT_GE(distance, brute - 2.0 / n) << "no sample of the triangle is farther than an edge's step from any point";
    }
  }
}

TEST(Boundary, BadWallsAreNamedWithThePoint) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0, 0}, {1, 0}, {1, 0}, {2, 0}})};
  spec.walls[0].name = "bed";
  std::string message = input_error_of(spec);
  EXPECT_TRUE(contains(message, "wall 'bed'") && contains(message, "points[2]") && contains(message, "(1, 0)"))
      << message;

  spec.walls = {polyline({{0, 0}})};
  EXPECT_TRUE(contains(input_error_of(spec), "wall 'wall1' has 1 points"));
  spec.walls = {polyline({{0, 0}, {1, 0, 0}})};
  EXPECT_TRUE(contains(input_error_of(spec), "points[1] has 3 numbers"));
  spec.walls = {polygon({{0, 0}, {1, 0}, {2, 0}}, FluidSide::inside)};
  EXPECT_TRUE(contains(input_error_of(spec), "encloses no area"));
  spec.walls = {polyline({{0, 0}, {1, 0}}, FluidSide::inside)};
  EXPECT_TRUE(contains(input_error_of(spec), "a polyline has no inside"));
  spec.walls = {box_wall({0, 1}, {1, 1})};
  EXPECT_TRUE(contains(input_error_of(spec), "no extent in y"));
  spec.walls = {box_wall({0, 0}, {1, 1}, {"top"})};
  EXPECT_TRUE(contains(input_error_of(spec), "\"top\" is not a face"));
  spec.walls = {box_wall({0, 0}, {1, 1}, {"-x", "+x", "-y", "+y"})};
  EXPECT_TRUE(contains(input_error_of(spec), "no face left"));
  // The check precedes the generation of particles, which would take hours.
  spec.walls = {polyline({{0, 0}, {0, 1.5e9}})};
  spec.walls[0].shape = WallShape::plate;
  EXPECT_TRUE(contains(input_error_of(spec), "reaches over 1.5e+09 m, which is 1.5e+10 times particles.spacing"));
  // So does the check before a shorter one takes gigabytes of cells.
  spec.walls[0].points[1][1] = 1e7;
  EXPECT_TRUE(contains(input_error_of(spec), "reaches over 1e+07 m, which is 1e+08 times particles.spacing"));
  spec = empty_case(0.1, 3);
  spec.walls = {polyline({{0, 0, 0}, {1, 0, 0}})};
  EXPECT_TRUE(contains(input_error_of(spec), "2D only"));
}

/// A search among filed faces has the same results as a search among all faces.
template <int Dim>
void expect_the_same_nearest(const CaseSpec& spec, const Vec<Dim>& low, const Vec<Dim>& high) {
  Boundary<Dim> filed = make_boundary<Dim>(spec);
  filed.file_faces(3.0 * spec.particles.spacing);
  const Boundary<Dim> plain = make_boundary<Dim>(spec);
  const double reach = filed.filed_reach();
  int found = 0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int n = 0; n < 5000; ++n) {
    Vec<Dim> x;
    for (int d = 0; d < Dim; ++d) x[d] = low[d] + share(random) * (high[d] - low[d]);
    for (const double distance : {0.2 * reach, reach}) {
      const NearestWall<Dim> expected = plain.nearest(x, distance);
      const NearestWall<Dim> nearest = filed.nearest(x, distance);
      ASSERT_EQ(nearest.face, expected.face) << x.transpose();
      ASSERT_EQ(nearest.signed_distance, expected.signed_distance);
      ASSERT_EQ(nearest.point, expected.point);
      found += nearest.face >= 0;
    }
  }
  EXPECT_GT(found, 500);
}

/// Whether a plate hides one position from another.
template <int Dim>
bool hides(const CaseSpec& spec, const Vec<Dim>& from, const Vec<Dim>& to) {
  const Boundary<Dim> boundary = make_boundary<Dim>(spec);
  return std::ranges::any_of(boundary.screens,
                             [&](const auto& screen) { return screen.hidden_fraction(from, to) > 0.5; });
}

// A basin with a plate below the mouth of a channel. The plate reaches from the bed of the channel down to the bed of
// the basin.
TEST(Screens, GoOnBehindAWallAndNotInFrontOfIt) {
  CaseSpec spec = empty_case(0.1);
  WallTable plate = polyline({{0.0, 0.0}, {0.0, 0.4}});
  plate.shape = WallShape::plate;
  spec.walls = {polyline({{-1.0, 0.4}, {0.0, 0.4}}), polyline({{-1.0, 0.0}, {1.0, 0.0}}), plate};
  EXPECT_TRUE(hides<2>(spec, {-0.05, -0.15}, {0.05, -0.15}));
  EXPECT_TRUE(hides<2>(spec, {-0.05, 0.2}, {0.05, 0.2}));
  EXPECT_FALSE(hides<2>(spec, {-0.05, 0.5}, {0.05, 0.5}));
}

TEST(Screens, GoOnBehindAWallAndNotInFrontOfItIn3D) {
  CaseSpec spec = empty_case(0.1, 3);
  WallTable plate;
  plate.shape = WallShape::plate;
  plate.points = {{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 1.0, 0.4}, {0.0, 0.0, 0.4}};
  spec.walls = {box_wall({-1, 0, 0.4}, {0, 1, 1}, {"+x", "+z"}), box_wall({0, 0, 0}, {1, 1, 1}, {"-x", "+z"}), plate};
  EXPECT_TRUE(hides<3>(spec, {-0.05, 0.5, -0.15}, {0.05, 0.5, -0.15}));
  EXPECT_TRUE(hides<3>(spec, {-0.05, -0.15, 0.2}, {0.05, -0.15, 0.2}));
  EXPECT_FALSE(hides<3>(spec, {-0.05, 0.5, 0.5}, {0.05, 0.5, 0.5}));
}

// Straight on, a plate that leans over the edge of a step leads through the water beyond the step, and water passed
// below its foot.
TEST(Screens, GoIntoTheCornerOfAStepOverWhichAPlateLeans) {
  CaseSpec spec = empty_case(0.1);
  WallTable plate = polyline({{0.0, 0.0}, {-0.3, 0.3}});
  plate.shape = WallShape::plate;
  spec.walls = {polyline({{-1.0, 0.0}, {0.0, 0.0}, {0.0, -1.0}}), plate};
  EXPECT_TRUE(hides<2>(spec, {-0.05, 0.01}, {0.02, -0.03}));
  EXPECT_FALSE(hides<2>(spec, {0.05, -0.02}, {0.02, -0.05}));
  spec = empty_case(0.1, 3);
  plate.points = {{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {-0.3, 1.0, 0.3}, {-0.3, 0.0, 0.3}};
  spec.walls = {box_wall({-1.0, 0.0, -1.0}, {0.0, 1.0, 0.0}, {}, FluidSide::outside), plate};
  EXPECT_TRUE(hides<3>(spec, {-0.05, 0.5, 0.01}, {0.02, 0.5, -0.03}));
  EXPECT_FALSE(hides<3>(spec, {0.05, 0.5, -0.02}, {0.02, 0.5, -0.05}));
  // Over the water beyond the step it goes on straight, behind the bed.
  plate.points = {{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.3, 1.0, 0.3}, {0.3, 0.0, 0.3}};
  spec.walls[1] = plate;
  EXPECT_TRUE(hides<3>(spec, {-0.05, 0.5, 0.01}, {0.02, 0.5, -0.03}));
}

// A plate that ends at a periodic boundary is followed by its image, whose end fades as its own.
TEST(Screens, GoOnInTheNextPeriod) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.domain.periodic_y = {0.0, 1.2};
  WallTable plate;
  plate.shape = WallShape::plate;
  plate.points = {{0.0, 0.0, 0.0}, {0.0, 1.2, 0.0}, {0.0, 1.2, 0.4}, {0.0, 0.0, 0.4}};
  spec.walls = {plate};
  for (const double beside : {-0.05, 0.0, 0.05, 1.15, 1.2, 1.25}) {
    EXPECT_TRUE(hides<3>(spec, {-0.05, beside, 0.2}, {0.05, beside, 0.2})) << beside;
    EXPECT_TRUE(hides<3>(spec, {-0.05, 0.05, 0.2}, {0.15, -0.1, 0.2})) << beside;
    EXPECT_FALSE(hides<3>(spec, {-0.05, beside, 0.5}, {0.05, beside, 0.5})) << beside;
  }
  spec.domain.periodic_y.clear();
  EXPECT_FALSE(hides<3>(spec, {-0.05, -0.15, 0.2}, {0.05, -0.15, 0.2}));
  spec = empty_case(0.1);
  spec.domain.periodic_x = {0.0, 1.2};
  plate.points = {{0.0, 0.2}, {1.2, 0.2}};
  spec.walls = {plate};
  for (const double x : {-0.05, 0.0, 1.25}) EXPECT_TRUE(hides<2>(spec, {x, 0.15}, {x, 0.25})) << x;
}

// The screening by a plate decays over one spacing on either side of its edge, symmetrically about it, but not where
// the plate stands on a wall. It depends only on the distance from the edge, even if the last piece of the plate is
// shorter than a spacing.
TEST(Screens, FadeAtAnEdge) {
  for (const bool has_short_piece : {false, true}) {
    CaseSpec spec = empty_case(0.1);
    WallTable plate = polyline({{0.0, 0.0}, {0.0, 0.4}});
    if (has_short_piece) plate.points = {{0.0, 0.0}, {0.0, 0.37}, {0.0, 0.4}};
    plate.shape = WallShape::plate;
    spec.walls = {polyline({{-1.0, 0.0}, {1.0, 0.0}}), plate};
    const Boundary<2> boundary = make_boundary<2>(spec);
    const auto visible = [&](double z, int felt) {
      const Vec<2> from(-0.05, z);
      const Vec<2> to(0.1, z);
      return visible_fraction<2>(boundary.screens, boundary.screens_near(to, 0.15), from, to, felt);
    };
    for (double s = 0.01; s < 0.1; s += 0.01) {
      const double q = 0.5 * (1.0 + s / 0.1);
      EXPECT_NEAR(visible(0.4 - s, felt_past_screens), 1.0 - q * q * (3.0 - 2.0 * q), 1e-12);
      EXPECT_NEAR(visible(0.4 - s, felt_past_screens), 1.0 - visible(0.4 + s, felt_past_screens), 1e-12);
      EXPECT_NEAR(visible(0.4 - s, 1), 1.0 - visible(0.4 - s, felt_past_screens), 1e-12);
    }
    for (const double z : {-0.15, 0.02, 0.29}) EXPECT_EQ(visible(z, felt_past_screens), 0.0);
    for (const double z : {0.51, 0.6}) EXPECT_EQ(visible(z, felt_past_screens), 1.0);
  }
}

// Water that two plates hide is replaced once: by the particles of the plate that the line from the water passes first.
TEST(Screens, LeaveTheParticlesOfTheFirstPlateInSight) {
  CaseSpec spec = empty_case(0.1);
  WallTable upright = polyline({{0.0, -1.0}, {0.0, 0.0}});
  WallTable level = polyline({{0.0, 0.0}, {1.0, 0.0}});
  upright.shape = level.shape = WallShape::plate;
  spec.walls = {upright, level};
  const Boundary<2> boundary = make_boundary<2>(spec);
  const auto visible = [&](const Vec<2>& from, const Vec<2>& to, int felt, bool is_wall_first) {
    return visible_fraction<2>(boundary.screens, boundary.screens_near(to, 0.3), from, to, felt, is_wall_first);
  };
  const Vec<2> left(-0.03, -0.18);  // beside the upright plate
  const Vec<2> above(0.18, 0.03);   // above the level one
  EXPECT_EQ(visible(left, above, felt_past_screens, false), 0.0);
  for (const bool is_left_water : {false, true}) {
    EXPECT_EQ(visible(left, above, 0, !is_left_water), is_left_water ? 1.0 : 0.0);
    EXPECT_EQ(visible(left, above, 1, !is_left_water), is_left_water ? 0.0 : 1.0);
    EXPECT_EQ(visible(above, left, 0, is_left_water), is_left_water ? 1.0 : 0.0);
  }
  // A line through the corner has the particles of one plate as well.
  const Vec<2> inside(0.05, -0.05);
  EXPECT_EQ(visible(inside, -inside, felt_past_screens, false), 0.0);
  EXPECT_NEAR(visible(inside, -inside, 0, false) + visible(inside, -inside, 1, false), 1.0, 1e-12);
  // Lines around the corner fade as at a rim, and the particles of both plates replace the hidden water.
  for (double s = -0.09; s < 0.1; s += 0.02) {
    const Vec<2> from(-0.1, -0.1 - s);
    const Vec<2> to(0.1 + s, 0.1);
    const double q = 0.5 * (1.0 + s / 0.1);
    const double hidden = q * q * (3.0 - 2.0 * q);
    EXPECT_NEAR(visible(from, to, felt_past_screens, false), (1.0 - hidden) * (1.0 - hidden), 1e-12) << s;
    EXPECT_NEAR(visible(from, to, 0, false) + visible(from, to, 1, false), hidden * (2.0 - hidden), 1e-12) << s;
    EXPECT_EQ(visible(inside, from, felt_past_screens, false), 0.0) << s;
    EXPECT_EQ(visible(inside, to, felt_past_screens, false), 0.0) << s;
  }
  // In the smaller angle one plate takes over from the other as the line moves past the corner.
  for (double s = -0.09; s < 0.1; s += 0.02) {
    const Vec<2> from = inside + s * Vec<2>(0.5, 0.5);
    const Vec<2> to = -inside + s * Vec<2>(0.5, 0.5);
    const double q = 0.5 * (1.0 + s * std::sqrt(0.5) / 0.1);
    EXPECT_NEAR(visible(from, to, 1, false), q * q * (3.0 - 2.0 * q), 1e-12) << s;
    EXPECT_NEAR(visible(from, to, 0, false), 1.0 - q * q * (3.0 - 2.0 * q), 1e-12) << s;
  }
}

// An end that is nearer to another plate than half a spacing leaves no opening beside it, nor does it go through.
TEST(Screens, EndAtAPlate) {
  CaseSpec spec = empty_case(0.1);
  WallTable level = polyline({{-1.0, 0.0}, {1.0, 0.0}});
  level.shape = WallShape::plate;
  for (const double end : {-0.04, 0.0, 0.04}) {
    WallTable upright = polyline({{0.0, -1.0}, {0.0, end}});
    upright.shape = WallShape::plate;
    spec.walls = {upright, level};
    const Boundary<2> boundary = make_boundary<2>(spec);
    for (const Screen<2>& screen : boundary.screens) {
      if (screen.wall != 0 || screen.is_beyond) continue;
      EXPECT_NEAR(screen.box().max()[1], 0.0, 1e-6) << end;
    }
  }
}

TEST(FreeEnds, HaveNothingBehindThem) {
  CaseSpec spec = empty_case(0.1);
  const WallTable floor = polyline({{-1.0, 0.0}, {0.0, 0.0}});
  spec.walls = {floor};
  const Boundary<2> alone = make_boundary<2>(spec);
  EXPECT_NEAR(alone.nearest({0.03, -0.04}, 1.0).signed_distance, 0.05, 1e-12);
  EXPECT_NEAR(alone.nearest({-0.3, -0.04}, 1.0).signed_distance, -0.04, 1e-12);
  // Water near the end has come around it; water farther away must have passed through the wall.
  EXPECT_NEAR(alone.nearest_to_water({-0.3, -0.04}, 1.0).signed_distance, 0.04, 1e-12);
  EXPECT_NEAR(alone.nearest_to_water({-0.5, -0.04}, 1.0).signed_distance, -0.04, 1e-12);
  // A plate that ends there has no sides, and the wall no place behind it beyond the end.
  WallTable plate = polyline({{0.0, 0.0}, {0.0, 1.0}});
  plate.shape = WallShape::plate;
  spec.walls = {floor, plate};
  EXPECT_NEAR(make_boundary<2>(spec).nearest({0.03, -0.04}, 1.0).signed_distance, 0.05, 1e-12);
  EXPECT_NEAR(make_boundary<2>(spec).nearest({-0.3, -0.04}, 1.0).signed_distance, -0.04, 1e-12);
  // A wall within half a spacing leaves no opening until it moves away.
  spec.walls = {floor, polyline({{0.04, -1.0}, {0.04, 1.0}})};
  spec.walls[1].displacement = {"t", 0.0};
  Boundary<2> closed = make_boundary<2>(spec);
  EXPECT_NEAR(closed.nearest({0.003, -0.004}, 1.0).signed_distance, -0.005, 1e-12);
  EXPECT_TRUE(std::ranges::none_of(closed.ends,
                                   [](const WallEnd& end) { return end.face == 0 && end.corner == 1 && end.is_free; }));
  for (Vec<2>& corner : closed.faces[1].corners) corner[0] += 0.1;
  closed.hang_screens();
  EXPECT_NEAR(closed.nearest({0.003, -0.004}, 1.0).signed_distance, 0.005, 1e-12);
  // Beyond an opening the floor continues.
  spec.walls = {floor};
  spec.outlets = {outlet({0.0, 0.0}, {0.0, 1.0})};
  EXPECT_EQ(make_boundary<2>(spec).ends.size(), 1u);
}

TEST(FiledFaces, GiveTheNearestOfAll) {
  CaseSpec spec = empty_case(0.05);
  WallTable bed = polyline({});
  for (int k = 0; k <= 400; ++k) bed.points.push_back({0.01 * k, 0.2 * std::sin(0.1 * k) + 0.01 * (k % 3)});
  WallTable flap = box_wall({1.0, 0.3}, {1.15, 0.8}, {}, FluidSide::outside);
  flap.rotation = "t";
  spec.walls = {bed, polyline({{4.5, 0.0}, {6.0, 1.5}}), flap};
  expect_the_same_nearest<2>(spec, {-0.3, -0.5}, {6.5, 2.0});
}

TEST(FiledFaces, GiveTheNearestOfAllIn3D) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {1.3, 0.5, 0.6}, {"+z"}),
                box_wall({0.5, 0.2, 0}, {0.8, 0.5, 0.3}, {}, FluidSide::outside)};
  expect_the_same_nearest<3>(spec, {-0.4, -0.4, -0.4}, {1.7, 0.9, 1.0});
}

}  // namespace boundary_test
}  // namespace tailwater
