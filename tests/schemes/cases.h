// Cases built in code, and the loop of a run.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "base/for_each.h"
#include "case/formulation.h"
#include "pressure/stages.h"
#include "published/make_flow.h"
#include "schemes/advance.h"

namespace tailwater {

constexpr double g = 9.81;

template <class P, int Dim>
bool has_part(const Flow<Dim>& flow) {
  return std::ranges::any_of(flow.parts,
                             [](const auto& part) { return dynamic_cast<const P*>(part.get()) != nullptr; });
}

/// A case without walls, gravity and numerical viscosity.
inline CaseSpec free_case(double spacing) {
  CaseSpec spec;
  spec.particles.spacing = spacing;
  spec.physics.gravity = {0.0, 0.0};
  spec.physics.viscosity = 0.0;
  spec.study.noise_viscosity = 0.0;
  return spec;
}

/// A free case with water that fills a square of 1 m, periodic in both directions: no surface, and all particles count.
inline CaseSpec periodic_square(double spacing) {
  CaseSpec spec = free_case(spacing);
  spec.domain.periodic_x = {0.0, 1.0};
  spec.domain.periodic_y = {0.0, 1.0};
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {1.0, 1.0};
  spec.fluid = {water};
  return spec;
}

/// Water of given width and depth in a box that is open above; in 3D as broad as wide.
template <int Dim>
CaseSpec tank_case(double spacing, double width, double depth) {
  CaseSpec spec;
  spec.general.dimension = Dim;
  spec.particles.spacing = spacing;
  spec.physics.gravity = Coordinates(Dim, 0.0);
  spec.physics.gravity[Dim - 1] = -g;
  FluidTable water;
  water.min = Coordinates(Dim, 0.0);
  water.max = Coordinates(Dim, width);
  water.max[Dim - 1] = depth;
  WallTable box;
  box.shape = WallShape::box;
  box.min = water.min;
  box.max = Coordinates(Dim, width);
  box.max[Dim - 1] = 2.0 * depth;
  box.open = {Dim == 2 ? "+y" : "+z"};
  box.fluid_side = FluidSide::inside;
  spec.fluid = {water};
  spec.walls = {box};
  return spec;
}

/// Dam break of Zhou et al. (1999): 1.2 m x 0.6 m of water in a tank 3.22 m long.
inline CaseSpec zhou_case(double spacing, Integrator integrator) {
  CaseSpec spec;
  spec.particles.spacing = spacing;
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {1.2, 0.6};
  WallTable wall;
  wall.points = {{0.0, 3.0}, {0.0, 0.0}, {3.22, 0.0}, {3.22, 3.0}};
  wall.fluid_side = FluidSide::left;
  spec.fluid = {water};
  spec.walls = {wall};
  spec.scheme.integrator = integrator;
  return spec;
}

template <int Dim>
std::size_t count_fluid(const Flow<Dim>& flow) {
  return count_each(flow.state.particles.owned, [&](std::size_t i) { return flow.state.particles.is_fluid(i); });
}

/// Takes the largest allowed step; sorts particles every few steps, as a run does.
template <int Dim>
StepReport step(Flow<Dim>& flow) {
  constexpr int steps_between_sorts = 10;
  if (flow.state.step % steps_between_sorts == 0) sort_particles(flow);
  return advance(flow, next_time_step(flow));
}

}  // namespace tailwater
