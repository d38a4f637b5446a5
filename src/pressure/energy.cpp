// The balance of the energy, and the resulting fraction of the density source.
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "base/for_each.h"
#include "closures/fluid_pairs.h"
#include "flow/balanced_pressure.h"
#include "motion/wall_motion.h"
#include "pressure/balanced_on_walls.h"
#include "pressure/operators.h"
#include "pressure/stages.h"
#include "walls/patches.h"

namespace tailwater {
namespace {

/// Fraction of the energy from walls and open ends that does not count as a rise, because that energy is uncertain. The
/// force on a wall, summed over the kernel, has a relative error of some (dx/depth)^2, 4 % at 12 rows of particles.
constexpr double in_doubt = 0.25;

/// [speed/L]; rate at which a rise is forgotten. Water at rest dissipates no energy that could balance the lifting of a
/// lattice that was placed too close: it rises slowly.
constexpr double fading_rate = 1.4;

/// `density_of(i)` in kg/m^3.
template <int Dim, class Density>
double viscous_work(const Flow<Dim>& flow, const StepStart<Dim>& start, const Prediction<Dim>& predicted, double dt,
                    Density&& density_of) {
  const Particles<Dim>& particles = flow.state.particles;
  return sum_over(particles.owned, 0.0, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return 0.0;
    const Vec<Dim>& acceleration = predicted.acceleration[i];
    const Vec<Dim> displacement = dt * (start.velocity[i] + 0.5 * dt * acceleration);
    return density_of(i) * particles.volume[i] * acceleration.dot(displacement);
  });
}

/// A case of one liquid uses its density directly, so that the rounding does not depend on the code for several.
template <int Dim>
double viscous_work(const Flow<Dim>& flow, const StepStart<Dim>& start, const Prediction<Dim>& predicted, double dt) {
  if (flow.setup.liquids.are_several()) {
    return viscous_work(flow, start, predicted, dt, [&](std::size_t i) { return flow.density_of(i); });
  }
  return viscous_work(flow, start, predicted, dt, [&](std::size_t /*i*/) { return flow.setup.liquid.density; });
}

/// Work [J] of the pressure on the expansion of the density source: the energy for lifting water whose particles had
/// come too close.
template <int Dim>
double density_work(const Flow<Dim>& flow, const PosedEquation& equation, double dt) {
  if (equation.density_source.empty()) return 0.0;
  const Particles<Dim>& particles = flow.state.particles;
  return sum_over(particles.owned, 0.0, [&](std::size_t i) {
    if (flow.role[i] != Role::water) return 0.0;
    const double expansion = equation.density_source[i] * dt * dt / flow.setup.liquid.density;  // dt div u
    return particles.pressure[i] * particles.volume[i] * expansion;
  });
}

/// Work [J] on this rank's water by the pairs of a pressure field at moving walls for which is_counted(wall). The force
/// changes the velocity of the water from that of the last step, when walls had the velocities `from`, to that of this
/// one, so its work has the mean of both; the velocity of this step alone would bring half of m a dt more in each step
/// to water that follows the accelerations of its walls.
template <int Dim, class IsCounted>
double wall_work(const Flow<Dim>& flow, std::span<const Vec<Dim>> from, const std::vector<double>& pressure, double dt,
                 IsCounted&& is_counted) {
  const Particles<Dim>& particles = flow.state.particles;
  const std::vector<std::size_t> walls = indices_where(particles.owned, [&](std::size_t i) {
    return !particles.is_fluid(i) && flow.surroundings.is_wet[i] &&
           is_counted(flow.walls.particles.wall[particles.wall_row[i]]);
  });
  const std::vector<Vec<Dim>> pushes = reactions_of_walls<Dim>(flow, walls, pressure);
  return sum_over(walls.size(), 0.0, [&](std::size_t n) {
    const std::size_t i = walls[n];
    const std::int32_t row = particles.wall_row[i];
    const Vec<Dim> before = entry_of<Dim>(from, row);
    const Vec<Dim> mean = 0.5 * (before + entry_of<Dim>(flow.state.wall_velocity, row));
    return dt * particles.volume[i] * pushes[n].dot(mean);
  });
}

/// Work [J] on this rank's water by which the balanced pressure on walls that move on a path exceeds that of its pairs.
template <int Dim>
double excess_work_of_balanced(const Flow<Dim>& flow, std::span<const Vec<Dim>> from, double dt) {
  const std::vector<double>& balanced = flow.walls.forces.balanced;
  if (balanced.empty()) return 0.0;
  const Boundary<Dim>& boundary = flow.walls.boundary;
  std::vector<bool> has_path = walls_with_balanced(flow);
  for (const auto& moving : flow.setup.wall_motion->moving()) {
    if (moving.body >= 0) has_path[moving.wall] = false;
  }
  const std::vector<double> q = balanced_pressure(flow, flow.state.particles.pressure);
  double work = -wall_work(flow, from, q, dt, [&](int wall) { return has_path[wall]; });
  if (!flow.setup.ranks.is_root()) return work;
  for (std::size_t k = 0; k < balanced.size(); ++k) {
    const WallPatch<Dim>& patch = flow.walls.patches->all()[k];
    const WallFace<Dim>& face = boundary.faces[patch.face];
    if (balanced[k] == 0.0 || !has_path[face.wall]) continue;
    const std::int32_t row = flow.walls.patches->row(k);
    const Vec<Dim> mean = 0.5 * (entry_of<Dim>(from, row) + entry_of<Dim>(flow.state.wall_velocity, row));
    const double area = patch.measure * flow.walls.patches->wetted().share(static_cast<std::int32_t>(k));
    work += dt * balanced[k] * area * face.normal.dot(mean);
  }
  return work;
}

/// Power [W] of the weight of this rank's water at the velocities where the step starts.
template <int Dim>
double fall_power_at(const Flow<Dim>& flow, const StepStart<Dim>& start) {
  const Vec<Dim> g = flow.setup.gravity_across();
  return sum_over(flow.state.particles.owned, 0.0, [&](std::size_t i) {
    if (!flow.state.particles.is_fluid(i)) return 0.0;
    return flow.density_of(i) * flow.water_volume_of(i) * g.dot(start.velocity[i]);
  });
}

/// Work [J] of gravity along periodic directions on this rank's water since `start`.
template <int Dim>
double slope_work(const Flow<Dim>& flow, const StepStart<Dim>& start) {
  const Vec<Dim> along = flow.setup.gravity - flow.setup.gravity_across();
  if (along.isZero(0.0)) return 0.0;
  const Particles<Dim>& particles = flow.state.particles;
  return sum_over(particles.owned, 0.0, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return 0.0;
    return flow.density_of(i) * flow.water_volume_of(i) * along.dot(particles.position[i] - start.position[i]);
  });
}

}  // namespace

