// The part of a hull's surface that is in front of the wall in which the hull stands.
#include "bodies/part_in_front.h"

#include <gtest/gtest.h>

#include <cmath>

#include "schemes/cases.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

template <class D>
class PartInFront : public testing::Test {};
TYPED_TEST_SUITE(PartInFront, Dimensions);

/// A face across the plane where the last coordinate is 0. A search for the plane ends at `factor` times its reach.
template <int Dim>
double part_of(const Boundary<Dim>& boundary, const WallPatch<Dim>& patch, double longest, double factor) {
  const Vec<Dim> centre = patch.centre(boundary);
  return part_in_front(patch, boundary, centre[Dim - 1], longest, [&](const Vec<Dim>& x, double reach) {
    return std::abs(x[Dim - 1]) < factor * reach ? x[Dim - 1] : factor * reach;
  });
}

/// The search goes no farther than the most distant piece can be. With a tenth less it misses the wall from pieces deep
/// behind it, which then count as wet.
TYPED_TEST(PartInFront, NeedsItsReachAndNoMore) {
  constexpr int Dim = TypeParam::value;
  constexpr double longest = 0.02;
  int misses = 0;
  for (const double height : {-0.45, -0.3, -0.1, 0.0, 0.1, 0.3}) {
    Boundary<Dim> boundary;
    WallFace<Dim> face;
    WallPatch<Dim> patch{0, {}, 1.0};
    for (int c = 0; c < Dim; ++c) {
      face.corners[c] = Vec<Dim>::Zero();
      face.corners[c][Dim - 1] = height + (c == 0 ? -0.5 : 0.5);
      if (Dim == 3 && c == 2) face.corners[c][0] = 0.3;
      patch.corners[c].fill(0.0);
      patch.corners[c][static_cast<std::size_t>(c)] = 1.0;
    }
    boundary.faces.push_back(face);
    const double part = part_of(boundary, patch, longest, 1.0);
    EXPECT_EQ(part, part_of(boundary, patch, longest, 10.0)) << height;
    if (part_of(boundary, patch, longest, 0.9) != part) ++misses;
    if (Dim == 2) {
      EXPECT_NEAR(part, height + 0.5, longest) << height;
    }
  }
  EXPECT_GE(misses, 2);
}

}  // namespace
}  // namespace tailwater
