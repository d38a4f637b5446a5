// Sections that walls leave open of a plane.
#include "geometry/plane_section.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "geometry/from_spec.h"
#include "geometry/meshes.h"
#include "geometry/opening.h"

namespace tailwater {
namespace {

using namespace testing_cases;

constexpr double area_error = 1e-4;  // m^2; corners are found to 1e-3 dx, and no section is 3 m around

/// The outlet through a point at high x of a case with this wall, spacing 0.1 m.
Opening<3> outlet_through(const WallTable& wall, const Coordinates& point) {
  CaseSpec spec = case_with(wall);
  OutletTable table;
  table.through = point;
  table.direction = {1.0, 0.0, 0.0};
  spec.outlets = {table};
  return make_open_ends<3>(spec).at(0);
}

double area_of(const Opening<3>& opening) {
  double area = 0.0;
  for (const WallFace<3>& face : opening.as_faces()) area += face.measure();
  EXPECT_NEAR(area, std::abs(signed_area(opening.outline.corners())), 1e-12) << "the triangles fill it";
  return area;
}

TEST(PlaneSection, OfAnOpenBoxEndsAtTheHeightOfThePoint) {
  const Opening<3> end = outlet_through(box_wall({0, 0, 0}, {1.0, 0.5, 0.6}, {"+z", "+x"}), {1.0, 0.2, 0.4});
  EXPECT_NEAR(area_of(end), 0.5 * 0.4, area_error);
  EXPECT_NEAR(end.edges[0].norm(), 0.5, area_error);
  EXPECT_NEAR(end.edges[1].norm(), 0.4, area_error);
  EXPECT_TRUE(end.is_passed_by({1.1, 0.4, 0.3}));
  EXPECT_FALSE(end.is_passed_by({1.1, 0.4, 0.5}));
}

TEST(PlaneSection, OfAPipeIsAllOfIt) {
  const Opening<3> end = outlet_through(box_wall({0, 0, 0}, {1.0, 0.5, 0.6}, {"+x"}), {1.0, 0.2, 0.3});
  EXPECT_NEAR(area_of(end), 0.5 * 0.6, area_error);
}

/// A valley with sides of 2 : 1 on a mesh whose cells its bottom divides, and its plane at the end of the mesh.
TEST(PlaneSection, OfAValleyIsATriangle) {
  const MeshFolder folder;
  const TriangleMesh valley = sheet_mesh(8, [](double, double y) { return std::abs(2.0 * y - 1.0); });
  const WallTable wall = folder.wall(valley, FluidSide::above);
  const Opening<3> end = outlet_through(wall, {1.0, 0.45, 0.6});
  EXPECT_NEAR(area_of(end), 0.5 * 0.6 * 0.6, area_error);
  EXPECT_TRUE(end.spans({1.0, 0.5, 0.05}));
  EXPECT_FALSE(end.spans({1.0, 0.2, 0.5}));
}

/// A box divides the valley: only the part around the point counts, and ends where the walls cross.
TEST(PlaneSection, EndsWhereWallsCross) {
  const MeshFolder folder;
  const TriangleMesh valley = sheet_mesh(8, [](double, double y) { return std::abs(2.0 * y - 1.0); });
  CaseSpec spec = case_with(folder.wall(valley, FluidSide::above));
  spec.walls.push_back(box_wall({-1.0, 0.5, -1.0}, {2.0, 3.0, 2.0}, {}, FluidSide::outside));
  OutletTable table;
  table.through = {1.0, 0.4, 0.6};
  table.direction = {1.0, 0.0, 0.0};
  spec.outlets = {table};
  EXPECT_NEAR(area_of(make_open_ends<3>(spec).at(0)), 0.25 * 0.6 * 0.6, area_error);
}

TEST(PlaneSection, OfWallsThatHoldNothingIsRefused) {
  const WallTable wall = box_wall({0, 0, 0}, {1.0, 0.5, 0.6}, {"+z", "+x"});
  for (const Coordinates& point :
       {Coordinates{1.0, 0.2, 0.7}, Coordinates{1.0, 0.7, 0.3}, Coordinates{1.5, 0.2, 0.3}}) {
    try {
      outlet_through(wall, point);
      ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
      expect_words(error.what(), {"outlet 'outlet1': no walls hold water in the plane through", "above the bed"});
    }
  }
}

TEST(PlaneSection, DiscsAndPolygonsHaveTheirArea) {
  CaseSpec spec = empty_case(0.1, 3);
  OutletTable disc;
  disc.centre = {1.0, 2.0, 3.0};
  disc.radius = 0.4;
  disc.direction = {0.6, 0.0, 0.8};
  OutletTable polygon;
  polygon.polygon = {{0, 0, 0}, {0, 2, 0}, {0, 2, 1}, {0, 1, 0.25}, {0, 0, 1}};
  polygon.direction = {-1.0, 0.0, 0.0};
  spec.outlets = {disc, polygon};
  const std::vector<Opening<3>> ends = make_open_ends<3>(spec);
  EXPECT_NEAR(area_of(ends[0]), std::numbers::pi * 0.16, 1e-9);
  EXPECT_LT((ends[0].normal - Vec<3>(0.6, 0.0, 0.8)).norm(), 1e-12);
  EXPECT_TRUE(ends[0].spans({1.0, 2.35, 3.0}));
  EXPECT_NEAR(area_of(ends[1]), 2.0 - 0.75, 1e-12);
  EXPECT_FALSE(ends[1].spans({0.0, 1.0, 0.9}));
  EXPECT_TRUE(ends[1].is_passed_by({-0.1, 1.0, 0.1}));
  polygon.polygon[1] = {0.5, 2, 0};
  spec.outlets = {polygon};
  EXPECT_THROW(make_open_ends<3>(spec), InputError);
}

}  // namespace
}  // namespace tailwater