template <int Dim>
Works work_of_boundaries(const Flow<Dim>& flow, std::span<const Vec<Dim>> from, double dt) {
  Works works;
  std::vector<double> on_walls;
  if (!flow.setup.wall_motion->moving().empty()) {
    on_walls = flow.state.particles.pressure;
    for (const auto& part : flow.parts) part->subtract_from_walls(flow, on_walls);
    works.walls = wall_work(flow, from, on_walls, dt, [](int /*wall*/) { return true; }) +
                  excess_work_of_balanced(flow, from, dt);
  }
  for (const auto& part : flow.parts) part->add_work(flow, on_walls, dt, works);
  return works;
}

template <int Dim>
Works work_of_step(const Flow<Dim>& flow, const StepStart<Dim>& start, const Prediction<Dim>& predicted,
                   const PosedEquation& equation, double dt) {
  Works works = work_of_boundaries<Dim>(flow, start.wall_velocity, dt);
  works.density = density_work(flow, equation, dt);
  works.viscous += viscous_work(flow, start, predicted, dt);
  return works;
}

template <int Dim>
void balance_energy(Flow<Dim>& flow, const StepStart<Dim>& start, StepReport& report) {
  const Setup<Dim>& setup = flow.setup;
  State<Dim>& state = flow.state;
  FluidSums sums = fluid_sums_of_rank(flow);
  double change = sums.energy - start.energy;
  Works& work = report.work;
  work.slope = slope_work(flow, start);
  setup.ranks.sum_each(work.density, work.walls, work.ends, work.viscous, work.air, work.slope, change, sums.mass,
                       sums.kinetic_energy, sums.fall_power);
  const bool is_midway = !setup.formulation.moves_with_mean_velocity && !setup.formulation.has_second_projection;
  if (is_midway) report.fallen = 0.5 * report.dt * sums.fall_power;
  if (is_midway && state.step == 0) {
    report.fallen_at_start = 0.5 * report.dt * fall_power_at(flow, start);
    setup.ranks.sum_each(report.fallen_at_start);
  }

  const double doubt = in_doubt * (std::abs(work.walls) + std::abs(work.ends) + report.dragged());
  const double g = setup.gravity.norm();
  const double speed = g > 0.0 ? setup.time_step_rule.reference_speed : largest_speed(flow);
  const double faded = std::exp(-fading_rate * speed * report.dt / setup.length);
  state.last_step.energy_rise = std::max(0.0, faded * state.last_step.energy_rise + change - report.brought() - doubt);

  const double at_hand = energy_scale(setup, sums.mass, sums.kinetic_energy);
  if (at_hand > 0.0) {
    const double left = std::max(0.0, 1.0 - state.last_step.energy_rise / (setup.formulation.energy_slack * at_hand));
    state.last_step.density_share = left * left;
  }
  report.density_share = state.last_step.density_share;
}

TAILWATER_IN_2D_AND_3D(work_of_boundaries);
TAILWATER_IN_2D_AND_3D(work_of_step);
TAILWATER_IN_2D_AND_3D(balance_energy);

}  // namespace tailwater
