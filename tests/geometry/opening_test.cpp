#include <gtest/gtest.h>

#include "base/error.h"
#include "geometry/cases.h"
#include "geometry/opening.h"

namespace tailwater {
namespace {

using namespace testing_cases;

template <int Dim>
Opening<Dim> only_outlet(const OutletTable& table) {
  CaseSpec spec = empty_case(0.1, Dim);
  spec.outlets = {table};
  return make_open_ends<Dim>(spec).at(0);
}

template <int Dim>
std::string refusal(const OutletTable& table) {
  try {
    only_outlet<Dim>(table);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Outlet, LetsWaterOutInItsDirectionWhicheverEndComesFirst) {
  for (OutletTable table : {outlet({2.0, 0.0}, {2.0, 0.5}), outlet({2.0, 0.5}, {2.0, 0.0})}) {
    EXPECT_LT((only_outlet<2>(table).normal - Vec<2>(1.0, 0.0)).norm(), 1e-15);
    EXPECT_TRUE(only_outlet<2>(table).is_passed_by({2.01, 0.3}));
    EXPECT_FALSE(only_outlet<2>(table).is_passed_by({1.99, 0.3}));
    EXPECT_FALSE(only_outlet<2>(table).is_passed_by({2.01, 0.6})) << "over its top";
    table.direction = {-0.5, 0.5};
    EXPECT_LT((only_outlet<2>(table).normal - Vec<2>(-1.0, 0.0)).norm(), 1e-15);
    EXPECT_TRUE(only_outlet<2>(table).is_passed_by({1.99, 0.3}));
  }
}

TEST(Outlet, MayBeSlanted) {
  const Opening<2> slanted = only_outlet<2>(outlet({1.0, 0.0}, {2.0, 1.0}));
  EXPECT_NEAR(slanted.beyond({2.0, 0.0}), std::sqrt(0.5), 1e-15);
  EXPECT_TRUE(slanted.spans({2.0, 0.0}));
  EXPECT_FALSE(slanted.spans({0.9, 0.0}));
}

TEST(Outlet, IsARectangleIn3D) {
  const Opening<3> end = only_outlet<3>(outlet({2.0, 1.0, 0.5}, {2.0, 0.0, 0.0}));
  EXPECT_LT((end.normal - Vec<3>::Unit(0)).norm(), 1e-15);
  EXPECT_TRUE(end.is_passed_by({2.1, 0.9, 0.4}));
  EXPECT_FALSE(end.is_passed_by({2.1, 1.1, 0.4}));
  EXPECT_FALSE(end.is_passed_by({2.1, 0.9, -0.1}));
  double area = 0.0;
  for (const WallFace<3>& face : end.as_faces()) area += face.measure();
  EXPECT_NEAR(area, 0.5, 1e-15);
}

TEST(Outlet, WithoutExtentOrOutsideIsRefused) {
  EXPECT_NE(refusal<2>(outlet({2.0, 0.0}, {2.0, 0.0})).find("outlet 'outlet1' has no extent"), std::string::npos);
  EXPECT_NE(refusal<2>(outlet({1.0, 0.0}, {2.0, 0.0})).find("lies along its direction (1, 0)"), std::string::npos);
  EXPECT_NE(refusal<3>(outlet({2.0, 0.0, 0.0}, {2.5, 1.0, 0.5})).find("is not a flat rectangle"), std::string::npos);
  EXPECT_NE(refusal<3>(outlet({2.0, 0.0, 0.0}, {2.0, 0.0, 0.5})).find("is not a flat rectangle"), std::string::npos);
}

}  // namespace
}  // namespace tailwater
