#include "flow/measure.h"

#include <algorithm>
#include <cmath>

#include "base/for_each.h"

namespace tailwater {
namespace {

struct EnergyAndDensity {
  double kinetic_energy = 0.0;
  double potential_energy = 0.0;
  double density_error = 0.0;
  double density_error_squared = 0.0;
  double bulk = 0.0;  ///< weight of the bulk particles

  EnergyAndDensity& operator+=(const EnergyAndDensity& other) {
    kinetic_energy += other.kinetic_energy;
    potential_energy += other.potential_energy;
    density_error += other.density_error;
    density_error_squared += other.density_error_squared;
    bulk += other.bulk;
    return *this;
  }
};

/// Whether particle i is in the bulk: inside the water, solved for or in the buffer of an open end. Before `locate`
/// none is.
template <int Dim>
bool is_bulk(const Flow<Dim>& flow, std::size_t i) {
  return i < flow.surroundings.interior.size() && flow.state.particles.is_fluid(i) && flow.role[i] != Role::stagnant &&
         flow.surroundings.interior[i] > 0.5;
}

/// Concentration of a bulk particle less 1. In the buffer of an open end the support ends where the case does, so only
/// water that is too dense counts there.
template <int Dim>
double density_error_of(const Flow<Dim>& flow, std::size_t i) {
  const double error = flow.surroundings.concentration[i] - 1.0;
  return is_claimed(flow.role[i]) ? std::max(0.0, error) : error;
}

template <int Dim>
double largest_speed_of_rank(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  return std::sqrt(largest_over(particles.owned, 0.0, [&](std::size_t i) {
    return particles.is_fluid(i) ? particles.velocity[i].squaredNorm() : 0.0;
  }));
}

}  // namespace

FluidSums& FluidSums::operator+=(const FluidSums& other) {
  mass += other.mass;
  kinetic_energy += other.kinetic_energy;
  energy += other.energy;
  fall_power += other.fall_power;
  return *this;
}

template <int Dim>
FluidSums fluid_sums_of_rank(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  const Vec<Dim> g = flow.setup.gravity_across();
  return sum_over(particles.owned, FluidSums{}, [&](std::size_t i) -> FluidSums {
    if (!particles.is_fluid(i)) return {};
    const double mass = flow.density_of(i) * flow.water_volume_of(i);
    const double kinetic_energy = flow.kinetic_energy_of(i);
    return {mass, kinetic_energy, kinetic_energy + flow.potential_energy_of(i), mass * g.dot(particles.velocity[i])};
  });
}

template <int Dim>
double energy_scale(const Setup<Dim>& setup, double mass, double kinetic_energy) {
  return 0.5 * mass * setup.gravity.norm() * setup.length + kinetic_energy;
}

template <int Dim>
double energy_scale(const Flow<Dim>& flow) {
  FluidSums sums = fluid_sums_of_rank(flow);
  flow.setup.ranks.sum_each(sums.mass, sums.kinetic_energy);
  return energy_scale(flow.setup, sums.mass, sums.kinetic_energy);
}

template <int Dim>
WaterAmount amount_of(const Flow<Dim>& flow, std::span<const std::size_t> water) {
  WaterAmount amount = sum_over(water.size(), WaterAmount{}, [&](std::size_t n) -> WaterAmount {
    const std::size_t i = water[n];
    const double volume = flow.water_volume_of(i);
    return {1, volume, flow.density_of(i) * volume, flow.potential_energy_of(i) + flow.kinetic_energy_of(i)};
  });
  flow.setup.ranks.sum_each(amount.particles, amount.volume, amount.mass, amount.energy);
  return amount;
}

template <int Dim>
double largest_speed(const Flow<Dim>& flow) {
  return flow.setup.ranks.largest(largest_speed_of_rank(flow));
}

template <int Dim>
FlowMeasures measure(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  EnergyAndDensity sums = sum_over(particles.owned, EnergyAndDensity{}, [&](std::size_t i) -> EnergyAndDensity {
    if (!particles.is_fluid(i)) return {};
    EnergyAndDensity own{flow.kinetic_energy_of(i), flow.potential_energy_of(i)};
    if (!is_bulk(flow, i)) return own;
    const double error = density_error_of(flow, i);
    own.bulk = flow.setup.weight_in_statistics(particles.volume[i]);
    own.density_error = own.bulk * error;
    own.density_error_squared = own.bulk * (error * error);
    return own;
  });
  FlowMeasures measures;
  measures.largest_speed = largest_speed_of_rank(flow);
  measures.density_error_largest = largest_over(particles.owned, 0.0, [&](std::size_t i) {
    return is_bulk(flow, i) ? std::abs(density_error_of(flow, i)) : 0.0;
  });
  const Communicator& ranks = flow.setup.ranks;
  ranks.sum_each(sums.kinetic_energy, sums.potential_energy, sums.density_error, sums.density_error_squared, sums.bulk);
  ranks.largest_each(measures.largest_speed, measures.density_error_largest);
  measures.kinetic_energy = sums.kinetic_energy;
  measures.potential_energy = sums.potential_energy;
  if (sums.bulk > 0.0) {
    measures.density_error_mean = sums.density_error / sums.bulk;
    measures.density_error_rms = std::sqrt(sums.density_error_squared / sums.bulk);
  }
  for (const auto& part : flow.parts) {
    part->add_passed_water(measures.departed, measures.arrived);
    for (const StepColumn& column : part->step_columns()) measures.of_parts.push_back(column);
  }
  return measures;
}

template <int Dim>
DensestWater<Dim> densest_water(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  DensestWater<Dim> own;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: looks for the largest
    if (!is_bulk(flow, i) || density_error_of(flow, i) <= own.error) continue;
    own = {particles.position[i], density_error_of(flow, i), is_claimed(flow.role[i])};
  }
  const std::vector<DensestWater<Dim>> of_ranks = flow.setup.ranks.all_gather(own);
  return *std::ranges::max_element(of_ranks, {}, [](const DensestWater<Dim>& one) { return one.error; });
}

TAILWATER_IN_2D_AND_3D(fluid_sums_of_rank);
template double energy_scale<2>(const Setup<2>&, double, double);
template double energy_scale<3>(const Setup<3>&, double, double);
template double energy_scale<2>(const Flow<2>&);
template double energy_scale<3>(const Flow<3>&);
TAILWATER_IN_2D_AND_3D(amount_of);
TAILWATER_IN_2D_AND_3D(largest_speed);
TAILWATER_IN_2D_AND_3D(measure);
TAILWATER_IN_2D_AND_3D(densest_water);

}  // namespace tailwater
