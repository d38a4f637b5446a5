#include "porous/porous_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "schemes/cases.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

constexpr double dx = 0.05;
constexpr double layer_porosity = 0.4;

/// A tank of 1 m with a porous layer on its floor, from x = 0.4 m to its right wall, up to `height`.
template <int Dim>
CaseSpec tank_with_layer(double height) {
  CaseSpec spec = tank_case<Dim>(dx, 1.0, 0.5);
  PorousTable layer;
  layer.name = "layer";
  layer.min = Coordinates(Dim, 0.0);
  layer.max = Coordinates(Dim, 1.0);
  layer.min[0] = 0.4;
  layer.max[Dim - 1] = height;
  layer.porosity = layer_porosity;
  layer.resistance = PorousResistance::coefficients;
  layer.linear = 10.0;
  spec.porous = {layer};
  return spec;
}

template <int Dim>
PorousField<Dim> make_field(const CaseSpec& spec, const PeriodicDomain<Dim>& domain = {}) {
  Boundary<Dim> boundary = make_boundary<Dim>(spec);
  boundary.file_faces(3.0 * dx);
  return {spec, boundary, make_kernel<Dim>(KernelName::wendland_c2, 3.0 * dx), domain};
}

/// The position at x and height y, in the middle of other directions.
template <int Dim>
Vec<Dim> at(double x, double y) {
  Vec<Dim> place = Vec<Dim>::Constant(0.5);
  place[0] = x;
  place[Dim - 1] = y;
  return place;
}

template <class D>
class PorousFieldIn : public testing::Test {};
TYPED_TEST_SUITE(PorousFieldIn, Dimensions);

// The numbers of the field are in single precision.
constexpr double rounding = 1e-6;

TYPED_TEST(PorousFieldIn, HasTheMediumInsideUpToWallsAndOpenWaterOutside) {
  constexpr int Dim = TypeParam::value;
  const PorousField<Dim> field = make_field<Dim>(tank_with_layer<Dim>(0.5));
  for (const Vec<Dim>& place : {at<Dim>(0.7, 0.2), at<Dim>(0.99, 0.2), at<Dim>(0.7, 0.01), at<Dim>(0.99, 0.01)}) {
    EXPECT_NEAR(field.porosity_at(place), layer_porosity, rounding) << place.transpose();
    EXPECT_NEAR(field.at(place).linear, 10.0 * g, 10.0 * g * rounding) << place.transpose();
  }
  for (const Vec<Dim>& place : {at<Dim>(0.1, 0.2), at<Dim>(0.7, 0.8), at<Dim>(-5.0, 0.2)}) {
    EXPECT_EQ(field.porosity_at(place), 1.0) << place.transpose();
  }
  EXPECT_NEAR(field.porosity_at(at<Dim>(0.4, 0.2)), 0.5 * (1.0 + layer_porosity), rounding);
}

// The kernel is even, so across the surface of the layer the mean porosity equals that of the drawing, also where the
// surface is between nodes.
TYPED_TEST(PorousFieldIn, KeepsTheVolumeOfThePores) {
  constexpr int Dim = TypeParam::value;
  for (const double from : {0.4, 0.4 + 0.3 * dx}) {
    CaseSpec spec = tank_with_layer<Dim>(0.5);
    spec.porous[0].min[0] = from;
    const PorousField<Dim> field = make_field<Dim>(spec);
    constexpr int count = 4000;
    double pores = 0.0;
    for (int k = 0; k < count; ++k) pores += field.porosity_at(at<Dim>(0.2 + 0.4 * (k + 0.5) / count, 0.2)) / count;
    const double drawn = ((from - 0.2) + layer_porosity * (0.6 - from)) / 0.4;
    EXPECT_NEAR(pores, drawn, 1e-4);  // midpoints on pieces of straight lines: (1/count)^2 times their kinks
  }
}

TYPED_TEST(PorousFieldIn, HasTheGradientOfItsPorosity) {
  constexpr int Dim = TypeParam::value;
  const PorousField<Dim> field = make_field<Dim>(tank_with_layer<Dim>(0.5));
  double rise = 0.0;
  constexpr int count = 4000;
  for (int k = 0; k < count; ++k) {
    const Vec<Dim> slope = field.porosity_gradient_at(at<Dim>(0.2 + 0.4 * (k + 0.5) / count, 0.2));
    EXPECT_NEAR(slope[Dim - 1], 0.0, rounding / dx);
    rise += slope[0] * 0.4 / count;
  }
  EXPECT_NEAR(rise, layer_porosity - 1.0, 1e-4);
}

TEST(PorousField, TheLastOfTwoLayersCountsWhereTheyOverlap) {
  CaseSpec spec = tank_with_layer<2>(0.5);
  spec.porous.push_back(spec.porous[0]);
  spec.porous[1].min[0] = 0.7;
  spec.porous[1].porosity = 0.6;
  const PorousField<2> field = make_field<2>(spec);
  EXPECT_NEAR(field.porosity_at(at<2>(0.55, 0.2)), layer_porosity, rounding);
  EXPECT_NEAR(field.porosity_at(at<2>(0.9, 0.2)), 0.6, rounding);
  EXPECT_NEAR(field.porosity_at(at<2>(0.7, 0.2)), 0.5 * (layer_porosity + 0.6), rounding);
}

TEST(PorousField, APolygonHasTheSidesOfItsOutline) {
  CaseSpec spec = tank_with_layer<2>(0.5);
  PorousTable& layer = spec.porous[0];
  layer.shape = RegionShape::polygon;
  layer.points = {{0.2, -0.1}, {1.2, -0.1}, {1.2, 0.9}};  // x = y + 0.3
  const PorousField<2> field = make_field<2>(spec);
  EXPECT_NEAR(field.porosity_at({0.8, 0.2}), layer_porosity, rounding);
  EXPECT_EQ(field.porosity_at({0.3, 0.4}), 1.0);
  // Oblique to the grid the fraction of a cell is not exact: the error is a hundredth of the step of n.
  EXPECT_NEAR(field.porosity_at({0.6, 0.3}), 0.5 * (1.0 + layer_porosity), 0.01 * (1.0 - layer_porosity));
}

TEST(PorousField, GoesOnBeyondAPeriod) {
  CaseSpec spec = tank_with_layer<2>(0.5);
  spec.walls.clear();
  const PeriodicDomain<2> domain{std::pair{0.0, 1.0}, std::nullopt};
  spec.domain.periodic_x = {0.0, 1.0};
  const PorousField<2> field = make_field<2>(spec, domain);
  EXPECT_NEAR(field.porosity_at({1.0, 0.2}), 0.5 * (1.0 + layer_porosity), rounding);
  EXPECT_NEAR(field.porosity_at({1.6, 0.2}), layer_porosity, rounding);
}

TEST(PorousField, RefusesALayerInAWrongUnit) {
  CaseSpec spec = tank_with_layer<2>(0.5);
  spec.porous[0].max = {1e6, 1e6};
  EXPECT_THROW(make_field<2>(spec), InputError);
}

}  // namespace
}  // namespace tailwater
