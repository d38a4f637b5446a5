#include "pressure/pockets.h"

#include <algorithm>
#include <cmath>

#include "air/vent.h"
#include "base/for_each.h"
#include "flow/air_pressure.h"
#include "pressure/gas_step.h"
#include "pressure/pocket_response.h"

namespace tailwater {
namespace {

/// By how much a velocity of the water, velocity(i), makes each pocket grow [m^Dim/s]: what the force of 1 Pa in it
/// works on that velocity. Collective.
template <int Dim, class Velocity>
std::vector<double> growth(const Flow<Dim>& flow, Velocity&& velocity) {
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<double> growth;
  for (const AirPocket& pocket : flow.state.air.pockets) {
    const std::vector<Vec<Dim>>& force = flow.air.response(pocket.number).force;
    growth.push_back(sum_over(particles.owned, 0.0, [&](std::size_t i) {
      return flow.role[i] == Role::water ? particles.volume[i] * force[i].dot(velocity(i)) : 0.0;
    }));
  }
  flow.setup.ranks.sum_of_each(growth);
  return growth;
}

template <int Dim>
void find_sides(Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<PocketSide<Dim>>& water = flow.sides.water;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: a list
    if (flow.role[i] != Role::water) continue;
    std::vector<PocketShare> shares = flow.air.shares_at(particles.position[i]);
    if (!shares.empty()) water.push_back({.particle = i, .shares = std::move(shares)});
  }
  std::vector<std::size_t> beside;
  for (const PocketSide<Dim>& side : water) beside.push_back(side.particle);
  std::vector<double> weight(beside.size());
  flow.discretisation().find_air_weights(flow, beside, weight);
  std::vector<Vec<Dim>> push(beside.size());
  flow.discretisation().find_gradient_at(flow, beside, std::vector<double>(particles.size(), 1.0), push);
  for_each(water.size(), [&](std::size_t n) {
    water[n].push = push[n];
    water[n].weight = weight[n];
  });
  if (flow.setup.wall_motion.moving().empty()) return;
  flow.sides.walls = flow.air.walls_beside(flow.walls.boundary);
  for (int k = 0; k < static_cast<int>(flow.state.air.pockets.size()); ++k) {
    const std::vector<double> share = shares_of(flow, k);
    for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: a list
      if (share[i] != 0.0) flow.sides.air_fractions.push_back({i, {k, share[i]}});
    }
  }
}

/// By how much the pressure that the pockets alone make, with what they have at the start of the step, is off that of
/// the air; on walls that of the water beside them.
template <int Dim>
std::vector<double> find_response_deficit(Flow<Dim>& flow) {
  std::vector<double> drop(flow.state.particles.size(), 0.0);
  const std::vector<AirPocket>& pockets = flow.state.air.pockets;
  std::vector<double> pressure;
  for (const AirPocket& pocket : pockets) {
    pressure.push_back(pressure_of(flow, pocket));
    const std::vector<double>& response = flow.air.response(pocket.number).pressure;
    for_each(drop.size(), [&](std::size_t i) { drop[i] += pressure.back() * response[i]; });
  }
  for (const PocketSide<Dim>& side : flow.sides.water) {
    for (const PocketShare& share : side.shares) drop[side.particle] -= share.share * pressure[share.pocket];
  }
  const std::size_t owned = flow.state.particles.owned;
  for_each(owned, [&](std::size_t i) { drop[i] = flow.role[i] == Role::water ? std::abs(drop[i]) : 0.0; });
  extend_to_walls(flow, drop);
  return drop;
}

/// By how much [m^Dim/s per Pa] each pocket (row) grows within dt under the pressure of each (column). Collective.
template <int Dim>
Eigen::MatrixXd find_answers(Flow<Dim>& flow, double dt) {
  const auto count = static_cast<Eigen::Index>(flow.state.air.pockets.size());
  const double unit = dt / flow.setup.density;
  Eigen::MatrixXd answers(count, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const AirResponse<Dim>& response = flow.air.response(flow.state.air.pockets[k].number);
    const std::vector<double> answer = growth(flow, [&](std::size_t i) { return Vec<Dim>(unit * response.force[i]); });
    answers.col(k) = Eigen::Map<const Eigen::VectorXd>(answer.data(), count);
  }
  return answers;
}

/// The end of a step of a pocket: its new volume, and what flows through its vents. Returns the work of the gas on the
/// water [J], the mean of what it is if the gas flows before the volume changes, and after.
double change_pocket(AirPocket& pocket, double volume, const GasLaw& law, double opening, double dt, AirState& air) {
  const double old_gas = pocket.gas;
  const double old_volume = pocket.volume;
  const double old_energy = law.energy(old_gas, old_volume);
  pocket.volume = volume;
  pocket.gas = gas_after_venting(law, old_gas, volume, opening, dt);
  const double energy = law.energy(pocket.gas, volume);
  if (opening == 0.0) return old_energy - energy;
  const double work = 0.5 * (old_energy - law.energy(old_gas, volume) + law.energy(pocket.gas, old_volume) - energy);
  air.gas_vented += old_gas - pocket.gas;
  air.energy_vented += old_energy - energy - work;
  return work;
}

template <int Dim>
GasStep gas_step_of(const Flow<Dim>& flow, double dt) {
  return {flow.air.law(), flow.state.air.pockets, flow.air.openings(), flow.sides.mobility, flow.sides.answers, dt};
}

}  // namespace

