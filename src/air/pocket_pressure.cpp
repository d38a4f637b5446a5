#include "air/pocket_pressure.h"

#include <algorithm>
#include <cmath>

#include "air/gas_step.h"
#include "air/pocket_response.h"
#include "air/vent.h"
#include "base/for_each.h"
#include "flow/balanced_pressure.h"
#include "flow/pressure_equation.h"
#include "motion/wall_motion.h"

namespace tailwater {
namespace {

/// The growth [m^Dim/s] of each pocket by a velocity of the water, velocity(i): the power of the force of 1 Pa in it.
/// Collective.
template <int Dim, class Velocity>
std::vector<double> growth(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, Velocity&& velocity) {
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<double> growth;
  for (const AirPocket& pocket : air.state.pockets) {
    const std::vector<Vec<Dim>>& force = air.watch.response(pocket.number).force;
    growth.push_back(sum_over(particles.owned, 0.0, [&](std::size_t i) {
      return flow.role[i] == Role::water ? particles.volume[i] * force[i].dot(velocity(i)) : 0.0;
    }));
  }
  flow.setup.ranks.sum_of_each(growth);
  return growth;
}

/// The growth of each pocket if water and walls have the common velocity of the walls. Collective.
template <int Dim>
std::vector<double> find_unclosed(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, const PocketStep<Dim>& step,
                                  double dt) {
  const AffineMap<Dim> common = common_velocity(flow, dt);
  if (common.linear.norm() + common.constant.norm() == 0.0) return {};
  std::vector<double> unclosed =
      growth(flow, air, [&](std::size_t i) { return common(flow.state.particles.position[i]); });
  const std::vector<double> by_walls = growth_of_all_walls(flow, step, common, unclosed.size());
  for (std::size_t k = 0; k < unclosed.size(); ++k) unclosed[k] += by_walls[k];
  return unclosed;
}

/// The water beside pockets.
template <int Dim>
std::vector<PocketSide<Dim>> find_sides(const Flow<Dim>& flow, const EnclosedAir<Dim>& air) {
  const Particles<Dim>& particles = flow.state.particles;
  const Boundary<Dim>& boundary = flow.walls.boundary;
  std::vector<PocketSide<Dim>> sides;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: a list
    if (flow.role[i] != Role::water) continue;
    std::vector<PocketShare> shares = air.watch.fractions_at(boundary, particles.position[i]);
    if (shares.empty()) continue;
    const bool is_beside = !air.watch.shares_at(boundary, particles.position[i]).empty();
    sides.push_back({.particle = i, .shares = std::move(shares), .is_beside = is_beside});
  }
  std::vector<std::size_t> beside;
  for (const PocketSide<Dim>& side : sides) beside.push_back(side.particle);
  std::vector<double> weight(beside.size());
  flow.discretisation().find_air_weights(flow, beside, weight);
  std::vector<Vec<Dim>> push(beside.size());
  flow.discretisation().find_gradient_at(flow, beside, std::vector<double>(particles.size(), 1.0), push);
  for_each(sides.size(), [&](std::size_t n) {
    sides[n].push = push[n];
    sides[n].weight = weight[n];
  });
  return sides;
}

/// The fraction of each pocket in the air beside particles, walls too. Collective.
template <int Dim>
std::vector<std::pair<std::size_t, PocketShare>> find_air_fractions(const Flow<Dim>& flow,
                                                                    std::span<const PocketSide<Dim>> sides,
                                                                    std::size_t pockets) {
  std::vector<std::pair<std::size_t, PocketShare>> fractions;
  for (int k = 0; k < static_cast<int>(pockets); ++k) {
    const std::vector<double> share = shares_of<Dim>(flow, sides, k);
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {  // in order: a list
      if (share[i] != 0.0) fractions.push_back({i, {k, share[i]}});
    }
  }
  return fractions;
}

/// The difference between the pressure that the pockets alone make and that of the air, with the state of the pockets
/// at the start of the step. Walls have the value of the water beside them. Collective.
template <int Dim>
std::vector<double> find_response_deficit(const Flow<Dim>& flow, const EnclosedAir<Dim>& air,
                                          std::span<const PocketSide<Dim>> sides) {
  std::vector<double> deficit(flow.state.particles.size(), 0.0);
  std::vector<double> pressure;
  for (const AirPocket& pocket : air.state.pockets) {
    pressure.push_back(air.pressure_of(pocket));
    const std::vector<double>& response = air.watch.response(pocket.number).pressure;
    for_each(deficit.size(), [&](std::size_t i) { deficit[i] += pressure.back() * response[i]; });
  }
  for (const PocketSide<Dim>& side : sides) {
    for (const PocketShare& share : side.shares) deficit[side.particle] -= share.share * pressure[share.pocket];
  }
  const std::size_t owned = flow.state.particles.owned;
  for_each(owned, [&](std::size_t i) { deficit[i] = flow.role[i] == Role::water ? std::abs(deficit[i]) : 0.0; });
  extend_to_walls(flow, deficit);
  deficit.resize(owned);
  return deficit;
}

/// The growth [m^Dim/s per Pa] of each pocket (row) within dt by the pressure of each (column). Collective.
template <int Dim>
Eigen::MatrixXd find_answers(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, double dt) {
  const auto count = static_cast<Eigen::Index>(air.state.pockets.size());
  const double unit = dt / flow.setup.liquid.density;
  Eigen::MatrixXd answers(count, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const AirResponse<Dim>& response = air.watch.response(air.state.pockets[k].number);
    const std::vector<double> answer =
        growth(flow, air, [&](std::size_t i) { return Vec<Dim>(unit * response.force[i]); });
    answers.col(k) = Eigen::Map<const Eigen::VectorXd>(answer.data(), count);
  }
  return answers;
}

/// Updates a pocket at the end of a step: its new volume, and the flow through its vents. Returns the work of the gas
/// on the water [J], the mean of the values for gas that flows before and after the change of volume.
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

/// Limits the volumes at the end of a step to a tenth of those at its start. In a sealed space the largest pocket loses
/// the difference, so the volume of the space stays.
template <int Dim>
void limit_compression(const EnclosedAir<Dim>& air, std::vector<double>& volumes) {
  const auto least = [&](std::size_t k) { return 0.1 * air.state.pockets[k].volume; };
  for (std::size_t k = 0; k < volumes.size(); ++k) {
    const int reference = air.watch.reference_of(static_cast<int>(k));
    if (reference < 0 || static_cast<std::size_t>(reference) == k || volumes[k] >= least(k)) continue;
    volumes[reference] -= least(k) - volumes[k];
    volumes[k] = least(k);
  }
  for (std::size_t k = 0; k < volumes.size(); ++k) volumes[k] = std::max(volumes[k], least(k));
}

template <int Dim>
GasStep gas_step_of(const EnclosedAir<Dim>& air, double dt) {
  return {air.watch.law(), air.state.pockets, air.watch.openings(), air.step.mobility, air.step.answers, dt};
}

}  // namespace

