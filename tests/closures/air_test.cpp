#include "closures/air.h"

#include <gtest/gtest.h>

#include <cmath>

#include "operators/laplacian_morris.h"
#include "operators/lattice.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

constexpr double spacing = 0.1;
constexpr double support = 3.0 * spacing;

template <class D>
class AirTest : public testing::Test {};
TYPED_TEST_SUITE(AirTest, Dimensions);

struct Row {
  double sum = 0.0;     ///< sum of the weights of neighbours below the surface
  double linear = 0.0;  ///< contribution of neighbours above the surface for a pressure that is linear in depth
};

/// A particle `depth` below a flat surface, with neighbours on a lattice so fine that sums approximate integrals.
template <int Dim>
Row row_below_surface(const Kernel<Dim>& kernel, double depth, double fine, double& full) {
  const int reach = static_cast<int>(std::ceil(support / fine));
  const double volume = power<Dim>(fine);
  Row row;
  full = 0.0;
  const int reach_y = Dim == 3 ? reach : 0;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach_y; y <= reach_y; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        const double height = z * fine;
        const double r = fine * std::sqrt(static_cast<double>(x * x + y * y + z * z));
        if (r == 0.0 || r >= support) continue;
        const double c = morris_laplacian_weight(volume, kernel_steepness(kernel, r), r * r, fine);
        full += c;
        if (height < depth) {
          row.sum += c;
        } else {
          row.linear += c * height;  // p_i - p_j of a pressure linear in depth
        }
      }
    }
  }
  return row;
}

// The weight times the particle's own pressure, its depth, replaces the missing half of a linear pressure. The surface
// lies midway between two lattice planes; the remaining error is that of the quadrature by lattice and table.
TYPED_TEST(AirTest, IsExactForLinearPressureUnderAFlatSurface) {
  constexpr int Dim = TypeParam::value;
  const Kernel<Dim> kernel = make_kernel<Dim>(KernelName::wendland_c2, support);
  const AirLaw air(kernel, spacing);
  const double fine = support / 30;
  for (const double planes : {5.5, 8.5, 12.5, 17.5}) {
    const double depth = planes * fine;
    double full = 0.0;
    const Row row = row_below_surface<Dim>(kernel, depth, fine, full);
    EXPECT_NEAR(air.weight(row.sum, full) * depth, row.linear, 0.03 * row.linear) << "depth " << depth;
  }
}

TYPED_TEST(AirTest, IsContinuousAndNothingInFullRows) {
  constexpr int Dim = TypeParam::value;
  const AirLaw air(make_kernel<Dim>(KernelName::wendland_c2, support), spacing);
  EXPECT_EQ(air.weight(1.0, 1.0), 0.0);
  EXPECT_EQ(air.weight(1.2, 1.0), 0.0);
  double last = 0.0;
  for (double missing = 0.001; missing < 1.0; missing += 0.001) {
    const double weight = air.weight(1.0 - missing, 1.0);
    EXPECT_GE(weight, missing);
    EXPECT_LE(weight, 2.1 * missing);  // 2 for the outermost row of a lattice
    EXPECT_GT(weight, last);
    EXPECT_LT(weight - last, 0.01);
    last = weight;
  }
}

}  // namespace
}  // namespace tailwater
