// Places on walls that are screens themselves: plates, and walls that end in the water.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/meshes.h"
#include "probes/pressure_map.h"
#include "probes/tank.h"
#include "probes/wall_pressure.h"
#include "probes/water_column.h"

namespace tailwater {
namespace {

using testing_cases::MeshFolder;

/// A wall without a tank, water in front of it up to `level` [m], and particles of the wall behind it.
template <int Dim>
struct WaterOnWall {
  static constexpr double dx = Tank<Dim>::dx;
  Tank<Dim> tank = Tank<Dim>::filled(0.0);
  std::vector<int> felt;

  WaterOnWall(const WallTable& wall, double level, const Vec<Dim>& low, const Vec<Dim>& high) {
    tank.spec.walls = {wall};
    tank.boundary = make_boundary<Dim>(tank.spec);
    tank.particles = {};
    const Vec<Dim> counts = ((high - low) / dx).each([](double steps) { return std::round(steps); });
    const int planes = Dim == 3 ? static_cast<int>(counts[1]) : 1;
    for (int i = 0; i < static_cast<int>(counts[0]); ++i) {
      for (int j = 0; j < planes; ++j) {
        for (int k = 0; k < static_cast<int>(counts[Dim - 1]); ++k) {
          Vec<Dim> x = low + Vec<Dim>::Constant(0.5 * dx);
          x[0] += i * dx;
          if (Dim == 3) x[1] += j * dx;
          x[Dim - 1] += k * dx;
          const NearestWall<Dim> nearest = tank.boundary.nearest(x, 10.0);
          const bool is_water = tank.boundary.faces[nearest.face].height(x) > 0.0;
          if (is_water && x[Dim - 1] > level) continue;
          tank.add(x, is_water, Tank<Dim>::rho * Tank<Dim>::g * (level - x[Dim - 1]));
          const bool is_beside_end = !is_water && tank.boundary.is_beside_free_end(0, x);
          felt.push_back(is_water ? felt_past_screens : is_beside_end ? 0 : felt_past_plates);
        }
      }
    }
    tank.locate();
  }

  ProbeContext<Dim> context() const {
    ProbeContext<Dim> context = tank.context();
    context.felt_through = felt;
    return context;
  }
  Row depth(const Coordinates& at) const {
    return depth_reading<Dim>(probe_at(ProbeType::depth, at), tank.spec, tank.boundary).take(context()).at(0);
  }
  double pressure(const Coordinates& at) const {
    return wall_pressure_reading<Dim>(probe_at(ProbeType::wall_pressure, at), tank.spec, tank.boundary)
        .take(context())
        .at(0)[0];
  }
};

/// In 2D a straight bed of which both ends are free. The bound on depths is that of water_column_test.cpp.
TEST(PlaceOnScreen, SeesTheWaterOnALineThatEndsInTheWater) {
  constexpr double level = 0.5, length = 0.6;
  for (const double slope : {0.0, 0.1, 0.25, 1.0 / 3.0, 0.5}) {
    const WallTable bed = testing_cases::polyline({{0.0, 0.0}, {length, slope * length}});
    const WaterOnWall<2> water(bed, level, {0.0, -0.25}, {length, level});
    ASSERT_FALSE(water.tank.boundary.screens.empty());
    for (const double x : {0.17, 0.2, 0.23, 0.3, 0.31, 0.37, 0.4, 0.43}) {
      const double z = slope * x;
      EXPECT_NEAR(water.depth({x, z})[0], level - z, 0.05 * Tank<2>::dx) << slope << ", " << x;
      EXPECT_NEAR(water.pressure({x, z}), 9810.0 * (level - z), 1e-6) << slope << ", " << x;
    }
  }
}

/// A valley of four triangles whose whole rim is free.
TEST(PlaceOnScreen, SeesTheWaterOnAMeshThatEndsInTheWater) {
  constexpr double level = 0.3;
  const MeshFolder folder;
  for (const double slope : {0.25, 0.5, 0.7, 1.0}) {
    TriangleMesh mesh;
    for (const double y : {-0.6, 0.0, 0.6}) {
      for (const double x : {-0.1, 0.7}) mesh.points.emplace_back(x, y, slope * std::abs(y));
    }
    testing_cases::add_quad(mesh, 0, 1, 3, 2);
    testing_cases::add_quad(mesh, 2, 3, 5, 4);
    WallTable bed;
    bed.shape = WallShape::mesh;
    bed.fluid_side = FluidSide::above;
    bed.file = folder.write("valley.stl", testing_cases::ascii_stl(mesh));
    const WaterOnWall<3> water(bed, level, {-0.1, -0.6, -0.25}, {0.7, 0.6, level});
    ASSERT_FALSE(water.tank.boundary.screens.empty());
    for (const double x : {0.2, 0.27, 0.3, 0.4}) {
      for (const double y : {-0.1, 0.0, 0.03, 0.06, 0.15}) {
        const double z = slope * std::abs(y);
        EXPECT_NEAR(water.depth({x, y, z})[0], level - z, 0.1 * Tank<3>::dx) << slope << ", " << x << ", " << y;
        EXPECT_NEAR(water.pressure({x, y, z}), 9810.0 * (level - z), 1e-6) << slope << ", " << x << ", " << y;
      }
    }
  }
}

/// Water on one side of a level plate: the probe reads it for either order of the plate's corners.
TEST(PlaceOnScreen, SeesTheWaterOnOneSideOfAPlate) {
  using T = Tank<2>;
  constexpr double height = 0.3, level = 0.8;
  for (const bool is_reversed : {false, true}) {
    for (const bool is_above : {false, true}) {
      T tank(level, [&](const Vec<2>& x) { return x[1] < level && (x[1] > height) == is_above; });
      WallTable plate;
      plate.shape = WallShape::plate;
      plate.points = {{0.0, height}, {T::width, height}};
      if (is_reversed) std::ranges::reverse(plate.points);
      tank.spec.walls.push_back(plate);
      tank.boundary = make_boundary<2>(tank.spec);
      std::vector<int> felt;
      for (std::size_t i = 0; i < tank.particles.size(); ++i) {
        felt.push_back(tank.particles.is_fluid(i) ? felt_past_screens : felt_past_plates);
      }
      for (double x = 0.5 * T::dx; x < T::width; x += T::dx) {
        for (int row = -3; row < 3; ++row) {
          tank.add({x, height + (row + 0.5) * T::dx}, false, 0.0);
          felt.push_back(1);
        }
      }
      tank.locate();
      ProbeContext<2> context = tank.context();
      context.felt_through = felt;
      const Row depth =
          depth_reading<2>(probe_at(ProbeType::depth, {0.5, 0.0}), tank.spec, tank.boundary).take(context).at(0);
      EXPECT_NEAR(depth[0], is_above ? level - height : height, 0.05 * T::dx) << is_reversed << is_above;
      ProbeTable map;
      map.type = ProbeType::pressure_map;
      map.walls = {tank.boundary.walls[1].name};
      const Row row = pressure_map_reading<2>(map, tank.spec, tank.boundary).take(context).at(0);
      EXPECT_NEAR(row.back(), 0.5, 1e-9) << is_reversed << is_above;  // wet fraction
      EXPECT_NEAR(row[3], 0.5 * T::rho * T::g * (level - height), 2e-6 * T::rho * T::g) << is_reversed << is_above;
    }
  }
}

}  // namespace
}  // namespace tailwater
