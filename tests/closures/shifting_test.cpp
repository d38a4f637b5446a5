#include "closures/shifting.h"

#include <gtest/gtest.h>

#include <vector>

#include "closures/fluid_pairs.h"
#include "operators/concentration.h"
#include "operators/lattice.h"
#include "published/shifting.h"
#include "support/dimensions.h"
#include "support/particle_set.h"
#include "support/rounding.h"

namespace tailwater {
namespace shifting_test {

constexpr double dx = 0.1;
constexpr double dt = 0.01;
/// Not 3 dx: rounding would decide whether lattice neighbours at that distance count, and (F28) has no kernel that
/// decays there.
constexpr double radius = 2.9 * dx;

template <class D>
class ShiftingTest : public testing::Test {};
TYPED_TEST_SUITE(ShiftingTest, Dimensions);

enum class ShiftingKind { lind, farzin };

template <int Dim>
struct Shifted {
  Shifted(ShiftingKind kind, double cap, std::vector<Vec<Dim>> points, double speed, bool is_near_surface)
      : Shifted(kind, cap, points, speed, std::vector<double>(points.size(), is_near_surface ? 0.0 : 1.0)) {}

  Shifted(ShiftingKind kind, double cap, std::vector<Vec<Dim>> points, double speed,
          const std::vector<double>& interior)
      : set(moving(points, speed), make_kernel<Dim>(KernelName::wendland_c2, radius), dx),
        shift(set.size(), Vec<Dim>::Ones()) {
    Surroundings<Dim> surroundings;
    surroundings.interior = interior;
    const KernelValues values = kernel_values_of(set.neighbourhood.kernel(), dx);
    for (std::size_t i = 0; i < set.size(); ++i) {
      surroundings.mean_interior.push_back(mean_over_fluid<Dim>(set.pairs(), i, interior, 0.0));
      surroundings.crowding.push_back(kernel_sums<Dim>(set.pairs(), i, values).crowding);
    }
    const bool is_lind = kind == ShiftingKind::lind;
    const ShiftingLaw law{.strength = is_lind ? 2.0 : 0.1, .cap = cap, .spacing = dx};
    beyond_bound = is_lind ? compute_shift<Dim>(law, dt, speed, set.pairs(), set.particles, surroundings, shift)
                           : find_published_shifts<Dim>(law, dt, set.pairs(), set.particles, surroundings, shift);
  }

  static Particles<Dim> moving(const std::vector<Vec<Dim>>& points, double speed) {
    Particles<Dim> particles = fluid_at<Dim>(points, dx);
    for (Vec<Dim>& velocity : particles.velocity) velocity = speed * Vec<Dim>::UnitX();
    particles.kind[0] = ParticleKind::wall;  // a wall, which must not move
    return particles;
  }

  ParticleSet<Dim> set;
  std::vector<Vec<Dim>> shift;
  std::size_t beyond_bound = 0;
};

template <int Dim>
constexpr int cube_count = Dim == 2 ? 13 : 9;

constexpr std::array kinds{ShiftingKind::lind, ShiftingKind::farzin};

TYPED_TEST(ShiftingTest, LeavesTheInteriorOfALatticeAlone) {
  constexpr int Dim = TypeParam::value;
  for (const ShiftingKind kind : kinds) {
    const Shifted<Dim> shifted(kind, dx, jittered_cube<Dim>(cube_count<Dim>, dx, 0.0), 1.0, false);
    const double interior = (0.5 * (cube_count<Dim> - 1) - 3.0 + 1e-6) * dx;
    std::size_t tested = 0;
    for (std::size_t i = 0; i < shifted.set.size(); ++i) {
      if (shifted.set.position(i).cwiseAbs().maxCoeff() > interior) continue;
      ++tested;
      // Opposite neighbours cancel; the rounding error of a position is eps times the size of the cube, ten dx.
      EXPECT_LT(shifted.shift[i].norm(), 10.0 * single_eps * dt);
    }
    EXPECT_GT(tested, 0u);
  }
}

TYPED_TEST(ShiftingTest, MovesAwayFromTheCrowd) {
  constexpr int Dim = TypeParam::value;
  for (const ShiftingKind kind : kinds) {
    auto points = jittered_cube<Dim>(cube_count<Dim>, dx, 0.0);
    const std::size_t middle = points.size() / 2;
    points[middle] += 0.3 * dx * Vec<Dim>::UnitX();
    const Shifted<Dim> shifted(kind, dx, points, 1.0, false);
    EXPECT_LT(shifted.shift[middle][0], 0.0);
    // The transverse components vanish by symmetry.
    EXPECT_LT((shifted.shift[middle] - shifted.shift[middle][0] * Vec<Dim>::UnitX()).norm(), 10.0 * single_eps * dt);
  }
}

TYPED_TEST(ShiftingTest, LeavesTheSurfaceAlone) {
  constexpr int Dim = TypeParam::value;
  for (const ShiftingKind kind : kinds) {
    const Shifted<Dim> shifted(kind, 1e6 * dx, jittered_cube<Dim>(cube_count<Dim>, dx, 0.3), 1.0, true);
    for (const Vec<Dim>& shift : shifted.shift) EXPECT_EQ(shift, Vec<Dim>::Zero());
  }
}

// The third row is inside, but the surface cuts its support; from the fifth row on all neighbours are inside.
TYPED_TEST(ShiftingTest, IsWholeWhereAllNeighboursAreInside) {
  constexpr int Dim = TypeParam::value;
  const std::vector<Vec<Dim>> points = jittered_cube<Dim>(13, dx, 0.1);
  const auto row = [&](std::size_t i) { return std::lround(6.0 - points[i][Dim - 1] / dx); };  // 0 is the top row
  std::vector<double> interior(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) interior[i] = row(i) < 2 ? 0.0 : 1.0;
  const Shifted<Dim> shifted(ShiftingKind::lind, 1e6 * dx, points, 1.0, interior);
  const Shifted<Dim> whole(ShiftingKind::lind, 1e6 * dx, points, 1.0, false);
  int third_row = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].template head<Dim - 1>().cwiseAbs().maxCoeff() > 3.0 * dx) continue;
    if (row(i) == 2) {
      EXPECT_LT(shifted.shift[i].norm(), 0.3 * whole.shift[i].norm());
      ++third_row;
    } else if (row(i) >= 5) {
      EXPECT_EQ(shifted.shift[i], whole.shift[i]);
    }
  }
  EXPECT_GT(third_row, 0);
}

