// Plates: walls without thickness, with water on both sides.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/meshes.h"
#include "schemes/cases.h"
#include "support/dimensions.h"

namespace tailwater {
namespace plate_test {

constexpr double dx = 0.05;
constexpr double width = 0.8;

/// A plate across the middle of a tank, from its bed to `height`.
template <int Dim>
WallTable plate_to(double height) {
  WallTable plate;
  plate.shape = WallShape::plate;
  const double middle = 0.5 * width;
  if constexpr (Dim == 2) {
    plate.points = {{middle, 0.0}, {middle, height}};
  } else {
    plate.points = {{middle, 0.0, 0.0}, {middle, width, 0.0}, {middle, width, height}, {middle, 0.0, height}};
  }
  return plate;
}

template <class D>
class PlateTest : public testing::Test {};
TYPED_TEST_SUITE(PlateTest, Dimensions);

// The water of the other side is replaced by wall particles at the same positions. Therefore no kernel value changes,
// neither at the foot nor near the end of the plate.
TYPED_TEST(PlateTest, FillsEachSupportOnce) {
  constexpr int Dim = TypeParam::value;
  constexpr double depth = 0.5;
  CaseSpec spec = tank_case<Dim>(dx, width, depth);
  spec.walls.push_back(plate_to<Dim>(0.3));
  Flow<Dim> flow = make_flow<Dim>(spec);
  locate(flow);
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  const double support = kernel_radius(flow.setup.scale.kernel);
  std::size_t looked_at = 0;
  std::size_t apart = 0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    const Vec<Dim>& x = particles.position[i];
    if (x[Dim - 1] < depth - support) {
      EXPECT_NEAR(flow.surroundings.concentration[i], 1.0, 1e-6) << x.transpose();
      ++looked_at;
    }
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const Vec<Dim>& y = particles.position[pairs.j[k]];
      // Within dx of the edge of the plate the separation of pairs fades.
      if (!particles.is_fluid(pairs.j[k]) || std::max(x[Dim - 1], y[Dim - 1]) > 0.3 - dx) continue;
      EXPECT_EQ(x[0] < 0.5 * width, y[0] < 0.5 * width) << x.transpose() << " to " << y.transpose();
      ++apart;
    }
  }
  EXPECT_GT(looked_at, 50u);
  EXPECT_GT(apart, 500u);
}

// Bounds as for a tank without a plate (tank_test.cpp), with the larger of the two depths.
TYPED_TEST(PlateTest, HoldsWaterOfTwoDepthsApart) {
  constexpr int Dim = TypeParam::value;
  for (const Integrator integrator : {Integrator::explicit_projection, Integrator::implicit_projection}) {
    constexpr double deep = 0.4;
    constexpr double shallow = 0.2;
    CaseSpec spec = tank_case<Dim>(dx, width, deep);
    spec.scheme.integrator = integrator;
    spec.walls.push_back(plate_to<Dim>(2.0 * deep));
    spec.fluid.push_back(spec.fluid[0]);
    spec.fluid[0].max[0] = spec.fluid[1].min[0] = 0.5 * width;
    spec.fluid[1].max[Dim - 1] = shallow;
    Flow<Dim> flow = make_flow<Dim>(spec);
    const double settling = std::sqrt(g * dx / std::numbers::pi);
    for (int n = 0; n < (Dim == 2 ? 30 : 8); ++n) {
      EXPECT_EQ(step(flow).interventions.stopped_at_walls, 0u);
      ASSERT_LT(measure(flow).largest_speed, settling);
    }
    const double unit = flow.setup.liquid.density * g * dx;
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      if (!flow.state.particles.is_fluid(i)) continue;
      const Vec<Dim>& x = flow.state.particles.position[i];
      const double depth = x[0] < 0.5 * width ? deep : shallow;
      EXPECT_LT(std::abs(flow.state.particles.pressure[i] - flow.setup.liquid.density * g * (depth - x[Dim - 1])), unit)
          << x.transpose();
    }
  }
}

