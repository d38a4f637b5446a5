#include "base/for_each.h"
#include "flow/balanced_pressure.h"
#include "flow/stages.h"
#include "pressure/stages.h"

namespace tailwater {

template <int Dim>
void correct(Flow<Dim>& flow, const Prediction<Dim>& predicted, const WallDrive<Dim>& drive, double dt) {
  const Setup<Dim>& setup = flow.setup;
  Particles<Dim>& particles = flow.state.particles;
  std::vector<Vec<Dim>> gradient(particles.owned);
  find_pressure_gradient<Dim>(flow, particles.pressure, gradient);
  const Vec<Dim> gravity = setup.formulation.gravity_in_prediction ? Vec<Dim>(Vec<Dim>::Zero()) : setup.gravity;
  for_each(particles.owned, [&](std::size_t i) {
    if (flow.role[i] != Role::water) return;
    particles.velocity[i] = predicted.velocity[i] + dt * (gravity - gradient[i] / setup.liquid.density);
  });
  for (const auto& part : flow.parts) part->correct(flow, dt);
  flow.state.wall_velocity = drive.velocity;
  find_wall_forces(flow);
}

TAILWATER_IN_2D_AND_3D(correct);

}  // namespace tailwater
