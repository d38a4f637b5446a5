#include <algorithm>
#include <cmath>

#include "closures/fluid_pairs.h"
#include "schemes/verbs.h"

namespace tailwater {
namespace {

/// The force on a wall, summed over the kernel, is known to some (dx/depth)^2: 4 % at 12 rows of particles.
constexpr double wall_work_in_doubt = 0.25;

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

}  // namespace

template <int Dim>
double energy_of_rank(const Flow<Dim>& flow) {
  double energy = 0.0;
  for (std::size_t i = 0; i < flow.particles.owned; ++i) {
    if (flow.particles.is_fluid(i)) energy += flow.kinetic_energy_of(i) + flow.potential_energy_of(i);
  }
  return energy;
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

template <int Dim>
void balance_energy(Flow<Dim>& flow, StepReport& report) {
  double mass = 0.0;
  double kinetic = 0.0;
  for (std::size_t i = 0; i < flow.particles.owned; ++i) {
    if (!flow.particles.is_fluid(i)) continue;
    mass += flow.density * flow.particles.volume[i];
    kinetic += flow.kinetic_energy_of(i);
  }
  double change = energy_of_rank(flow) - flow.energy_old;
  flow.ranks.sum_each(report.density_work, report.wall_work, report.viscous_work, change, mass, kinetic);
  const double brought =
      report.wall_work + wall_work_in_doubt * std::abs(report.wall_work) + std::max(0.0, report.viscous_work);
  const double g = flow.gravity.norm();
  const double faded = g > 0.0 ? std::exp(-report.dt * std::sqrt(g / flow.length)) : 1.0;
  flow.energy_rise = std::max(0.0, faded * flow.energy_rise + change - brought);
  const double at_hand = 0.5 * mass * g * flow.length + kinetic;
  if (at_hand > 0.0) {
    flow.density_share = std::clamp(1.0 - flow.energy_rise / (flow.scheme.energy_slack * at_hand), 0.0, 1.0);
  }
  report.density_share = flow.density_share;
}

template double energy_of_rank<2>(const Flow<2>&);
template double energy_of_rank<3>(const Flow<3>&);
template double wall_work<2>(const Flow<2>&, double);
template double wall_work<3>(const Flow<3>&, double);
template double viscous_work<2>(const Flow<2>&, double);
template double viscous_work<3>(const Flow<3>&, double);
template void balance_energy<2>(Flow<2>&, StepReport&);
template void balance_energy<3>(Flow<3>&, StepReport&);

}  // namespace tailwater
