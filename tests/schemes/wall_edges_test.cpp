// Edges of walls that end in the water: free ends of lines, edges of plates, rims of open meshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "geometry/meshes.h"
#include "schemes/cases.h"

namespace tailwater {
namespace wall_edges_test {

using testing_cases::box_fluid;
using testing_cases::box_wall;
using testing_cases::empty_case;
using testing_cases::polyline;

WallTable plate(std::vector<Coordinates> points) {
  WallTable wall = polyline(std::move(points));
  wall.shape = WallShape::plate;
  return wall;
}

// A pair that appears at once beside the edge would bring energy again and again: 0.1 to 0.35 m/s for ever, and the
// energy 0.3 % above its start. Beside a solid step of the same height the water comes to rest at 0.004 to 0.008 m/s.
TEST(StillWaterBesideAPlate, ComesToRest) {
  constexpr double dx = 0.02;
  CaseSpec spec = empty_case(dx);
  spec.particles.jitter = 0.2;
  spec.walls = {polyline({{0.0, 0.4}, {0.0, 0.0}, {0.48, 0.0}, {0.48, 0.4}}), plate({{0.24, 0.0}, {0.24, 0.12}})};
  spec.fluid = {box_fluid({0.0, 0.0}, {0.48, 0.24})};
  Flow<2> flow = make_flow<2>(spec);
  const double start = measure(flow).energy();
  double max_energy = start;
  double max_speed = 0.0;
  while (flow.state.time < 6.0) {
    step(flow);
    const auto measures = measure(flow);
    max_energy = std::max(max_energy, measures.energy());
    if (flow.state.time > 5.0) max_speed = std::max(max_speed, measures.largest_speed);
  }
  EXPECT_LT(max_speed, 0.02);
  EXPECT_LT(max_energy / start - 1.0, 2.5e-3);  // 2.0, 2.2, 1.9e-3 with the seeds 1 to 3, with any plate or none
}

/// The largest speed over sqrt(gH) of still water in a tank with these plates. The water is H = 0.4 m deep.
double still_speed(const std::vector<WallTable>& plates) {
  CaseSpec spec = empty_case(0.04);
  spec.walls = {polyline({{0.0, 0.6}, {0.0, 0.0}, {0.96, 0.0}, {0.96, 0.6}})};
  spec.walls.insert(spec.walls.end(), plates.begin(), plates.end());
  spec.fluid = {box_fluid({0.0, 0.0}, {0.96, 0.4})};
  Flow<2> flow = make_flow<2>(spec);
  double max_speed = 0.0;
  while (flow.state.time < 0.6) {
    step(flow);
    max_speed = std::max(max_speed, measure(flow).largest_speed);
  }
  return max_speed / std::sqrt(g * 0.4);
}

// Where a line passed two plates, the particles of neither replaced the water behind them: 0.15 to 0.21. A tank
// without plates has 0.026.
TEST(StillWaterBesidePlatesThatMeet, StaysAtRest) {
  const WallTable upright = plate({{0.48, 0.0}, {0.48, 0.2}});
  EXPECT_LT(still_speed({upright, plate({{0.48, 0.2}, {0.68, 0.2}})}), 0.04) << "corner";
  EXPECT_LT(still_speed({upright, plate({{0.28, 0.2}, {0.68, 0.2}})}), 0.04) << "end of one plate at another";
  EXPECT_LT(still_speed({plate({{0.48, 0.0}, {0.48, 0.28}}), plate({{0.28, 0.16}, {0.68, 0.16}})}), 0.04) << "crossing";
}

// At the border between two periods the image of another plate follows, at an angle. The speed was 0.75 while lines
// past two plates had no particles and the plates had none beyond the border. The cut cells cause 0.07 at the start.
TEST(StillWaterBesidePlatesThatMeet, StaysAtRestAcrossAPeriod) {
  CaseSpec spec = empty_case(0.04);
  spec.domain.periodic_x = {0.0, 0.8};
  spec.walls = {polyline({{0.0, 0.0}, {0.8, 0.0}}), plate({{0.0, 0.1}, {0.4, 0.3}}), plate({{0.4, 0.3}, {0.8, 0.1}})};
  for (const double seed : {0.06, 0.38}) {
    FluidTable water;
    water.shape = BlockShape::fill;
    water.seed = {0.4, seed};
    water.level = 0.4;
    spec.fluid.push_back(water);
  }
  Flow<2> flow = make_flow<2>(spec);
  double max_speed = 0.0;
  while (flow.state.time < 0.4) {
    step(flow);
    max_speed = std::max(max_speed, measure(flow).largest_speed);
  }
  EXPECT_LT(max_speed / std::sqrt(g * 0.4), 0.12);
}

// Water used to escape at 2 to 3 m/s where a block goes through its bed, or into another block, by less than a spacing.
TEST(StillWaterBesideCrossingBlocks, StaysCalm) {
  constexpr double dx = 0.02;
  for (const double overlap : {0.05, 0.3, 1.0}) {
    const double d = overlap * dx;
    CaseSpec spec = empty_case(dx);
    spec.walls = {polyline({{0.0, 0.4}, {0.0, 0.0}, {0.8, 0.0}, {0.8, 0.4}}),
                  box_wall({0.2, -d}, {0.4, 0.12}, {}, FluidSide::outside),
                  box_wall({0.4 - d, -d}, {0.6, 0.06}, {}, FluidSide::outside)};
    spec.fluid = {box_fluid({0.0, 0.0}, {0.8, 0.2})};
    Flow<2> flow = make_flow<2>(spec);
    const std::size_t count = flow.state.particles.size();
    std::size_t stopped = 0;
    while (flow.state.time < 0.6) {
      stopped += step(flow).interventions.stopped_at_walls;
      EXPECT_LT(measure(flow).largest_speed, 0.07) << overlap << " dx";  // 5 % of sqrt(gH)
    }
    EXPECT_EQ(flow.state.particles.size(), count);
    EXPECT_EQ(stopped, 0U) << overlap;
  }
}

// The floor of a box that is open at its ends used to push up the water beyond them, so that the energy rose by 2.4 %
// within 0.4 s. A floor of triangles has screens at its ends, and the one of a box has the same.
TEST(FloorOfABoxThatEnds, ActsLikeAFloorOfTriangles) {
  constexpr double dx = 0.03;
  constexpr double length = 0.45;
  constexpr double width = 6.0 * dx;
  const testing_cases::MeshFolder folder;
  TriangleMesh floor;
  floor.points = {{0.0, 0.0, 0.0}, {length, 0.0, 0.0}, {length, width, 0.0}, {0.0, width, 0.0}};
  testing_cases::add_quad(floor, 0, 1, 2, 3);
  CaseSpec spec = empty_case(dx, 3);
  spec.domain.periodic_y = {0.0, width};
  spec.fluid = {box_fluid({0.0, 0.0, 0.0}, {length, width, 0.15})};
  spec.fluid[0].velocity = {1.5, 0.0, 0.0};
  std::vector<double> energies;
  for (const WallTable& wall : {box_wall({0.0, 0.0, 0.0}, {length, width, 0.3}, {"-x", "+x", "-y", "+y", "+z"}),
                                folder.wall(floor, FluidSide::above)}) {
    spec.walls = {wall};
    Flow<3> flow = make_flow<3>(spec);
    while (flow.state.time < 0.2) step(flow);
    energies.push_back(measure(flow).energy());
  }
  EXPECT_NEAR(energies[0], energies[1], 1e-6 * energies[1]);
}

enum class Drawn { as_line, as_plate, as_box };

/// A basin with a slot of 6 dx in the middle of its floor, below which there is nothing.
CaseSpec slot_case(Drawn drawn) {
  constexpr double dx = 0.0025;
  constexpr double half_slot = 3.0 * dx;
  constexpr double half_width = 24.0 * dx;
  constexpr double depth = 20.0 * dx;
  constexpr double top = 30.0 * dx;
  CaseSpec spec = empty_case(dx);
  spec.fluid = {box_fluid({-half_width, 0.0}, {half_width, depth})};
  for (const double side : {-1.0, 1.0}) {
    const Coordinates rim{side * half_width, top};
    const Coordinates corner{side * half_width, 0.0};
    const Coordinates lip{side * half_slot, 0.0};
    const auto wall = [&](std::vector<Coordinates> points) {
      return polyline(std::move(points), side < 0.0 ? FluidSide::left : FluidSide::right);
    };
    if (drawn == Drawn::as_line) {
      spec.walls.push_back(wall({rim, corner, lip}));
    } else if (drawn == Drawn::as_box) {
      spec.walls.push_back(wall({rim, corner, lip, {side * half_slot, -4.0 * dx}, {side * half_width, -4.0 * dx}}));
    } else {
      spec.walls.push_back(wall({rim, {side * half_width, -8.0 * dx}}));
      spec.walls.push_back(plate({corner, lip}));
    }
  }
  return spec;
}

/// Q/(d sqrt(2 g h)) of the slot once the jet is there, with the water above the floor as h.
double discharge_coefficient(const CaseSpec& spec) {
  Flow<2> flow = make_flow<2>(spec);
  const auto volume_above = [&] {
    return sum_over(flow.state.particles.owned, 0.0, [&](std::size_t i) {
      const bool counts = flow.state.particles.is_fluid(i) && flow.state.particles.position[i][1] > 0.0;
      return counts ? flow.state.particles.volume[i] : 0.0;
    });
  };
  const auto run_to = [&](double end) {
    while (flow.state.time < end) step(flow);
    return volume_above();
  };
  const double before = run_to(0.06);
  const double from = flow.state.time;
  const double after = run_to(0.16);
  const double width = 48.0 * spec.particles.spacing;
  const double depth = 0.5 * (before + after) / width;
  return (before - after) / (flow.state.time - from) / (6.0 * spec.particles.spacing * std::sqrt(2.0 * g * depth));
}

// Contraction 0.61 of a jet from a slot much narrower than the basin (Kirchhoff), a little more from one of an eighth
// of its width. Water beyond the free end of a line used to count as behind the wall: 0.20.
TEST(SlotInAFloor, PassesTheSameDrawnAsLineAndAsPlateAndLittleLessAsBox) {
  const double line = discharge_coefficient(slot_case(Drawn::as_line));
  const double plate = discharge_coefficient(slot_case(Drawn::as_plate));
  EXPECT_NEAR(line, 0.61, 0.03 * 0.61);
  EXPECT_NEAR(plate, 0.61, 0.03 * 0.61);
  // The corners of a wall with thickness narrow the slot by 0.14 dx each. Its underside ends in the air below the
  // basin, which must not open its top.
  const double box = discharge_coefficient(slot_case(Drawn::as_box));
  EXPECT_GT(box, 0.88 * 0.61);
  EXPECT_LT(box, 1.03 * 0.61);
}

/// A floor of triangles at z = 0 from -0.5 to 0.5 with a square hole of the width `hole` in its middle; front above.
TriangleMesh floor_with_hole(double hole) {
  TriangleMesh mesh;
  for (const double half : {0.5, 0.5 * hole}) {
    for (const auto& [x, y] :
         {std::pair(-1.0, -1.0), std::pair(1.0, -1.0), std::pair(1.0, 1.0), std::pair(-1.0, 1.0)}) {
      mesh.points.emplace_back(half * x, half * y, 0.0);
    }
  }
  for (int k = 0; k < 4; ++k) testing_cases::add_quad(mesh, k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k);
  return mesh;
}

/// A floor with a hole between the walls of a tank 1 m wide that has no bottom.
CaseSpec tank_with_hole(const testing_cases::MeshFolder& folder, WallShape shape) {
  CaseSpec spec = empty_case(0.05, 3);
  spec.walls = {box_wall({-0.5, -0.5, -0.5}, {0.5, 0.5, 1.0}, {"-z", "+z"})};
  WallTable floor;
  floor.shape = shape;
  floor.file = folder.write("floor.stl", testing_cases::binary_stl(floor_with_hole(0.3)));
  spec.walls.push_back(floor);
  spec.fluid = {box_fluid({-0.5, -0.5, 0.0}, {0.5, 0.5, 0.3})};
  return spec;
}

// As a mesh with water on one side and as a sheet, the floor lets the water out through the hole with the same flow.
TEST(HoleInAFloorOfTriangles, PassesTheSameDrawnAsMeshAndAsPlate) {
  const testing_cases::MeshFolder folder;
  const auto volume_below = [&](WallShape shape) {
    Flow<3> flow = make_flow<3>(tank_with_hole(folder, shape));
    while (flow.state.time < 0.12) step(flow);
    return sum_over(flow.state.particles.owned, 0.0, [&](std::size_t i) {
      const double rows_below = -flow.state.particles.position[i][2] / flow.setup.scale.spacing;
      return flow.state.particles.is_fluid(i) ? std::clamp(rows_below, 0.0, 1.0) * flow.state.particles.volume[i] : 0.0;
    });
  };
  const double of_mesh = volume_below(WallShape::mesh);
  const double of_plate = volume_below(WallShape::plate);
  EXPECT_GT(of_plate, 0.0);
  EXPECT_NEAR(of_mesh, of_plate, 0.03 * of_plate);
}

}  // namespace wall_edges_test
}  // namespace tailwater