TYPED_TEST(ShiftingTest, BoundsItselfSmoothly) {
  constexpr int Dim = TypeParam::value;
  for (const ShiftingKind kind : kinds) {
    const auto points = jittered_cube<Dim>(cube_count<Dim>, dx, 0.3);
    const Shifted<Dim> unbounded(kind, 1e12 * dx, points, 1.0, false);
    double longest = 0.0;
    for (const Vec<Dim>& shift : unbounded.shift) longest = std::max(longest, shift.norm());
    ASSERT_GT(longest, 0.0);
    for (const double cap : {0.01 * longest, 0.5 * longest, 100.0 * longest}) {
      const Shifted<Dim> bounded(kind, cap, points, 1.0, false);
      const auto is_beyond = [&](const Vec<Dim>& shift) { return shift.norm() / cap > 1.0; };
      EXPECT_EQ(bounded.beyond_bound, std::count_if(unbounded.shift.begin(), unbounded.shift.end(), is_beyond));
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double length = unbounded.shift[i].norm();
        EXPECT_LE((bounded.shift[i] - unbounded.shift[i] / std::hypot(1.0, length / cap)).norm(), 16.0 * eps * length);
        EXPECT_LE(bounded.shift[i].norm(), cap * (1.0 + 8.0 * eps));
        // The reduction by the bound is of third order: (1 + q^2)^-1/2 >= 1 - q^2/2.
        EXPECT_LE((bounded.shift[i] - unbounded.shift[i]).norm(),
                  length * (0.5 * length * length / (cap * cap) + 16.0 * eps));
      }
    }
  }
}

TYPED_TEST(ShiftingTest, NothingForWallsLoneParticlesAndWaterAtRest) {
  constexpr int Dim = TypeParam::value;
  const Vec<Dim> zero = Vec<Dim>::Zero();
  for (const ShiftingKind kind : kinds) {
    const auto points = jittered_cube<Dim>(cube_count<Dim>, dx, 0.3);
    EXPECT_EQ((Shifted<Dim>(kind, dx, points, 1.0, false).shift[0]), zero);
    for (const Vec<Dim>& shift : Shifted<Dim>(kind, dx, points, 0.0, false).shift) EXPECT_EQ(shift, zero);
    // A wall and two lone particles; then an isolated pair, whose only direction is its normal.
    const std::vector<Vec<Dim>> lone{Vec<Dim>::Constant(9.0), zero, Vec<Dim>::Constant(-9.0)};
    for (const Vec<Dim>& shift : Shifted<Dim>(kind, dx, lone, 1.0, false).shift) EXPECT_EQ(shift, zero);
    const std::vector<Vec<Dim>> pair{Vec<Dim>::Constant(9.0), zero, 0.5 * dx * Vec<Dim>::UnitY()};
    for (const Vec<Dim>& shift : Shifted<Dim>(kind, dx, pair, 1.0, true).shift) {
      EXPECT_LT(shift.norm(), 100.0 * eps * dt);
    }
  }
}

}  // namespace shifting_test
}  // namespace tailwater
