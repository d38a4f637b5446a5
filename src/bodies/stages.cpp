#include "bodies/stages.h"

#include <algorithm>

#include "bodies/coupling.h"
#include "bodies/forces.h"

namespace tailwater {
namespace {

template <int Dim>
bool can_move(const Flow<Dim>& flow) {
  return std::ranges::any_of(flow.setup.bodies, [](const FloatingBody<Dim>& body) { return !body.free.empty(); });
}

template <int Dim>
void carry_over(Flow<Dim>& flow, const std::vector<Twist<Dim>>& forces, double dt) {
  for (std::size_t b = 0; b < forces.size(); ++b) flow.state.motion.bodies.each[b].carried_over += dt * forces[b];
}

}  // namespace

template <int Dim>
void steer_bodies(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  for (std::size_t b = 0; b < start.body_velocity.size(); ++b) {
    BodyState<Dim>& body = flow.state.motion.bodies.each[b];
    body.velocity = start.body_velocity[b] + dt * body.acceleration;
  }
}

template <int Dim>
PressureReport solve_with_bodies(Flow<Dim>& flow, const StepStart<Dim>& start, const PosedEquation& equation, double dt,
                                 WallDrive<Dim>& drive) {
  if (!can_move(flow)) return solve(flow, equation, drive);
  BodyCoupling<Dim> coupling(flow, start, equation.fullness, dt, drive);
  const PressureReport report = solve(flow, equation, drive,
                                      RowSolver{[&](double tolerance) { return coupling.solve_roughly(tolerance); },
                                                [&](double tolerance) { return coupling.solve(tolerance); }});
  coupling.carry_over();
  return report;
}

template <int Dim>
void carry_over_second_pressure(Flow<Dim>& flow, const std::vector<double>& correction, double dt) {
  if (flow.setup.bodies.empty()) return;
  const double time = flow.state.time + dt;
  carry_over(flow, ForcesOnBodies<Dim>(flow, time).of_pressure(correction, find_covered(flow, time)), dt);
}

template <int Dim>
void carry_over_guard(Flow<Dim>& flow, double dt) {
  if (flow.setup.bodies.empty()) return;
  carry_over(flow, ForcesOnBodies<Dim>(flow, flow.state.time + dt).of_guard(), dt);
}

TAILWATER_IN_2D_AND_3D(steer_bodies);
TAILWATER_IN_2D_AND_3D(solve_with_bodies);
TAILWATER_IN_2D_AND_3D(carry_over_second_pressure);
TAILWATER_IN_2D_AND_3D(carry_over_guard);

}  // namespace tailwater
