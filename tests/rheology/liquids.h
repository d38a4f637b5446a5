// Flows of the tests of thick liquids.
#pragma once

#include "schemes/cases.h"
#include "support/liquids.h"

namespace tailwater {

/// A layer of depth 1 m and density 1000 kg/m^3 on a bed at rest along x, periodic, which `gravity` [m/s^2] drives and
/// holds down.
inline CaseSpec layer_case(const LiquidTable& liquid, double spacing, Coordinates gravity) {
  CaseSpec spec;
  spec.particles.spacing = spacing;
  spec.particles.jitter = 0.1;
  spec.physics.gravity = std::move(gravity);
  spec.domain.periodic_x = {0.0, 12.0 * spacing};
  FluidTable layer;
  layer.min = {0.0, 0.0};
  layer.max = {12.0 * spacing, 1.0};
  spec.fluid = {layer};
  WallTable bed;
  bed.points = {{0.0, 0.0}, {12.0 * spacing, 0.0}};
  bed.slip = Slip::no_slip;
  bed.friction = 1.0;
  spec.walls = {bed};
  fill_with(spec, liquid);
  return spec;
}

/// A layer between two plates, of which the upper one moves along x by `displacement`.
inline CaseSpec channel_case(const LiquidTable& liquid, double spacing, double force, const Varying& displacement) {
  CaseSpec spec = layer_case(liquid, spacing, {force, 0.0});
  WallTable lid = spec.walls[0];
  lid.points = {{12.0 * spacing, 1.0}, {0.0, 1.0}};
  lid.displacement = {displacement, 0.0};
  spec.walls.push_back(lid);
  return spec;
}

/// rms of u(y) - exact(y) over the largest of exact, for 0 < y < 1.
inline double profile_error(const Flow<2>& flow, auto&& exact) {
  const Particles<2>& particles = flow.state.particles;
  double squares = 0.0;
  double count = 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    const double u = exact(particles.position[i][1]);
    squares += std::pow(particles.velocity[i][0] - u, 2);
    count += 1.0;
    largest = std::max(largest, std::abs(u));
  }
  return std::sqrt(squares / count) / largest;
}

inline double largest_horizontal_speed(const Flow<2>& flow) {
  const Particles<2>& particles = flow.state.particles;
  double largest = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (particles.is_fluid(i)) largest = std::max(largest, std::abs(particles.velocity[i][0]));
  }
  return largest;
}

}  // namespace tailwater
