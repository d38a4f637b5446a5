#include "case/driven_walls.h"

#include "case/formulation.h"

#include <algorithm>

namespace tailwater {
namespace {

/// [dx]; so thick that the water on one side does not interact with that on the other (docs/theory/moving_walls.md).
constexpr double default_thickness = 4.0;

/// A wall of that shape that is drawn at its starting place.
WallTable wall_of(WallShape shape, std::size_t dimension) {
  WallTable wall;
  wall.shape = shape;
  wall.displacement.assign(dimension, 0.0);
  wall.pivot.assign(dimension, 0.0);
  wall.rotate = wall.translate = wall.axis = wall.pivot;
  return wall;
}

/// The box between the face from `from` to `to` and the parallel plane `thickness` behind it, on the given side.
WallTable box_behind(const Coordinates& from, const Coordinates& to, AxisDirection side, double thickness) {
  WallTable wall = wall_of(WallShape::box, from.size());
  wall.fluid_side = FluidSide::outside;
  for (std::size_t d = 0; d < from.size(); ++d) {
    wall.min.push_back(std::min(from[d], to[d]));
    wall.max.push_back(std::max(from[d], to[d]));
  }
  const auto axis = static_cast<std::size_t>(side) / 2;
  const bool is_plus = static_cast<std::size_t>(side) % 2 == 1;
  if (is_plus) {
    wall.max[axis] += thickness;
  } else {
    wall.min[axis] -= thickness;
  }
  return wall;
}

/// The face from `from` to `to` as a wall without thickness.
WallTable plate_at(const Coordinates& from, const Coordinates& to, AxisDirection side) {
  WallTable wall = wall_of(WallShape::plate, from.size());
  if (from.size() == 2) {
    wall.points = {from, to};
    return wall;
  }
  // Around the rectangle: first along one axis of its plane, then along the other.
  const auto axis = (static_cast<std::size_t>(side) / 2 + 1) % 3;
  Coordinates beside = from;
  beside[axis] = to[axis];
  Coordinates opposite = to;
  opposite[axis] = from[axis];
  wall.points = {from, beside, to, opposite};
  return wall;
}

}  // namespace

void append_driven_walls(CaseSpec& spec) {
  for (std::size_t k = 0; k < spec.gates.size(); ++k) {
    const GateTable& gate = spec.gates[k];
    const bool is_thin = gate.thickness == 0.0 && !traits_of(spec).walls.on_wall;
    const double thickness = gate.thickness > 0.0 ? gate.thickness : default_thickness * spec.particles.spacing;
    WallTable wall =
        is_thin ? plate_at(gate.from, gate.to, gate.side) : box_behind(gate.from, gate.to, gate.side, thickness);
    wall.name = gate.name;
    wall.drive = {Drive::By::gate, k};
    spec.walls.push_back(std::move(wall));
  }
  for (std::size_t k = 0; k < spec.wave_makers.size(); ++k) {
    const WaveMakerTable& maker = spec.wave_makers[k];
    WallTable wall = box_behind(maker.from, maker.to, maker.side, default_thickness * spec.particles.spacing);
    // Only the face on the water's side: the other side is dry.
    const std::size_t face = static_cast<std::size_t>(maker.side) ^ 1U;
    for (std::size_t f = 0; f < 2 * maker.from.size(); ++f) {
      if (f != face) wall.open.emplace_back(box_face_names[f]);
    }
    wall.name = maker.name;
    wall.drive = {Drive::By::wave_maker, k};
    spec.walls.push_back(std::move(wall));
  }
  for (std::size_t k = 0; k < spec.bodies.size(); ++k) {
    for (const std::string& name : spec.bodies[k].walls) {
      std::ranges::find(spec.walls, name, &WallTable::name)->drive = {Drive::By::body, k};
    }
  }
}

}  // namespace tailwater
