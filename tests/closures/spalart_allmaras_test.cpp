// The stress of smooth and rough walls, and the eddy viscosity of their layers.
#include "closures/spalart_allmaras.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/dimensions.h"
#include "support/particle_set.h"

namespace tailwater {
namespace {

namespace sa = spalart_allmaras;

constexpr double nu = 1e-6;

TEST(WallLaw, FindsTheFrictionVelocityOfItsProfile) {
  for (const double roughness : {0.0, 1e-4, 1e-2}) {
    const WallLaw law{nu, roughness};
    for (const double u_tau : {0.002, 0.05, 1.0}) {
      const double y = 0.01;
      const double speed = u_tau / von_karman * std::log1p(y / law.zero_height(u_tau));
      EXPECT_NEAR(law.turbulent_friction_velocity(speed, [&](double) { return y; }), u_tau, 1e-7 * u_tau);
    }
  }
  EXPECT_EQ((WallLaw{nu, 0.0}.turbulent_friction_velocity(0.0, [](double) { return 0.01; })), 0.0);
  EXPECT_EQ((WallLaw{0.0, 0.0}.turbulent_friction_velocity(1.0, [](double) { return 0.01; })), 0.0);
}

TEST(WallLaw, IsThatOfNikuradse) {
  // u/u_tau = 2.5 ln(y/k_s) + 8.5 on rough walls and 2.5 ln(y u_tau/nu) + 5.5 on smooth ones, with kappa = 0.40.
  const double u_tau = 0.1;
  const double k_s = 0.002;
  const double y = 0.1;
  const auto law = [&](double roughness) {
    return std::log1p(y / WallLaw{nu, roughness}.zero_height(u_tau)) / von_karman;
  };
  EXPECT_NEAR(law(k_s), 2.5 * std::log(y / k_s) + 8.5, 0.03 * law(k_s));
  EXPECT_NEAR(law(0.0), 2.5 * std::log(y * u_tau / nu) + 5.5, 0.03 * law(0.0));
}

TEST(WallLaw, MeetsTheLaminarLawAtTheThinnestLayer) {
  const double u_tau = 0.05;
  const double y = sa::thinnest_layer * nu / u_tau;
  EXPECT_NEAR(std::log1p(y / WallLaw{nu, 0.0}.zero_height(u_tau)) / von_karman, sa::thinnest_layer,
              0.01 * sa::thinnest_layer);
}

TEST(SpalartAllmaras, TheLogarithmicLayerIsInBalance) {
  // nu~ = kappa u_tau d and S = u_tau/(kappa d): the source is kappa^2 u_tau^2 (c_b1/kappa^2 + (1 + c_b2)/sigma -
  // c_w1).
  const double u_tau = 0.05;
  for (const double d : {0.001, 0.1}) {
    const double layer = von_karman * u_tau * d;
    const double S = u_tau / (von_karman * d);
    const double production = sa::c_b1 * S * layer;
    const double diffusion = (1.0 + sa::c_b2) / sa::sigma * std::pow(von_karman * u_tau, 2);
    EXPECT_NEAR(production + diffusion, sa::destruction_rate(S, layer, d) * layer, 1e-12 * diffusion);
    EXPECT_GT(sa::destruction_rate(S, 2.0 * layer, d), 2.0 * sa::destruction_rate(S, layer, d));
  }
}

TEST(SpalartAllmaras, EddyViscosityVanishesInThinLayersAndIsNuTildeInThickOnes) {
  EXPECT_EQ(sa::eddy_viscosity(0.0, nu), 0.0);
  EXPECT_LT(sa::eddy_viscosity(nu, nu), 0.01 * nu);
  EXPECT_NEAR(sa::eddy_viscosity(1000.0 * nu, nu), 1000.0 * nu, 1e-3 * nu);
}

TEST(SpalartAllmaras, TheSeedIsALayerAsThickAsTheThinnestOrAsTheRoughness) {
  const double u_tau = 0.05;
  EXPECT_NEAR(sa::thickness(sa::seed({nu, 0.0}, u_tau), u_tau), sa::thinnest_layer * nu / u_tau, 1e-15);
  EXPECT_NEAR(sa::thickness(sa::seed({0.0, 0.002}, u_tau), u_tau), 0.002, 1e-15);
}

TEST(SpalartAllmaras, ShearIsWhatRotatesAndStrains) {
  Mat<2> shear = Mat<2>::Zero();
  shear(0, 1) = 3.0;
  EXPECT_NEAR(shear_rate<2>(shear), 3.0, 1e-15);
  const Mat<2> strain = Vec<2>(2.0, -2.0).asDiagonal();
  EXPECT_EQ(shear_rate<2>(strain), 0.0);
  Mat<2> rotation = Mat<2>::Zero();
  rotation(0, 1) = -1.0;
  rotation(1, 0) = 1.0;
  EXPECT_EQ(shear_rate<2>(rotation), 0.0);
}

template <class D>
class LayerTest : public testing::Test {};
TYPED_TEST_SUITE(LayerTest, Dimensions);

TYPED_TEST(LayerTest, DiffusionOfALinearFieldIsItsClosedValueAndSpreadsIntoWaterWithout) {
  constexpr int Dim = TypeParam::value;
  const double dx = 0.1;
  std::array<int, Dim> count;
  count.fill(9);
  ParticleSet<Dim> set(fluid_at<Dim>(lattice_points<Dim>(Vec<Dim>::Constant(-4.0 * dx), count, dx), dx),
                       make_kernel<Dim>(KernelName::wendland_c2, 3.0 * dx), dx);
  std::size_t middle = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (set.position(i).norm() < set.position(middle).norm()) middle = i;
  }
  const auto diffusion_of = [&](const auto& field) {
    for (std::size_t i = 0; i < set.size(); ++i) set.particles.layer_viscosity[i] = field(set.position(i));
    return sa::diffusion<Dim>(set.pairs(), set.particles, nu, dx, middle);
  };
  // (1 + c_b2)/sigma |grad nu~|^2, as exact as the two-point Laplacian of y^2 is on the lattice.
  const double slope = 0.02;
  const double exact = (1.0 + sa::c_b2) / sa::sigma * slope * slope;
  EXPECT_NEAR(diffusion_of([&](const Vec<Dim>& x) { return 0.02 + slope * x[1]; }), exact, 0.05 * exact);
  EXPECT_NEAR(diffusion_of([](const Vec<Dim>&) { return 0.02; }), 0.0, 1e-15);
  EXPECT_GT(diffusion_of([&](const Vec<Dim>& x) { return std::max(0.0, slope * x[1]); }), 0.0);
}

}  // namespace
}  // namespace tailwater
