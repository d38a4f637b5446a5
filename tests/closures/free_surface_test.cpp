#include "closures/free_surface.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/dimensions.h"
#include "support/water_layer.h"

namespace tailwater {
namespace {

template <class D>
class FreeSurfaceTest : public testing::Test {};
TYPED_TEST_SUITE(FreeSurfaceTest, Dimensions);

/// The inputs of the default free-surface marks for a set of particles.
template <int Dim>
struct Marks {
  Marks(const Particles<Dim>& particles, PeriodicDomain<Dim> domain)
      : set(particles, make_kernel<Dim>(KernelName::wendland_c2, 3.0 * layer_dx), layer_dx, std::move(domain)),
        is_surface(set.size()),
        interior(set.size()) {
    KernelSumsOfSet<Dim> sums(set);
    mark_thin_water<Dim>(set.particles, sums.concentration, is_surface);
    set.neighbourhood.halo().exchange(sums.concentration);
    find_interior<Dim>(set.pairs(), set.particles, sums.concentration, sums.W_0, interior);
  }

  ParticleSet<Dim> set;
  std::vector<std::uint8_t> is_surface;
  std::vector<double> interior;
};

TYPED_TEST(FreeSurfaceTest, MarksTheOutermostRowsAndNothingElse) {
  constexpr int Dim = TypeParam::value;
  const Marks<Dim> marks(fluid_at<Dim>(layer<Dim>(), layer_dx), along_the_layer<Dim>());
  for (std::size_t i = 0; i < marks.set.pairs().owned(); ++i) {
    const int row = row_of(marks.set.position(i)[1]);
    EXPECT_EQ(marks.is_surface[i] != 0, row == 0 || row == rows - 1) << "row " << row;
  }
}

TYPED_TEST(FreeSurfaceTest, TheInteriorBeginsBelowTwoRows) {
  constexpr int Dim = TypeParam::value;
  const Marks<Dim> marks(fluid_at<Dim>(layer<Dim>(), layer_dx), along_the_layer<Dim>());
  for (std::size_t i = 0; i < marks.set.pairs().owned(); ++i) {
    const int row = row_of(marks.set.position(i)[1]);
    const int depth = std::min(row, rows - 1 - row);
    if (depth == 2) continue;  // at the transition
    EXPECT_EQ(marks.interior[i], depth < 2 ? 0.0 : 1.0) << "depth " << depth;
  }
}

TYPED_TEST(FreeSurfaceTest, WallsAreNeverMarkedAndCoverTheSurface) {
  constexpr int Dim = TypeParam::value;
  Particles<Dim> particles = fluid_at<Dim>(layer<Dim>(), layer_dx);
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (row_of(particles.position[i][1]) < 3) particles.kind[i] = ParticleKind::wall;
  }
  const Marks<Dim> marks(particles, along_the_layer<Dim>());
  for (std::size_t i = 0; i < marks.set.pairs().owned(); ++i) {
    const int row = row_of(marks.set.position(i)[1]);
    EXPECT_EQ(marks.is_surface[i] != 0, row == rows - 1) << "row " << row;
  }
}

TYPED_TEST(FreeSurfaceTest, SprayIsSurface) {
  constexpr int Dim = TypeParam::value;
  const std::vector<Vec<Dim>> spray{Vec<Dim>::Zero(), layer_dx * Vec<Dim>::UnitX(), Vec<Dim>::Constant(5.0)};
  const Marks<Dim> marks(fluid_at<Dim>(spray, layer_dx), {});
  for (std::size_t i = 0; i < spray.size(); ++i) {
    EXPECT_TRUE(marks.is_surface[i]);
    EXPECT_EQ(marks.interior[i], 0.0);
  }
}

}  // namespace
}  // namespace tailwater
