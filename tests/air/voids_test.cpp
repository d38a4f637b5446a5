#include "air/voids.h"

#include <gtest/gtest.h>

#include "support/dimensions.h"

namespace tailwater {
namespace {

constexpr double dx = 0.1;

template <int Dim>
struct Space {
  explicit Space(const PeriodicDomain<Dim>& domain = {})
      : grid({Vec<Dim>::Zero(), Vec<Dim>::Ones()}, dx, domain), water(grid.rows(), grid.length()), walls(water) {}

  /// Fills the cells whose centres are within r of x.
  void fill(CellMarks& marks, const Vec<Dim>& x, double r) {
    grid.visit_ball(x, r, [&](int row, int begin, int end) { marks.mark(row, begin, end); });
  }
  /// Fills those at a distance between two.
  void fill_shell(CellMarks& marks, const Vec<Dim>& x, double inner, double outer) {
    for (int row = 0; row < grid.rows(); ++row) {
      for (int place = 0; place < grid.length(); ++place) {
        const double r = (grid.centre(grid.cell(row, place)) - x).norm();
        if (r > inner && r < outer) marks.mark(row, place, place + 1);
      }
    }
  }
  Voids<Dim> voids() const { return Voids<Dim>(grid, water, walls); }

  VoidGrid<Dim> grid;
  CellMarks water, walls;
};

template <class D>
class VoidsTest : public testing::Test {};
TYPED_TEST_SUITE(VoidsTest, Dimensions);

TYPED_TEST(VoidsTest, BallHasTheCellsNearItsCentre) {
  constexpr int Dim = TypeParam::value;
  Space<Dim> space;
  const Vec<Dim> x = Vec<Dim>::Constant(0.47);
  space.fill(space.water, x, 0.23);
  for (int row = 0; row < space.grid.rows(); ++row) {
    for (int place = 0; place < space.grid.length(); ++place) {
      const bool is_near = (space.grid.centre(space.grid.cell(row, place)) - x).norm() <= 0.23;
      EXPECT_EQ(space.water(row, place), is_near);
    }
  }
}

TYPED_TEST(VoidsTest, ShellOfWaterEnclosesOneVoid) {
  constexpr int Dim = TypeParam::value;
  Space<Dim> space;
  space.fill_shell(space.water, Vec<Dim>::Constant(0.5), 0.2, 0.35);
  const Voids<Dim> voids = space.voids();
  ASSERT_EQ(voids.parts().size(), 2u);
  EXPECT_TRUE(voids.parts()[0].is_open);
  EXPECT_FALSE(voids.parts()[1].is_open);
  EXPECT_TRUE(voids.parts()[1].touches_water);
  const double edge = std::pow(static_cast<double>(voids.parts()[1].cells) * space.grid.cell_volume(), 1.0 / Dim);
  const double ball = Dim == 2 ? std::sqrt(M_PI) * 0.2 : std::cbrt(4.0 / 3.0 * M_PI) * 0.2;
  EXPECT_NEAR(edge, ball, 0.5 * dx);
}

TYPED_TEST(VoidsTest, HollowInsideWallsIsNotBesideWater) {
  constexpr int Dim = TypeParam::value;
  Space<Dim> space;
  space.fill_shell(space.walls, Vec<Dim>::Constant(0.5), 0.2, 0.35);
  const Voids<Dim> voids = space.voids();
  ASSERT_EQ(voids.parts().size(), 2u);
  EXPECT_FALSE(voids.parts()[1].touches_water);
}

TYPED_TEST(VoidsTest, HoleLetsTheOpenIn) {
  constexpr int Dim = TypeParam::value;
  Space<Dim> space;
  space.fill_shell(space.water, Vec<Dim>::Constant(0.5), 0.2, 0.35);
  for (int row = 0; row < space.grid.rows(); ++row) {
    for (int place = 0; place < space.grid.length(); ++place) {
      const Vec<Dim> way = space.grid.centre(space.grid.cell(row, place)) - Vec<Dim>::Constant(0.5);
      const bool is_in_hole = way[0] > 0.0 && way.template tail<Dim - 1>().norm() < 0.6 * dx;
      if (is_in_hole) space.walls.mark(row, place, place + 1);
    }
  }
  CellMarks kept(space.grid.rows(), space.grid.length());
  for (int row = 0; row < space.grid.rows(); ++row) {
    for (int place = 0; place < space.grid.length(); ++place) {
      if (space.water(row, place) && !space.walls(row, place)) kept.mark(row, place, place + 1);
    }
  }
  space.water = kept;
  space.walls.clear();
  const Voids<Dim> voids = space.voids();
  ASSERT_EQ(voids.parts().size(), 1u);
  EXPECT_TRUE(voids.parts()[0].is_open);
}

// A void across the border of a direction that repeats is one, whichever axis that is.
TYPED_TEST(VoidsTest, GoesOnBeyondARepeatingBorder) {
  constexpr int Dim = TypeParam::value;
  for (int axis = 0; axis < Dim; ++axis) {
    PeriodicDomain<Dim> domain;
    domain[axis] = std::pair{0.0, 1.0};
    Space<Dim> space(domain);
    for (int row = 0; row < space.grid.rows(); ++row) space.water.mark(row, 0, space.grid.length());
    Vec<Dim> x = Vec<Dim>::Constant(0.5);
    x[axis] = 0.02;
    CellMarks ball(space.grid.rows(), space.grid.length());
    space.fill(ball, x, 0.3);
    CellMarks rest(space.grid.rows(), space.grid.length());
    for (int row = 0; row < space.grid.rows(); ++row) {
      for (int place = 0; place < space.grid.length(); ++place) {
        if (!ball(row, place)) rest.mark(row, place, place + 1);
      }
    }
    space.water = rest;
    const Voids<Dim> voids = space.voids();
    ASSERT_EQ(voids.parts().size(), 1u) << "axis " << axis;
    EXPECT_FALSE(voids.parts()[0].is_open);
  }
}

}  // namespace
}  // namespace tailwater
