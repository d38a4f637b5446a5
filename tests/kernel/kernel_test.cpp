// All kernels are polynomials of degree <= 5 in r on each half of their support, so four-point Gauss-Legendre
// quadrature on each half (exact to degree 7 >= 5 + Dim - 1) integrates them without truncation: only round-off is left
// to bound.
#include "kernel/kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/dimensions.h"
#include "support/rounding.h"

namespace tailwater {
namespace {

constexpr std::array all_kernels{KernelName::wendland_c2, KernelName::cubic_spline, KernelName::farzin};
constexpr std::array radii{0.03, 1.0, 7.0};

template <class Function>
double gauss(double a, double b, Function&& function) {
  const double inner = std::sqrt(3.0 / 7.0 - 2.0 / 7.0 * std::sqrt(6.0 / 5.0));
  const double outer = std::sqrt(3.0 / 7.0 + 2.0 / 7.0 * std::sqrt(6.0 / 5.0));
  const double inner_weight = (18.0 + std::sqrt(30.0)) / 36.0;
  const double outer_weight = (18.0 - std::sqrt(30.0)) / 36.0;
  const double middle = 0.5 * (a + b);
  const double half = 0.5 * (b - a);
  return half * (inner_weight * (function(middle - inner * half) + function(middle + inner * half)) +
                 outer_weight * (function(middle - outer * half) + function(middle + outer * half)));
}

template <class D>
class KernelTest : public testing::Test {};
TYPED_TEST_SUITE(KernelTest, Dimensions);

TYPED_TEST(KernelTest, IntegratesToOne) {
  constexpr int Dim = TypeParam::value;
  for (const KernelName name : all_kernels) {
    for (const double radius : radii) {
      const Kernel<Dim> kernel = make_kernel<Dim>(name, radius);
      const auto shell = [&](double r) {
        const double sphere = Dim == 2 ? 2.0 * std::numbers::pi * r : 4.0 * std::numbers::pi * r * r;
        return sphere * kernel_value(kernel, r);
      };
      const double integral = gauss(0.0, 0.5 * radius, shell) + gauss(0.5 * radius, radius, shell);
      // A sum of 8 positive terms of some 10 roundings each.
      EXPECT_NEAR(integral, 1.0, 100.0 * eps) << static_cast<int>(name) << ", radius " << radius;
    }
  }
}

TYPED_TEST(KernelTest, SteepnessIsThatOfTheValue) {
  constexpr int Dim = TypeParam::value;
  for (const KernelName name : all_kernels) {
    for (const double radius : radii) {
      const Kernel<Dim> kernel = make_kernel<Dim>(name, radius);
      const double W_0 = kernel_value(kernel, 0.0);
      constexpr int steps = 32;  // no step straddles the knot R/2
      for (int n = 0; n < steps; ++n) {
        const double a = radius * n / steps;
        const double b = radius * (n + 1) / steps;
        // W(b) - W(a) is the integral of dW/dr, which the quadrature takes exactly.
        const double integral = gauss(a, b, [&](double r) { return -kernel_steepness(kernel, r) * r; });
        EXPECT_NEAR(kernel_value(kernel, b) - kernel_value(kernel, a), integral, 100.0 * eps * W_0)
            << static_cast<int>(name) << ", radius " << radius << ", r = " << a;
      }
    }
  }
}

TYPED_TEST(KernelTest, IsTheSameInLanes) {
  constexpr int Dim = TypeParam::value;
  for (const KernelName name : all_kernels) {
    const Kernel<Dim> kernel = make_kernel<Dim>(name, 1.0);
    const Kernel<Dim, float> in_lanes = in_single_precision(kernel);
    for (double r = 0.003; r < 1.2; r += 0.01) {
      Lanes distances = in_all_lanes(0.5);
      distances[1] = static_cast<float>(r);
      EXPECT_NEAR(kernel_value(in_lanes, distances)[1], kernel_value(kernel, r),
                  16.0 * single_eps * kernel_value(kernel, 0.0));
      EXPECT_NEAR(kernel_steepness(in_lanes, distances)[1], kernel_steepness(kernel, r),
                  64.0 * single_eps * kernel_steepness(kernel, 0.003));
    }
  }
}

TYPED_TEST(KernelTest, IsZeroFromTheSupportOn) {
  constexpr int Dim = TypeParam::value;
  for (const KernelName name : all_kernels) {
    for (const double radius : radii) {
      const Kernel<Dim> kernel = make_kernel<Dim>(name, radius);
      EXPECT_EQ(kernel_radius(kernel), radius);
      for (const double r : {radius, std::nextafter(radius, 2.0 * radius), 1.5 * radius, 1e6 * radius}) {
        EXPECT_EQ(kernel_value(kernel, r), 0.0) << static_cast<int>(name) << ", r = " << r;
        EXPECT_EQ(kernel_steepness(kernel, r), 0.0) << static_cast<int>(name) << ", r = " << r;
      }
    }
  }
}

TYPED_TEST(KernelTest, IsPositiveAndFallsInsideTheSupport) {
  constexpr int Dim = TypeParam::value;
  for (const KernelName name : all_kernels) {
    const Kernel<Dim> kernel = make_kernel<Dim>(name, 1.0);
    EXPECT_GT(kernel_value(kernel, 0.0), 0.0);
    for (int n = 1; n < 100; ++n) {
      EXPECT_GT(kernel_value(kernel, 0.01 * n), 0.0) << static_cast<int>(name);
      EXPECT_GT(kernel_steepness(kernel, 0.01 * n), 0.0) << static_cast<int>(name);
    }
  }
}

TEST(FarzinKernel, HasThePublishedNormalisation) {
  // (F8): W = 6/(pi h^2) (1 - q)^2; at r = h/2 that is 1.5/(pi h^2).
  EXPECT_NEAR(FarzinKernel<2>(0.06).value(0.03), 1.5 / (std::numbers::pi * 0.06 * 0.06), 1e-10);
}

}  // namespace
}  // namespace tailwater