template <int Dim>
PocketStep<Dim> pose_pockets(Flow<Dim>& flow, EnclosedAir<Dim>& air, std::span<const Vec<Dim>> predicted, double dt) {
  PocketStep<Dim> step;
  const std::size_t pockets = air.state.pockets.size();
  if (pockets == 0) return step;
  const bool walls_move = !flow.setup.wall_motion->moving().empty();
  step.water = find_sides(flow, air);
  if (walls_move) {
    step.walls = air.watch.walls_beside(flow.walls.boundary);
    step.air_fractions = find_air_fractions<Dim>(flow, step.water, pockets);
  }
  const std::vector<double> sources(flow.equation->rows.rhs().begin(), flow.equation->rows.rhs().end());
  for (int k = 0; k < static_cast<int>(pockets); ++k) {
    if (air.watch.reference_of(k) != k) step.iterations += find_response<Dim>(flow, air, step.water, k);
  }
  for (int k = 0; k < static_cast<int>(pockets); ++k) {
    if (air.watch.reference_of(k) == k) set_reference_response<Dim>(flow, air, k);
  }
  std::ranges::copy(sources, flow.equation->rows.rhs().begin());
  if (walls_move) step.wall_pair_forces = find_wall_pair_forces<Dim>(flow, air, step.air_fractions);
  step.unclosed = find_unclosed(flow, air, step, dt);
  step.response_deficit = find_response_deficit<Dim>(flow, air, step.water);
  step.answers = find_answers(flow, air, dt);
  const Vec<Dim> gravity =
      flow.setup.formulation.gravity_in_prediction ? Vec<Dim>(Vec<Dim>::Zero()) : flow.setup.gravity;
  step.flow = growth(flow, air, [&](std::size_t i) { return Vec<Dim>(predicted[i] + dt * gravity); });
  step.flow_before = growth(flow, air, [&](std::size_t i) { return flow.state.particles.velocity[i]; });
  return step;
}

