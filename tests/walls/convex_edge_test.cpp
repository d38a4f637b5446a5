// Images beside a convex edge: a wall without water in front of it blocks nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "geometry/cases.h"
#include "sampling/wall_particles.h"
#include "support/dimensions.h"
#include "support/particle_set.h"
#include "support/rounding.h"
#include "walls/dummies.h"
#include "walls/wet_walls.h"

namespace tailwater {
namespace convex_edge_test {

constexpr double dx = 0.1;
constexpr double round_off = 1e-5;  // of single precision

/// Beside the upper edge of a block that ends at x = 0 and z = 0 (the last axis): water on the lattice wherever
/// `is_wet` says.
template <int Dim>
struct EdgeOfBlock {
  using IsWet = std::function<bool(const Vec<Dim>&)>;

  explicit EdgeOfBlock(const IsWet& is_wet) : walls(block()), set(particles(walls, is_wet), kernel(), dx) {
    surroundings.resize(set.size(), false);
    find_wet_walls<Dim>(set.pairs(), set.particles, kernel_value(kernel(), 0.0), surroundings.wall_fluid_weight,
                        surroundings.is_wet);
  }

  static Kernel<Dim> kernel() { return make_kernel<Dim>(KernelName::wendland_c2, 3.0 * dx); }

  static Walls<Dim> block() {
    CaseSpec spec = testing_cases::empty_case(dx, Dim);
    Coordinates low(Dim, -1.0);
    Coordinates high(Dim, 1.0);
    high[0] = high[Dim - 1] = 0.0;
    spec.walls = {testing_cases::box_wall(low, high, {}, FluidSide::outside)};
    Walls<Dim> walls;
    walls.boundary = make_boundary<Dim>(spec);
    walls.particles = make_dummy_particles<Dim>(walls.boundary, dx, 3);
    return walls;
  }

  static Particles<Dim> particles(const Walls<Dim>& walls, const IsWet& is_wet) {
    std::vector<Vec<Dim>> points;
    std::array<int, Dim> count;
    count.fill(12);
    for (const Vec<Dim>& x : lattice_points<Dim>(Vec<Dim>::Constant(-5.5 * dx), count, dx)) {
      if ((x[0] > 0.0 || x[Dim - 1] > 0.0) && is_wet(x)) points.push_back(x);
    }
    const std::size_t fluid = points.size();
    points.insert(points.end(), walls.particles.position.begin(), walls.particles.position.end());
    Particles<Dim> all = fluid_at<Dim>(points, dx);
    for (std::size_t i = fluid; i < all.owned; ++i) {
      all.kind[i] = ParticleKind::wall;
      all.wall_row[i] = static_cast<std::int32_t>(i - fluid);
    }
    return all;
  }

  WallScene<Dim> scene() const { return {set.pairs(), set.particles, walls, surroundings}; }

  /// Calls visit(i, x) for the wet dummies within 3 dx of the edge; in 3D in the middle of it.
  template <class Visit>
  void visit_wet(Visit&& visit) const {
    for (std::size_t i = 0; i < set.size(); ++i) {
      const Vec<Dim>& x = set.position(i);
      const bool is_near = x[0] > -3.0 * dx && x[Dim - 1] > -3.0 * dx && (Dim == 2 || std::abs(x[1]) < dx);
      if (!set.particles.is_fluid(i) && surroundings.is_wet[i] && is_near) visit(i, x);
    }
  }

  Walls<Dim> walls;
  ParticleSet<Dim> set;
  Surroundings<Dim> surroundings;
};

template <class D>
class ConvexEdgeTest : public testing::Test {};
TYPED_TEST_SUITE(ConvexEdgeTest, Dimensions);

// A layer that runs on beyond the edge, above a dry side: a wall that goes on under it would show it the same.
TYPED_TEST(ConvexEdgeTest, ADrySideBlocksNothing) {
  constexpr int Dim = TypeParam::value;
  const EdgeOfBlock<Dim> edge([](const Vec<Dim>& x) { return x[Dim - 1] > 0.0; });
  Vec<Dim> u = Vec<Dim>::Constant(0.4);
  Vec<Dim> image = u;
  u[Dim - 1] = -0.7;
  image[Dim - 1] = 0.7;
  std::vector<Vec<Dim>> velocity(edge.set.size(), u);
  make_dummies<Dim>()->show_velocity(edge.scene(), {}, velocity);
  int wet = 0;
  edge.visit_wet([&](std::size_t i, const Vec<Dim>& x) {
    EXPECT_LT((velocity[i] - image).norm(), 100.0 * single_eps) << x.transpose();
    ++wet;
  });
  EXPECT_EQ(wet, Dim == 2 ? 6 : 12);
}

// With water all around, the mirror turns from the top to the side, and is halfway on the diagonal.
TYPED_TEST(ConvexEdgeTest, TheMirrorTurnsRoundAWetEdge) {
  constexpr int Dim = TypeParam::value;
  const EdgeOfBlock<Dim> edge([](const Vec<Dim>&) { return true; });
  edge.visit_wet([&](std::size_t i, const Vec<Dim>& x) {
    const Vec<Dim> n = mirror_at(edge.scene(), i).normal;
    const double along = Dim == 2 ? 0.0 : n[1];
    EXPECT_NEAR(along, 0.0, round_off) << x.transpose();
    EXPECT_EQ(n[0] > n[Dim - 1], x[0] > x[Dim - 1] + 0.5 * dx) << x.transpose() << ": " << n.transpose();
    EXPECT_GT(n[0], -round_off);
    EXPECT_GT(n[Dim - 1], -round_off);
  });
}

}  // namespace convex_edge_test
}  // namespace tailwater
