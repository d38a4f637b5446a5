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

template <int Dim>
std::vector<std::size_t> particles_of(const PocketSides<Dim>& sides) {
  std::vector<std::size_t> particles;
  for (const PocketSide<Dim>& side : sides.water) particles.push_back(side.particle);
  return particles;
}

template <int Dim>
std::vector<Vec<Dim>> gradient_at_sides(const Flow<Dim>& flow, const std::vector<double>& pressure) {
  const std::vector<std::size_t> particles = particles_of(flow.sides);
  std::vector<Vec<Dim>> gradient(particles.size());
  flow.discretisation().find_gradient_at(flow, particles, pressure, gradient);
  return gradient;
}

/// By how much a velocity of the water, velocity(n) at its n-th side, makes each pocket grow [m^Dim/s]; collective.
template <int Dim, class Velocity>
std::vector<double> growth(const Flow<Dim>& flow, Velocity&& velocity) {
  std::vector<double> growth(flow.state.air.pockets.size(), 0.0);
  for (std::size_t n = 0; n < flow.sides.water.size(); ++n) {
    const PocketSide<Dim>& side = flow.sides.water[n];
    const Vec<Dim> volume_velocity = flow.state.particles.volume[side.particle] * velocity(n);
    for (const PocketGain<Dim>& each : side.gains) growth[each.pocket] += each.gain.dot(volume_velocity);
  }
  flow.setup.ranks.sum_of_each(growth);
  return growth;
}

/// The water that has a share of a pocket, or a neighbour that has.
template <int Dim>
std::vector<PocketSide<Dim>> water_beside_pockets(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  std::vector<PocketSide<Dim>> seeing;
  std::vector<double> sees(particles.size(), 0.0);
  std::vector<char> is_beside(particles.owned, 0);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: a list
    if (flow.role[i] != Role::water) continue;
    std::vector<PocketShare> shares = flow.air.shares_at(particles.position[i]);
    if (shares.empty()) continue;
    seeing.push_back({.particle = i, .shares = std::move(shares)});
    sees[i] = 1.0;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      if (static_cast<std::size_t>(pairs.j[k]) < particles.owned) is_beside[pairs.j[k]] = 1;
    }
  }
  flow.halo().exchange(sees);
  for_each(particles.owned, [&](std::size_t i) {
    for (std::size_t k = pairs.end(i); k > pairs.begin(i) && is_beside[i] == 0; --k) {
      const auto j = static_cast<std::size_t>(pairs.j[k - 1]);
      if (j < particles.owned) break;  // ghosts come last
      if (sees[j] > 0.0) is_beside[i] = 1;
    }
  });
  std::vector<PocketSide<Dim>> water;
  auto next = seeing.begin();
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: a list
    if (flow.role[i] != Role::water) continue;
    if (sees[i] > 0.0) {
      water.push_back(std::move(*next++));
    } else if (is_beside[i] != 0) {
      water.push_back({.particle = i, .shares = {}});
    }
  }
  return water;
}

template <int Dim>
void find_sides(Flow<Dim>& flow) {
  std::vector<PocketSide<Dim>>& water = flow.sides.water;
  water = water_beside_pockets(flow);
  const std::vector<std::size_t> beside = particles_of(flow.sides);
  std::vector<double> weight(beside.size());
  flow.discretisation().find_air_weights(flow, beside, weight);
  const std::vector<Vec<Dim>> push = gradient_at_sides(flow, std::vector<double>(flow.state.particles.size(), 1.0));
  for_each(water.size(), [&](std::size_t n) {
    water[n].push = push[n];
    water[n].weight = weight[n];
  });
  flow.sides.walls = flow.air.walls_beside(flow.walls.boundary);
  const bool walls_move = !flow.setup.wall_motion.moving().empty();
  for (int k = 0; k < static_cast<int>(flow.state.air.pockets.size()); ++k) {
    const std::vector<double> share = shares_of(flow, k);
    for (std::size_t i = 0; walls_move && i < flow.state.particles.owned; ++i) {  // in order: a list
      if (share[i] != 0.0) flow.sides.seen.push_back({i, {k, share[i]}});
    }
    const std::vector<Vec<Dim>> slope = gradient_at_sides(flow, share);
    for (std::size_t n = 0; n < water.size(); ++n) {  // lists
      const Vec<Dim> gain = share[water[n].particle] * push[n] - slope[n];
      if (!gain.isZero(0.0)) water[n].gains.push_back({k, gain});
    }
  }
}

/// By how much the pressure that the pockets alone make, with what they have at the start of the step, is off that of
/// the air; on walls that of the water beside them.
template <int Dim>
std::vector<double> find_own_drop(Flow<Dim>& flow) {
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
  spread(flow, drop);
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
    const std::vector<Vec<Dim>> slope = gradient_at_sides(flow, response.pressure);
    const std::vector<double> answer = growth(flow, [&](std::size_t n) {
      const PocketSide<Dim>& side = flow.sides.water[n];
      double seen = 0.0;
      for (const PocketShare& share : side.shares) seen += share.pocket == k ? share.share : 0.0;
      return Vec<Dim>(unit * (seen * side.push - slope[n]));
    });
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
  sides.own_drop = find_own_drop(flow);
  sides.answers = find_answers(flow, dt);
  const Vec<Dim> gravity =
      flow.setup.formulation.gravity_in_prediction ? Vec<Dim>(Vec<Dim>::Zero()) : flow.setup.gravity;
  sides.flow = growth(flow, [&](std::size_t n) { return Vec<Dim>(predicted[sides.water[n].particle] + dt * gravity); });
  sides.flow_before =
      growth(flow, [&](std::size_t n) { return flow.state.particles.velocity[sides.water[n].particle]; });
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
  const std::vector<Vec<Dim>> gradient = gradient_at_sides(flow, flow.state.particles.pressure);
  std::vector<double> now = growth(flow, [&](std::size_t n) { return Vec<Dim>(-unit * gradient[n]); });
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
  const std::vector<double> flow_after = growth(flow, [&](std::size_t n) { return velocity[sides.water[n].particle]; });
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