// A particle that would jump through the plate in one step is stopped on the side from which it came.
TYPED_TEST(PlateTest, IsNotPassed) {
  constexpr int Dim = TypeParam::value;
  for (const double side : {-1.0, 1.0}) {
    CaseSpec spec = tank_case<Dim>(dx, width, 0.1);
    spec.walls.push_back(plate_to<Dim>(0.2));
    Flow<Dim> flow = make_flow<Dim>(spec);
    locate(flow);
    Particles<Dim>& particles = flow.state.particles;
    const std::vector<Vec<Dim>> before(particles.position.begin(), particles.position.begin() + particles.owned);
    std::size_t jumping = particles.owned;
    for (std::size_t i = 0; i < particles.owned; ++i) {
      const double x = side * (particles.position[i][0] - 0.5 * width);
      if (particles.is_fluid(i) && x > 0.0 && x < dx) jumping = i;
    }
    ASSERT_LT(jumping, particles.owned);
    particles.position[jumping][0] -= side * 1.3 * dx;
    EXPECT_EQ(keep_off_walls<Dim>(flow.pairs(), flow.walls.boundary, dx, {}, before, particles, {}), 1u);
    EXPECT_GT(side * (particles.position[jumping][0] - 0.5 * width), 0.0);
    // Above the plate the path is free.
    particles.position[jumping] = before[jumping];
    particles.position[jumping][Dim - 1] = 0.35;
    const Vec<Dim> above = particles.position[jumping];
    std::vector<Vec<Dim>> from = before;
    from[jumping] = above;
    particles.position[jumping][0] -= side * 1.3 * dx;
    const Vec<Dim> over = particles.position[jumping];
    EXPECT_EQ(keep_off_walls<Dim>(flow.pairs(), flow.walls.boundary, dx, {}, from, particles, {}), 0u);
    EXPECT_EQ(particles.position[jumping], over);
  }
}

/// A sheet of triangles across the tank, from below its bed to above its rim; `x_at(y, z)` in fractions of the tank.
template <class Place>
WallTable sheet_across(const testing_cases::MeshFolder& folder, double height, Place&& x_at) {
  TriangleMesh mesh = testing_cases::sheet_mesh(8, [](double, double) { return 0.0; });
  for (Vec<3>& x : mesh.points) x = {width * x_at(x[0], x[1]), width * x[0], height * x[1]};
  WallTable plate;
  plate.shape = WallShape::plate;
  plate.file = folder.write("sheet.stl", testing_cases::binary_stl(mesh));
  return plate;
}

CaseSpec two_depths(const WallTable& plate, double deep, double shallow) {
  CaseSpec spec = tank_case<3>(dx, width, deep);
  spec.walls.push_back(plate);
  spec.fluid.push_back(spec.fluid[0]);
  spec.fluid[0].max[0] = spec.fluid[1].min[0] = 0.5 * width;
  spec.fluid[1].max[2] = shallow;
  return spec;
}

// Particles at identical positions: pressures differ only by the order of summation.
TEST(MeshPlateAtRest, HasThePressuresOfTheRectangle) {
  const testing_cases::MeshFolder folder;
  constexpr double deep = 0.4;
  const auto pressures = [&](const WallTable& plate) {
    Flow<3> flow = make_flow<3>(two_depths(plate, deep, 0.2));
    for (int n = 0; n < 3; ++n) step(flow);
    const Particles<3>& particles = flow.state.particles;
    std::vector<double> found(count_fluid(flow));
    for (std::size_t i = 0; i < particles.owned; ++i) {
      if (particles.is_fluid(i)) found[particles.id[i]] = particles.pressure[i];
    }
    return found;
  };
  const std::vector<double> expected = pressures(plate_to<3>(2.0 * deep));
  const std::vector<double> found = pressures(sheet_across(folder, 2.0 * deep, [](double, double) { return 0.5; }));
  ASSERT_EQ(found.size(), expected.size());
  // The solver stops at 1e-4 of the right-hand side (its default), which the order of the sums changes at round-off.
  const double unit = 1000.0 * g * deep;
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-4 * unit);
}

// A curved sheet that stands on the bed and in both side walls. Bounds as above.
TEST(MeshPlateAtRest, HoldsWaterApartWhenItBulges) {
  const testing_cases::MeshFolder folder;
  constexpr double depth = 0.4;
  const auto bulge = [](double y, double z) {
    return 0.5 + 0.1 * std::sin(std::numbers::pi * y) * std::sin(std::numbers::pi * z);
  };
  const auto is_before = [&](const Vec<3>& x) { return x[0] < width * bulge(x[1] / width, x[2] / (2.0 * depth)); };
  CaseSpec spec = tank_case<3>(dx, width, depth);
  spec.walls.push_back(sheet_across(folder, 2.0 * depth, bulge));
  Flow<3> flow = make_flow<3>(spec);
  std::vector<bool> was_before(count_fluid(flow));
  const Particles<3>& particles = flow.state.particles;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (particles.is_fluid(i)) was_before[particles.id[i]] = is_before(particles.position[i]);
  }
  const double settling = std::sqrt(g * dx / std::numbers::pi);
  for (int n = 0; n < 8; ++n) {
    step(flow);
    ASSERT_LT(measure(flow).largest_speed, settling);
  }
  const double unit = flow.setup.liquid.density * g * dx;
  std::size_t before = 0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    const Vec<3>& x = particles.position[i];
    EXPECT_EQ(is_before(x), was_before[particles.id[i]]) << x.transpose();
    EXPECT_LT(std::abs(particles.pressure[i] - flow.setup.liquid.density * g * (depth - x[2])), unit) << x.transpose();
    before += is_before(x) ? 1 : 0;
  }
  EXPECT_GT(before, count_fluid(flow) / 2);
}

}  // namespace plate_test
}  // namespace tailwater
