// Minimal cases, built in code.
#pragma once

#include <vector>

#include "case/spec.h"

namespace tailwater::testing_cases {

inline CaseSpec empty_case(double spacing, int dimension = 2) {
  CaseSpec spec;
  spec.general.dimension = dimension;
  spec.particles.spacing = spacing;
  spec.physics.gravity = dimension == 2 ? Coordinates{0.0, -9.81} : Coordinates{0.0, 0.0, -9.81};
  return spec;
}

inline WallTable polyline(std::vector<Coordinates> points, FluidSide side = FluidSide::left) {
  WallTable wall;
  wall.points = std::move(points);
  wall.fluid_side = side;
  return wall;
}

inline WallTable polygon(std::vector<Coordinates> points, FluidSide side) {
  WallTable wall = polyline(std::move(points), side);
  wall.shape = WallShape::polygon;
  return wall;
}

inline WallTable box_wall(Coordinates min, Coordinates max, std::vector<std::string> open = {},
                          FluidSide side = FluidSide::inside) {
  WallTable wall;
  wall.shape = WallShape::box;
  wall.min = std::move(min);
  wall.max = std::move(max);
  wall.open = std::move(open);
  wall.fluid_side = side;
  return wall;
}

inline FluidTable box_fluid(Coordinates min, Coordinates max) {
  FluidTable block;
  block.min = std::move(min);
  block.max = std::move(max);
  return block;
}

inline FluidTable polygon_fluid(std::vector<Coordinates> points) {
  FluidTable block;
  block.shape = BlockShape::polygon;
  block.points = std::move(points);
  return block;
}

inline OutletTable outlet(Coordinates from, Coordinates to) {
  OutletTable outlet;
  outlet.direction.assign(from.size(), 0.0);
  outlet.direction[0] = 1.0;
  outlet.from = std::move(from);
  outlet.to = std::move(to);
  return outlet;
}

inline InletTable inlet(Coordinates from, Coordinates to, const Varying& discharge) {
  InletTable inlet;
  inlet.direction.assign(from.size(), 0.0);
  inlet.direction[0] = 1.0;
  inlet.from = std::move(from);
  inlet.to = std::move(to);
  inlet.discharge = discharge;
  return inlet;
}

/// Channel 2.0 m long and open at its end, filled to 0.4 m over its first half, spacing 0.1 m.
inline CaseSpec open_channel() {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0.0, 0.8}, {0.0, 0.0}, {2.0, 0.0}})};
  spec.fluid = {box_fluid({0.0, 0.0}, {1.0, 0.4})};
  spec.outlets = {outlet({2.0, 0.0}, {2.0, 0.8})};
  return spec;
}

/// Open tank 1.0 x 0.6 m, filled to 0.4 m, spacing 0.1 m.
inline CaseSpec tank() {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0.0, 0.6}, {0.0, 0.0}, {1.0, 0.0}, {1.0, 0.6}})};
  spec.fluid = {box_fluid({0.0, 0.0}, {1.0, 0.4})};
  return spec;
}

}  // namespace tailwater::testing_cases