template <int Dim>
void pose_pockets(Flow<Dim>& flow, std::span<const Vec<Dim>> predicted, double dt) {
  PocketSides<Dim>& sides = flow.sides;
  sides = {};
  const auto pockets = static_cast<int>(flow.state.air.pockets.size());
  if (pockets == 0) return;
  find_sides(flow);
  const std::vector<double> rhs(flow.pressure_rows.rhs().begin(), flow.pressure_rows.rhs().end());
  for (int k = 0; k < pockets; ++k) find_response(flow, k);
  std::ranges::copy(rhs, flow.pressure_rows.rhs().begin());
  if (!flow.setup.wall_motion.moving().empty()) sides.wall_pair_forces = pairs_of_walls(flow);
  sides.response_deficit = find_response_deficit(flow);
  sides.answers = find_answers(flow, dt);
  const Vec<Dim> gravity =
      flow.setup.formulation.gravity_in_prediction ? Vec<Dim>(Vec<Dim>::Zero()) : flow.setup.gravity;
  sides.flow = growth(flow, [&](std::size_t i) { return Vec<Dim>(predicted[i] + dt * gravity); });
  sides.flow_before = growth(flow, [&](std::size_t i) { return flow.state.particles.velocity[i]; });
}

template <int Dim>
void subtract_air(Flow<Dim>& flow) {
  const std::vector<double>& air = flow.air.air_pressure();
  std::vector<double>& pressure = flow.state.particles.pressure;
  for_each(std::min(air.size(), flow.state.particles.owned), [&](std::size_t i) { pressure[i] -= air[i]; });
}

template <int Dim>
void restore_air(Flow<Dim>& flow) {
  const std::vector<double>& air = flow.air.air_pressure();
  if (flow.state.air.pockets.empty()) return;
  std::vector<double>& pressure = flow.state.particles.pressure;
  for_each(std::min(air.size(), flow.state.particles.owned), [&](std::size_t i) { pressure[i] += air[i]; });
  flow.halo().exchange(pressure);
}

template <int Dim>
std::vector<double> find_air_pressures(const Flow<Dim>& flow, double dt) {
  const double unit = dt / flow.setup.density;
  std::vector<Vec<Dim>> gradient(flow.state.particles.owned, Vec<Dim>::Zero());
  flow.discretisation().find_gradient(flow, flow.state.particles.pressure, gradient);
  std::vector<double> now = growth(flow, [&](std::size_t i) { return Vec<Dim>(-unit * gradient[i]); });
  for (std::size_t k = 0; k < now.size(); ++k) now[k] += flow.sides.flow[k];
  GasStep step = gas_step_of(flow, dt);
  step.set_flow(now, flow.sides.flow_before, growth_by_walls(flow, dt));
  return step.solve();
}

template <int Dim>
Eigen::MatrixXd stiffness_of_air(const Flow<Dim>& flow, double dt) {
  return gas_step_of(flow, dt).stiffness();
}

template <int Dim>
void add_air_of(Flow<Dim>& flow, std::span<const double> pressures, std::vector<double>& field) {
  for (std::size_t k = 0; k < pressures.size(); ++k) {
    const std::vector<double>& response = flow.air.response(flow.state.air.pockets[k].number).pressure;
    for_each(field.size(), [&](std::size_t i) { field[i] += pressures[k] * response[i]; });
  }
}

template <int Dim>
void add_air(Flow<Dim>& flow, double dt) {
  PocketSides<Dim>& sides = flow.sides;
  std::vector<double>& air = flow.air.air_pressure();
  air.clear();
  const std::vector<AirPocket>& pockets = flow.state.air.pockets;
  if (pockets.empty()) return;
  std::vector<double>& pressure = flow.state.particles.pressure;
  sides.pressure = find_air_pressures(flow, dt);
  air.assign(pressure.size(), 0.0);
  add_air_of(flow, sides.pressure, air);
  for_each(air.size(), [&](std::size_t i) { pressure[i] += air[i]; });
}

template <int Dim>
void push_by_pockets(Flow<Dim>& flow, double dt) {
  PocketSides<Dim>& sides = flow.sides;
  if (sides.pressure.empty()) return;
  std::vector<Vec<Dim>>& velocity = flow.state.particles.velocity;
  for_each(sides.water.size(), [&](std::size_t n) {
    const PocketSide<Dim>& side = sides.water[n];
    velocity[side.particle] += dt / flow.setup.density * sides.pressure_at(side) * side.push;
  });
  const std::vector<double> flow_after = growth(flow, [&](std::size_t i) { return velocity[i]; });
  const std::vector<double> by_walls = growth_by_walls(flow, dt);
  for (std::size_t k = 0; k < flow_after.size(); ++k) {
    AirPocket& pocket = flow.state.air.pockets[k];
    const double rate = 0.5 * (sides.flow_before[k] + flow_after[k]) + by_walls[k];
    const double volume = std::max(pocket.volume + dt * rate, 0.1 * pocket.volume);
    sides.work += change_pocket(pocket, volume, flow.air.law(), flow.air.openings()[k], dt, flow.state.air);
  }
}

TAILWATER_IN_2D_AND_3D(pose_pockets);
TAILWATER_IN_2D_AND_3D(subtract_air);
TAILWATER_IN_2D_AND_3D(restore_air);
TAILWATER_IN_2D_AND_3D(find_air_pressures);
TAILWATER_IN_2D_AND_3D(stiffness_of_air);
TAILWATER_IN_2D_AND_3D(add_air_of);
TAILWATER_IN_2D_AND_3D(add_air);
TAILWATER_IN_2D_AND_3D(push_by_pockets);

}  // namespace tailwater
