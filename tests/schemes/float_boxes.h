// Floating boxes for cases that are built in code.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "case/spec.h"

namespace tailwater {

inline BodyTable body_of(const std::string& wall, double mass, const Coordinates& centre, std::vector<double> inertia) {
  BodyTable body;
  body.name = wall;
  body.walls = {wall};
  body.mass = mass;
  body.centre = centre;
  body.inertia = std::move(inertia);
  body.free = centre.size() == 2 ? std::vector<std::string>{"x", "y", "rotation"}
                                 : std::vector<std::string>{"x", "y", "z", "rotation_x", "rotation_y", "rotation_z"};
  body.velocity = Coordinates(centre.size(), 0.0);
  return body;
}

/// Adds the body to a case that is built in code, as the reader does.
inline void add_body(CaseSpec& spec, const WallTable& hull, const BodyTable& body) {
  spec.walls.push_back(hull);
  spec.walls.back().drive = {Drive::By::body, spec.bodies.size()};
  spec.bodies.push_back(body);
}

/// A box whose centre of mass is its geometric centre.
inline void add_box(CaseSpec& spec, const Coordinates& min, const Coordinates& max, double density,
                    const std::string& name = "hull") {
  WallTable hull;
  hull.name = name;
  hull.shape = WallShape::box;
  hull.min = min;
  hull.max = max;
  hull.fluid_side = FluidSide::outside;
  double mass = density;
  Coordinates centre;
  std::vector<double> squares;
  for (std::size_t d = 0; d < min.size(); ++d) {
    mass *= max[d] - min[d];
    centre.push_back(0.5 * (min[d] + max[d]));
    squares.push_back((max[d] - min[d]) * (max[d] - min[d]) / 12.0);
  }
  const std::vector<double> inertia =
      min.size() == 2 ? std::vector<double>{mass * (squares[0] + squares[1])}
                      : std::vector<double>{mass * (squares[1] + squares[2]), mass * (squares[0] + squares[2]),
                                            mass * (squares[0] + squares[1])};
  add_body(spec, hull, body_of(name, mass, centre, inertia));
}

}  // namespace tailwater
