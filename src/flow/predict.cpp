#include <algorithm>

#include "base/for_each.h"
#include "flow/stages.h"
#include "neighbours/halo.h"
#include "operators/gradient_corrected.h"
#include "walls/wall_model.h"

namespace tailwater {
namespace {

/// Adds the friction of the case's walls.
template <int Dim>
void add_friction(Flow<Dim>& flow, double dt, Prediction<Dim>& predicted) {
  const Setup<Dim>& setup = flow.setup;
  const Particles<Dim>& particles = flow.state.particles;
  const bool is_slippery =
      std::ranges::all_of(flow.walls.boundary.walls, [](const WallProperties& wall) { return wall.friction == 0.0; });
  if (setup.formulation.friction_is_viscous || setup.has_implicit_viscosity || is_slippery) return;

  const std::vector<Vec<Dim>>& V = flow.state.wall_velocity;
  const std::vector<FrictionWall<Dim>> walls =
      find_friction_walls<Dim>(flow.wall_scene(), setup.friction_law, V, particles.velocity);
  std::vector<Vec<Dim>> no_slip(particles.size(), Vec<Dim>::Zero());
  flow.wall_model().find_no_slip_velocity(flow.wall_scene(), V, particles.velocity, no_slip);
  flow.halo().exchange(no_slip);
  std::vector<double> viscosity(flow.walls.forces.are_requested ? particles.size() : 0);
  add_wall_friction<Dim>(flow.wall_scene(), setup.friction_law, walls, no_slip, particles.velocity,
                         predicted.acceleration, viscosity);
  if (flow.walls.forces.are_requested) {
    flow.halo().exchange(viscosity);
    std::vector<Vec<Dim>>& force = flow.walls.forces.friction;
    find_friction_on_walls<Dim>(flow.wall_scene(), setup.friction_law, V, no_slip, particles.velocity, viscosity,
                                force);
    for_each(force.size(), [&](std::size_t i) { force[i] *= setup.liquid.density; });
  }
  for (const auto& part : flow.parts) part->follow_friction(flow, walls, predicted.velocity_gradient, dt);
}

/// Relaxes the velocity to rest, or to the targets of the parts, at the rates of the parts. The step ends with
/// (u + dt a + dt drive)/(1 + rate dt).
template <int Dim>
void damp(const Flow<Dim>& flow, const StepStart<Dim>& start, double dt, std::vector<Vec<Dim>>& acceleration) {
  std::vector<double> rate;
  std::vector<Vec<Dim>> drive;
  for (const auto& part : flow.parts) {
    part->add_damping_rate(flow, start, rate);
    part->add_relaxation(flow, start, drive);
  }
  for_each(drive.size(), [&](std::size_t i) { acceleration[i] += drive[i]; });
  for_each(rate.size(), [&](std::size_t i) {
    if (rate[i] > 0.0) acceleration[i] = (acceleration[i] - rate[i] * start.velocity[i]) / (1.0 + rate[i] * dt);
  });
}

/// grad u of fluid particles, ghosts too. In reach of a wall with friction it is that of the water alone, since dummies
/// show none of the shear, and in reach of another liquid that of the particle's own.
template <int Dim>
std::vector<Mat<Dim>> find_velocity_gradient(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  const std::vector<Float4> velocity = as_float4<Dim>(particles.velocity);
  const Interfaces& interfaces = flow.surroundings.interfaces;
  std::vector<Mat<Dim>> gradient(particles.size(), Mat<Dim>::Zero());
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    if (interfaces.are_any() && interfaces.is_near[i] != 0) {
      gradient[i] = gradient_in_liquid<Dim>(flow.pairs(), i, interfaces.density, velocity);
      return;
    }
    gradient[i] =
        particles.wall_distance[i] < kernel_radius(flow.setup.scale.kernel) * flow.pairs().relative_spacing_of(i)
            ? gradient_in_water<Dim>(flow.pairs(), i, velocity)
            : corrected_gradient<Dim>(flow.pairs(), i, unpacked<Dim>(flow.surroundings.first_moment[i]), velocity);
  });
  flow.halo().exchange(gradient);
  return gradient;
}

}  // namespace

template <int Dim>
Prediction<Dim> predict(Flow<Dim>& flow, const StepStart<Dim>& start, const WallDrive<Dim>& drive, double dt) {
  const Setup<Dim>& setup = flow.setup;
  Particles<Dim>& particles = flow.state.particles;
  for (const auto& part : flow.parts) part->begin_projection(flow, Projection::of_step, dt);
  set_wall_velocities<Dim>(flow, flow.state.wall_velocity, particles.velocity);
  if (flow.walls.forces.are_requested) flow.walls.forces.reset(particles.owned);

  Prediction<Dim> predicted;
  std::vector<Vec<Dim>>& acceleration = predicted.acceleration;
  acceleration.assign(particles.owned, Vec<Dim>::Zero());
  if (setup.formulation.needs_velocity_gradient) predicted.velocity_gradient = find_velocity_gradient(flow);
  flow.discretisation().add_viscous_force(flow, predicted.velocity_gradient, acceleration);
  add_friction(flow, dt, predicted);

  damp(flow, start, dt, acceleration);
  for (const auto& part : flow.parts) part->add_acceleration(flow, acceleration);

  const bool with_gravity = setup.formulation.gravity_in_prediction;
  const Vec<Dim> gravity = with_gravity ? setup.gravity : Vec<Dim>(Vec<Dim>::Zero());
  predicted.velocity.assign(particles.size(), Vec<Dim>::Zero());
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    if (is_claimed(flow.role[i])) acceleration[i].setZero();  // only gravity acts, and the pressure balances it
    predicted.velocity[i] = start.velocity[i] + dt * (acceleration[i] + gravity);
  });
  for (const auto& part : flow.parts) {
    part->change_prediction(flow, acceleration, dt, std::span(predicted.velocity).first(particles.owned));
  }
  set_wall_velocities<Dim>(flow, with_gravity ? drive.velocity : start.wall_velocity, predicted.velocity);
  return predicted;
}

TAILWATER_IN_2D_AND_3D(predict);

}  // namespace tailwater
