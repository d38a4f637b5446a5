// The books of the energy, and what they leave to the density source.
#include <algorithm>
#include <cmath>

#include "closures/fluid_pairs.h"
#include "schemes/verbs.h"

namespace tailwater {
namespace {

/// Share of what walls bring that is not counted as a rise if it was more: the force on a wall, summed over the kernel,
/// is known to some (dx/depth)^2, 4 % at 12 rows of particles.
constexpr double in_doubt = 0.25;

/// [speed/L]; at which a rise is forgotten. Water at rest dissipates nothing that could pay for lifting a lattice that
/// was placed too close: it rises slowly.
constexpr double fading_rate = 1.4;

/// Work [J] of a moving wall's particle: the conservative gradient's force on each fluid neighbour, times its velocity.
template <int Dim>
double work_of_wall_particle(const Flow<Dim>& flow, std::size_t i, double dt) {
  const Particles<Dim>& particles = flow.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  const Vec<Dim> recoil = sum_over_fluid<Dim>(pairs, particles, i, [&](std::size_t j, std::size_t k) {
    return Vec<Dim>((particles.volume[j] * pairs.dW[k] * (particles.pressure[i] + particles.pressure[j])) * pairs.e[k]);
  });
  return dt * particles.volume[i] * recoil.dot(flow.walls.velocity[particles.wall_row[i]]);
}

template <int Dim>
double viscous_work(const Flow<Dim>& flow, double dt) {
  double work = 0.0;
  for (std::size_t i = 0; i < flow.particles.owned; ++i) {
    if (!flow.particles.is_fluid(i)) continue;
    const Vec<Dim>& acceleration = flow.acceleration[i];
    const Vec<Dim> way = dt * (flow.velocity_old[i] + 0.5 * dt * acceleration);
    work += flow.density * flow.particles.volume[i] * acceleration.dot(way);
  }
  return work;
}

}  // namespace

template <int Dim>
FluidSums fluid_sums_of_rank(const Flow<Dim>& flow) {
  FluidSums sums;
  for (std::size_t i = 0; i < flow.particles.owned; ++i) {
    if (!flow.particles.is_fluid(i)) continue;
    const double kinetic_energy = flow.kinetic_energy_of(i);
    sums.mass += flow.density * flow.particles.volume[i];
    sums.kinetic_energy += kinetic_energy;
    sums.energy += kinetic_energy + flow.potential_energy_of(i);
  }
  return sums;
}

template <int Dim>
double wall_work(const Flow<Dim>& flow, double dt) {
  if (flow.wall_motion.moving().empty()) return 0.0;
  double work = 0.0;
  for (std::size_t i = 0; i < flow.particles.owned; ++i) {
    if (!flow.particles.is_fluid(i) && flow.is_wet[i]) work += work_of_wall_particle(flow, i, dt);
  }
  return work;
}

template <int Dim>
void book_work(const Flow<Dim>& flow, double dt, StepReport& report) {
  report.density_work = density_source_work(flow, dt);
  report.wall_work = wall_work(flow, dt);
  report.viscous_work = viscous_work(flow, dt);
}

template <int Dim>
void balance_energy(Flow<Dim>& flow, StepReport& report) {
  FluidSums sums = fluid_sums_of_rank(flow);
  double change = sums.energy - flow.energy_old;
  flow.ranks.sum_each(report.density_work, report.wall_work, report.viscous_work, change, sums.mass,
                      sums.kinetic_energy);

  const double doubt = in_doubt * (std::abs(report.wall_work) + report.dragged());
  const double g = flow.gravity.norm();
  const double speed = g > 0.0 ? flow.time_step_rule.reference_speed : largest_speed(flow);
  const double faded = std::exp(-fading_rate * speed * report.dt / flow.length);
  flow.energy_rise = std::max(0.0, faded * flow.energy_rise + change - report.brought_by_walls() - doubt);

  const double at_hand = 0.5 * sums.mass * g * flow.length + sums.kinetic_energy;
  if (at_hand > 0.0) {
    const double left = std::max(0.0, 1.0 - flow.energy_rise / (flow.scheme.energy_slack * at_hand));
    flow.density_share = left * left;
  }
  report.density_share = flow.density_share;
}

template FluidSums fluid_sums_of_rank<2>(const Flow<2>&);
template FluidSums fluid_sums_of_rank<3>(const Flow<3>&);
template double wall_work<2>(const Flow<2>&, double);
template double wall_work<3>(const Flow<3>&, double);
template void book_work<2>(const Flow<2>&, double, StepReport&);
template void book_work<3>(const Flow<3>&, double, StepReport&);
template void balance_energy<2>(Flow<2>&, StepReport&);
template void balance_energy<3>(Flow<3>&, StepReport&);

}  // namespace tailwater
