#include <gtest/gtest.h>

#include "geometry/cases.h"
#include "geometry/outer_patches.h"

namespace tailwater {
namespace {

using testing_cases::box_wall;
using testing_cases::empty_case;
using testing_cases::polyline;

constexpr double dx = 0.025;

/// m or m^2; area of the outer patches of a wall, or of all walls.
template <int Dim>
double area_of(const CaseSpec& spec, int wall = -1) {
  const Boundary<Dim> boundary = make_boundary<Dim>(spec);
  double area = 0.0;
  for (const WallPatch<Dim>& patch : outer_patches(spec, boundary, make_wall_patches(boundary, 1.5 * dx))) {
    if (wall < 0 || boundary.faces[patch.face].wall == wall) area += patch.measure;
  }
  return area;
}

TEST(OuterPatches, AreTheSurfaceOfABodyOfSeveralHulls) {
  const double whole = 2.0 * (0.4 + 0.1) + 2.0 * 0.15;  // a T
  for (const double overlap : {0.0, 0.001, 0.01, 0.05, 0.1}) {
    CaseSpec spec = empty_case(dx);
    spec.walls = {box_wall({0.8, 0.25}, {1.2, 0.35}, {}, FluidSide::outside),
                  box_wall({0.95, 0.1}, {1.05, 0.25 + overlap}, {}, FluidSide::outside)};
    for (WallTable& wall : spec.walls) wall.drive = {Drive::By::body, 0};
    EXPECT_NEAR(area_of<2>(spec), whole, 0.1 * dx) << overlap;
  }
  CaseSpec spec = empty_case(dx, 3);
  spec.walls = {box_wall({0.0, 0.0, 0.0}, {0.3, 0.1, 0.1}, {}, FluidSide::outside),
                box_wall({0.2, 0.0, 0.0}, {0.5, 0.1, 0.1}, {}, FluidSide::outside)};
  for (WallTable& wall : spec.walls) wall.drive = {Drive::By::body, 0};
  EXPECT_NEAR(area_of<3>(spec), 4.0 * 0.5 * 0.1 + 2.0 * 0.1 * 0.1, 0.1 * dx * 0.1);
}

TEST(OuterPatches, BelongToTheFirstOfWallsThatLieOnEachOther) {
  for (const double behind : {0.0, 1e-6, 0.05 * dx}) {
    CaseSpec spec = empty_case(dx);
    spec.walls = {polyline({{0.0, 0.5}, {0.0, 0.0}, {1.0, 0.0}, {1.0, 0.5}}),
                  polyline({{0.4, -behind}, {1.0 + behind, -behind}, {1.0 + behind, 0.5}})};
    EXPECT_NEAR(area_of<2>(spec, 0), 2.0, 1e-9);
    EXPECT_NEAR(area_of<2>(spec, 1), 0.0, 0.2 * dx) << behind;
  }
  // A tank on a slab, which goes on beyond it.
  CaseSpec spec = empty_case(dx, 3);
  spec.walls = {box_wall({0.0, 0.0, 0.0}, {0.4, 0.2, 0.3}, {"+z"}),
                box_wall({-0.1, -0.1, -0.1}, {0.5, 0.3, 0.0}, {}, FluidSide::outside)};
  const double slab = 2.0 * 0.6 * 0.4 + 2.0 * 0.1 * (0.6 + 0.4);
  EXPECT_NEAR(area_of<3>(spec, 1), slab - 0.4 * 0.2, 0.1 * dx * 0.4);
}

// They are cut at their present places (walls/wetted_patches.h).
TEST(OuterPatches, ContainThoseOfFixedHullsThatOverlap) {
  CaseSpec spec = empty_case(dx);
  spec.walls = {box_wall({0.0, 0.0}, {0.2, 0.1}, {}, FluidSide::outside),
                box_wall({0.1, 0.05}, {0.3, 0.2}, {}, FluidSide::outside)};
  EXPECT_NEAR(area_of<2>(spec), 0.6 + 0.7, 1e-9);
}

}  // namespace
}  // namespace tailwater
