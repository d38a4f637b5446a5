// A layer of water between two flat free surfaces, periodic along them: rows are known by their height.
#include "closures/free_surface.h"

#include <gtest/gtest.h>

#include <vector>

#include "operators/concentration.h"
#include "operators/lattice.h"
#include "support/dimensions.h"
#include "support/tensors.h"

namespace tailwater {
namespace {

constexpr double dx = 0.1;
constexpr int rows = 12;
constexpr int columns = 8;

template <class D>
class FreeSurfaceTest : public testing::Test {};
TYPED_TEST_SUITE(FreeSurfaceTest, Dimensions);

template <int Dim>
PeriodicDomain<Dim> along_the_layer() {
  PeriodicDomain<Dim> domain;
  for (int d = 0; d < Dim; ++d) {
    if (d != 1) domain[d] = std::pair{0.0, columns * dx};
  }
  return domain;
}

template <int Dim>
std::vector<Vec<Dim>> layer() {
  std::array<int, Dim> count;
  count.fill(columns);
  count[1] = rows;
  return lattice_points<Dim>(Vec<Dim>::Constant(0.5 * dx), count, dx);
}

int row_of(double y) { return static_cast<int>(std::floor(y / dx)); }

template <int Dim>
struct Marks {
  Marks(SurfaceTreatment test, const Particles<Dim>& particles, PeriodicDomain<Dim> domain)
      : set(particles,
            test == SurfaceTreatment::density ? make_kernel<Dim>(KernelName::cubic_spline, 2.4 * dx)
                                              : make_kernel<Dim>(KernelName::wendland_c2, 3.0 * dx),
            dx, std::move(domain)),
        is_surface(set.size()),
        interior(set.size()) {
    const ConsistentOperators<Dim> operators(set);
    const Kernel<Dim>& kernel = set.neighbourhood.kernel();
    const double W_0 = kernel_value(kernel, 0.0);
    const double C_0 = lattice_sums<Dim>(kernel, dx).concentration;
    std::vector<double> filling(set.size());
    std::vector<Vec<Dim>> gradient(set.size());
    for (std::size_t i = 0; i < set.pairs().owned(); ++i) {
      const KernelSums<Dim> sums = kernel_sums<Dim>(set.pairs(), i, {W_0, 1.0});
      filling[i] = sums.concentration / C_0;
      gradient[i] = sums.gradient;
    }
    find_free_surface<Dim>(test, {set.pairs(), set.particles, filling, gradient, operators.tensors, dx, 0.99},
                           is_surface);
    set.neighbourhood.halo().exchange(is_surface);
    if (test == SurfaceTreatment::air) {
      set.neighbourhood.halo().exchange(filling);
      find_interior<Dim>(set.pairs(), set.particles, filling, W_0, interior);
    } else {
      find_interior_by_marks<Dim>(set.pairs(), set.particles, dx, is_surface, interior);
    }
  }

  ParticleSet<Dim> set;
  std::vector<std::uint8_t> is_surface;
  std::vector<double> interior;
};

const std::vector<SurfaceTreatment> on_any_set{SurfaceTreatment::air, SurfaceTreatment::cone};

TYPED_TEST(FreeSurfaceTest, MarksTheOutermostRowsAndNothingElse) {
  constexpr int Dim = TypeParam::value;
  std::vector<SurfaceTreatment> tests = on_any_set;
  tests.push_back(SurfaceTreatment::density);  // on a disordered set it marks whatever is loose
  for (const SurfaceTreatment test : tests) {
    const Marks<Dim> marks(test, fluid_at<Dim>(layer<Dim>(), dx), along_the_layer<Dim>());
    for (std::size_t i = 0; i < marks.set.pairs().owned(); ++i) {
      const int row = row_of(marks.set.position(i)[1]);
      EXPECT_EQ(marks.is_surface[i] != 0, row == 0 || row == rows - 1) << static_cast<int>(test) << ", row " << row;
    }
  }
}

TYPED_TEST(FreeSurfaceTest, TheInteriorBeginsBelowTwoRows) {
  constexpr int Dim = TypeParam::value;
  for (const SurfaceTreatment test : on_any_set) {
    const Marks<Dim> marks(test, fluid_at<Dim>(layer<Dim>(), dx), along_the_layer<Dim>());
    for (std::size_t i = 0; i < marks.set.pairs().owned(); ++i) {
      const int row = row_of(marks.set.position(i)[1]);
      const int depth = std::min(row, rows - 1 - row);
      if (depth == 2) continue;  // by marks: exactly 2 dx away, rounding decides; by concentration: on the step
      EXPECT_EQ(marks.interior[i], depth < 2 ? 0.0 : 1.0) << static_cast<int>(test) << ", depth " << depth;
    }
  }
}

TYPED_TEST(FreeSurfaceTest, WallsAreNeverMarkedAndCoverTheSurface) {
  constexpr int Dim = TypeParam::value;
  for (const SurfaceTreatment test : on_any_set) {
    Particles<Dim> particles = fluid_at<Dim>(layer<Dim>(), dx);
    for (std::size_t i = 0; i < particles.owned; ++i) {
      if (row_of(particles.position[i][1]) < 3) particles.kind[i] = ParticleKind::wall;
    }
    const Marks<Dim> marks(test, particles, along_the_layer<Dim>());
    for (std::size_t i = 0; i < marks.set.pairs().owned(); ++i) {
      const int row = row_of(marks.set.position(i)[1]);
      EXPECT_EQ(marks.is_surface[i] != 0, row == rows - 1) << static_cast<int>(test) << ", row " << row;
    }
  }
}

TYPED_TEST(FreeSurfaceTest, AClumpAsDenseAsWaterIsSurface) {
  constexpr int Dim = TypeParam::value;
  // Seven particles almost in one place: W_0 w/C_0 is 0.32 in 2D and 0.18 in 3D.
  std::vector<Vec<Dim>> clump;
  for (int k = 0; k < 7; ++k) clump.push_back(0.01 * k * dx * Vec<Dim>::UnitX());
  const Marks<Dim> marks(SurfaceTreatment::density, fluid_at<Dim>(clump, dx), {});
  for (std::size_t i = 0; i < clump.size(); ++i) EXPECT_TRUE(marks.is_surface[i]);
}

TYPED_TEST(FreeSurfaceTest, SprayIsSurface) {
  constexpr int Dim = TypeParam::value;
  for (const SurfaceTreatment test : on_any_set) {
    const std::vector<Vec<Dim>> spray{Vec<Dim>::Zero(), dx * Vec<Dim>::UnitX(), Vec<Dim>::Constant(5.0)};
    const Marks<Dim> marks(test, fluid_at<Dim>(spray, dx), {});
    for (std::size_t i = 0; i < spray.size(); ++i) {
      EXPECT_TRUE(marks.is_surface[i]) << static_cast<int>(test);
      EXPECT_EQ(marks.interior[i], 0.0) << static_cast<int>(test);
    }
  }
}

}  // namespace
}  // namespace tailwater