template <int Dim>
std::vector<double> find_air_pressures(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, double dt) {
  const double unit = dt / flow.setup.liquid.density;
  std::vector<Vec<Dim>> gradient(flow.state.particles.owned, Vec<Dim>::Zero());
  find_pressure_gradient<Dim>(flow, flow.state.particles.pressure, gradient);
  std::vector<double> now = growth(flow, air, [&](std::size_t i) { return Vec<Dim>(-unit * gradient[i]); });
  for (std::size_t k = 0; k < now.size(); ++k) now[k] += air.step.flow[k];
  GasStep step = gas_step_of(air, dt);
  step.set_flow(now, air.step.flow_before, growth_by_walls(flow, air, dt));
  return step.solve();
}

template <int Dim>
Eigen::MatrixXd stiffness_of_air(const EnclosedAir<Dim>& air, double dt) {
  return gas_step_of(air, dt).stiffness();
}

template <int Dim>
void add_air_of(const EnclosedAir<Dim>& air, std::span<const double> pressures, std::vector<double>& field) {
  for (std::size_t k = 0; k < pressures.size(); ++k) {
    const std::vector<double>& response = air.watch.response(air.state.pockets[k].number).pressure;
    for_each(field.size(), [&](std::size_t i) { field[i] += pressures[k] * response[i]; });
  }
}

template <int Dim>
void push_by_pockets(Flow<Dim>& flow, EnclosedAir<Dim>& air, double dt) {
  PocketStep<Dim>& step = air.step;
  if (step.pressure.empty()) return;
  std::vector<Vec<Dim>>& velocity = flow.state.particles.velocity;
  for_each(step.water.size(), [&](std::size_t n) {
    const PocketSide<Dim>& side = step.water[n];
    velocity[side.particle] += dt / flow.setup.liquid.density * step.pressure_at(side) * side.push;
  });
  const std::vector<double> flow_after = growth(flow, air, [&](std::size_t i) { return velocity[i]; });
  const std::vector<double> by_walls = growth_by_walls(flow, air, dt);
  std::vector<double> volumes;
  for (std::size_t k = 0; k < flow_after.size(); ++k) {
    const double rate = 0.5 * (step.flow_before[k] + flow_after[k]) + by_walls[k];
    volumes.push_back(air.state.pockets[k].volume + dt * rate);
  }
  limit_compression(air, volumes);
  for (std::size_t k = 0; k < volumes.size(); ++k) {
    AirPocket& pocket = air.state.pockets[k];
    step.work += change_pocket(pocket, volumes[k], air.watch.law(), air.watch.openings()[k], dt, air.state);
  }
}

TAILWATER_IN_2D_AND_3D(pose_pockets);
TAILWATER_IN_2D_AND_3D(find_air_pressures);
TAILWATER_IN_2D_AND_3D(stiffness_of_air);
TAILWATER_IN_2D_AND_3D(add_air_of);
TAILWATER_IN_2D_AND_3D(push_by_pockets);

}  // namespace tailwater
