#include "published/surface_marks.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/dimensions.h"
#include "support/tensors.h"
#include "support/water_layer.h"

namespace tailwater {
namespace {

template <class D>
class SurfaceMarksTest : public testing::Test {};
TYPED_TEST_SUITE(SurfaceMarksTest, Dimensions);

enum class Test { cone, density };

/// The surface marks of the papers for a set of particles.
template <int Dim>
struct Marks {
  Marks(Test test, const Particles<Dim>& particles, PeriodicDomain<Dim> domain)
      : set(particles,
            test == Test::density ? make_kernel<Dim>(KernelName::cubic_spline, 2.4 * layer_dx)
                                  : make_kernel<Dim>(KernelName::wendland_c2, 3.0 * layer_dx),
            layer_dx, std::move(domain)),
        is_surface(set.size()),
        interior(set.size()) {
    const KernelSumsOfSet<Dim> sums(set);
    if (test == Test::cone) {
      const ConsistentOperators<Dim> operators(set);
      mark_by_cone<Dim>({set.pairs(), sums.concentration, sums.gradient, operators.tensors, layer_dx}, set.particles,
                        is_surface);
    } else {
      mark_by_density<Dim>(set.pairs(), set.particles, sums.concentration, is_surface);
    }
    set.neighbourhood.halo().exchange(is_surface);
    find_interior_by_marks<Dim>(set.pairs(), set.particles, layer_dx, is_surface, interior);
  }

  ParticleSet<Dim> set;
  std::vector<std::uint8_t> is_surface;
  std::vector<double> interior;
};

TYPED_TEST(SurfaceMarksTest, MarkTheOutermostRowsAndNothingElse) {
  constexpr int Dim = TypeParam::value;
  for (const Test test : {Test::cone, Test::density}) {  // on a disordered set, the density test marks all loose
                                                         // particles
    const Marks<Dim> marks(test, fluid_at<Dim>(layer<Dim>(), layer_dx), along_the_layer<Dim>());
    for (std::size_t i = 0; i < marks.set.pairs().owned(); ++i) {
      const int row = row_of(marks.set.position(i)[1]);
      EXPECT_EQ(marks.is_surface[i] != 0, row == 0 || row == rows - 1) << static_cast<int>(test) << ", row " << row;
    }
  }
}

TYPED_TEST(SurfaceMarksTest, TheInteriorBeginsBelowTwoRows) {
  constexpr int Dim = TypeParam::value;
  const Marks<Dim> marks(Test::cone, fluid_at<Dim>(layer<Dim>(), layer_dx), along_the_layer<Dim>());
  for (std::size_t i = 0; i < marks.set.pairs().owned(); ++i) {
    const int row = row_of(marks.set.position(i)[1]);
    const int depth = std::min(row, rows - 1 - row);
    if (depth == 2) continue;  // exactly 2 layer_dx away, so that rounding decides
    EXPECT_EQ(marks.interior[i], depth < 2 ? 0.0 : 1.0) << "depth " << depth;
  }
}

TYPED_TEST(SurfaceMarksTest, WallsAreNeverMarkedAndCoverTheSurface) {
  constexpr int Dim = TypeParam::value;
  Particles<Dim> particles = fluid_at<Dim>(layer<Dim>(), layer_dx);
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (row_of(particles.position[i][1]) < 3) particles.kind[i] = ParticleKind::wall;
  }
  const Marks<Dim> marks(Test::cone, particles, along_the_layer<Dim>());
  for (std::size_t i = 0; i < marks.set.pairs().owned(); ++i) {
    const int row = row_of(marks.set.position(i)[1]);
    EXPECT_EQ(marks.is_surface[i] != 0, row == rows - 1) << "row " << row;
  }
}

TYPED_TEST(SurfaceMarksTest, AClumpAsDenseAsWaterIsSurface) {
  constexpr int Dim = TypeParam::value;
  // Seven nearly coincident particles: W_0 w/C_0 is 0.32 in 2D and 0.18 in 3D.
  std::vector<Vec<Dim>> clump;
  for (int k = 0; k < 7; ++k) clump.push_back(0.01 * k * layer_dx * Vec<Dim>::UnitX());
  const Marks<Dim> marks(Test::density, fluid_at<Dim>(clump, layer_dx), {});
  for (std::size_t i = 0; i < clump.size(); ++i) EXPECT_TRUE(marks.is_surface[i]);
}

TYPED_TEST(SurfaceMarksTest, SprayIsSurface) {
  constexpr int Dim = TypeParam::value;
  const std::vector<Vec<Dim>> spray{Vec<Dim>::Zero(), layer_dx * Vec<Dim>::UnitX(), Vec<Dim>::Constant(5.0)};
  const Marks<Dim> marks(Test::cone, fluid_at<Dim>(spray, layer_dx), {});
  for (std::size_t i = 0; i < spray.size(); ++i) {
    EXPECT_TRUE(marks.is_surface[i]);
    EXPECT_EQ(marks.interior[i], 0.0);
  }
}

}  // namespace
}  // namespace tailwater
