// Walls that move beside pockets. The volume that a wall leaves to a pocket is computed from the force of the pocket on
// the wall. The first part of the force is that of the air itself, on the pieces of the faces according to their
// fractions. The second is that of the pairs of water and wall, in which the pressure is relative to that of the air.
#include <algorithm>
#include <optional>

#include "air/pocket_pressure.h"
#include "base/for_each.h"
#include "motion/floating_body.h"
#include "motion/wall_motion.h"
#include "open_ends/open_ends.h"
#include "pressure/operators.h"

namespace tailwater {
namespace {

/// Columns of particles that may wait at an opening, or have entered early.
constexpr double max_columns_waiting = 2.0;

template <int Dim>
void subtract_fractions(const Flow<Dim>& flow, std::span<const std::pair<std::size_t, PocketShare>> fractions,
                        std::span<const double> pressures, std::vector<double>& field) {
  for (const auto& [i, fraction] : fractions) field[i] -= fraction.share * pressures[fraction.pocket];
  flow.halo().exchange(field);
}

}  // namespace

template <int Dim>
double pressure_at(const PocketWall<Dim>& wall, std::span<const double> air) {
  double sum = 0.0;
  for (const PocketShare& share : wall.shares) sum += share.share * air[share.pocket];
  return sum;
}

template <int Dim>
std::vector<PocketPairs<Dim>> find_wall_pair_forces(
    const Flow<Dim>& flow, const EnclosedAir<Dim>& air,
    std::span<const std::pair<std::size_t, PocketShare>> air_fractions) {
  const Particles<Dim>& particles = flow.state.particles;
  const std::size_t count = air.state.pockets.size();
  const auto wall_of = [&](std::size_t i) { return flow.walls.particles.wall[particles.wall_row[i]]; };
  const std::vector<std::size_t> moving = indices_where(particles.owned, [&](std::size_t i) {
    return !particles.is_fluid(i) && flow.walls.boundary.walls[wall_of(i)].moves();
  });
  std::vector<PocketPairs<Dim>> all;
  std::vector<double> sums;
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<double> unit(count, 0.0);
    unit[k] = 1.0;
    std::vector<double> field = air.watch.response(air.state.pockets[k].number).pressure;
    subtract_fractions<Dim>(flow, air_fractions, unit, field);
    const std::vector<Vec<Dim>> pushes = reactions_of_walls<Dim>(flow, moving, field);
    for (const auto& each : flow.setup.wall_motion->moving()) {
      PocketPairs<Dim> sum{each.wall, static_cast<int>(k), Vec<Dim>::Zero(), Mat<Dim>::Zero()};
      for (std::size_t n = 0; n < moving.size(); ++n) {  // in order: all add to the same sum
        const std::size_t i = moving[n];
        if (wall_of(i) != each.wall) continue;
        const Vec<Dim> force = -particles.volume[i] * pushes[n];
        sum.force += force;
        sum.moment += force * particles.position[i].transpose();
      }
      sums.insert(sums.end(), sum.force.begin(), sum.force.end());
      sums.insert(sums.end(), sum.moment.begin(), sum.moment.end());
      all.push_back(sum);
    }
  }
  flow.setup.ranks.sum_of_each(sums);
  const double* next = sums.data();
  for (PocketPairs<Dim>& each : all) {
    each.force = Vec<Dim>::Map(next);
    each.moment = Mat<Dim>::Map(next + Dim);
    next += Dim + Dim * Dim;
  }
  return all;
}

namespace {

/// Calls visit(moving, velocity) for each wall that moves, with its velocity [m/s] as a function of the place, halfway
/// through the step. A turning wall then has a velocity without divergence, so a closed surface leaves no volume.
template <int Dim, class Visit>
void visit_moving(const Flow<Dim>& flow, double dt, Visit&& visit) {
  if (dt == 0.0) return;
  const double time = flow.state.time;
  MotionState<Dim> state = flow.state.motion;
  for (BodyState<Dim>& body : state.bodies.each) body.velocity -= 0.5 * dt * body.acceleration;
  for (const auto& moving : flow.setup.wall_motion->moving()) {
    const AffineMap<Dim> now = moving.at(time, state);
    const AffineMap<Dim> drawn = moving.mean_velocity(time, time + dt, state);
    const Mat<Dim> forward = drawn.linear * now.linear.transpose();  // by the present place
    const Vec<Dim> constant = drawn.constant - forward * now.constant;
    const Mat<Dim> linear = forward * (Mat<Dim>::Identity() + 0.5 * dt * forward).inverse();
    visit(moving, AffineMap<Dim>{linear, constant - 0.5 * dt * linear * constant});
  }
}

template <int Dim>
bool are_equal(const AffineMap<Dim>& a, const AffineMap<Dim>& b) {
  constexpr double rounding = 1e-9;
  return (a.constant - b.constant).norm() <= rounding * a.constant.norm() &&
         (a.linear - b.linear).norm() <= rounding * a.linear.norm();
}

/// m^Dim/s; growth of each pocket by the direct force of the air on a wall with this velocity.
template <int Dim>
void add_growth_at_wall(const PocketStep<Dim>& step, int wall, const AffineMap<Dim>& velocity,
                        std::vector<double>& growth) {
  for (const PocketWall<Dim>& piece : step.walls) {
    if (piece.wall != wall) continue;
    const double flux = piece.area.dot(velocity(piece.x)) + piece.couple.dot(angular_velocity_of<Dim>(velocity));
    for (const PocketShare& share : piece.shares) growth[share.pocket] += share.share * flux;
  }
}

/// m^Dim/s; growth of each pocket by the pairs of water and a wall with this velocity.
template <int Dim>
void add_growth_by_pairs(const PocketStep<Dim>& step, int wall, const AffineMap<Dim>& velocity,
                         std::vector<double>& growth) {
  for (const PocketPairs<Dim>& pairs : step.wall_pair_forces) {
    if (pairs.wall == wall) growth[pairs.pocket] += pairs.growth(velocity);
  }
}

}  // namespace

template <int Dim>
AffineMap<Dim> common_velocity(const Flow<Dim>& flow, double dt) {
  const AffineMap<Dim> none{Mat<Dim>::Zero(), Vec<Dim>::Zero()};
  const auto rests = [](const WallProperties& wall) { return !wall.moves(); };
  if (std::ranges::any_of(flow.walls.boundary.walls, rests)) return none;
  std::optional<AffineMap<Dim>> common;
  bool is_common = true;
  visit_moving(flow, dt, [&](const auto& moving, const AffineMap<Dim>& velocity) {
    if (moving.body >= 0) return;
    if (!common) common = velocity;
    is_common = is_common && are_equal(*common, velocity);
  });
  return common && is_common ? *common : none;
}

template <int Dim>
std::vector<double> growth_of_all_walls(const Flow<Dim>& flow, const PocketStep<Dim>& step,
                                        const AffineMap<Dim>& velocity, std::size_t pockets) {
  std::vector<double> growth(pockets, 0.0);
  for (const auto& moving : flow.setup.wall_motion->moving()) {
    add_growth_at_wall(step, moving.wall, velocity, growth);
    add_growth_by_pairs(step, moving.wall, velocity, growth);
  }
  return growth;
}

template <int Dim>
std::vector<double> growth_at_walls(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, double dt) {
  std::vector<double> growth(air.state.pockets.size(), 0.0);
  visit_moving(flow, dt, [&](const auto& moving, const AffineMap<Dim>& velocity) {
    add_growth_at_wall(air.step, moving.wall, velocity, growth);
  });
  for (std::size_t k = 0; k < air.step.unclosed.size(); ++k) growth[k] -= air.step.unclosed[k];
  return growth;
}

namespace {

/// m^Dim; volume that an end has brought up to the end of the step: the prescribed one, within the columns of particles
/// that have entered or wait at the opening.
template <int Dim>
double brought_by(const OpenEnd<Dim>& end, const OpenEndState& state) {
  const double passed = state.arrived.volume - state.departed.volume;
  const double waiting = max_columns_waiting * end.spacing * end.area_below(state.depth);
  return std::clamp(state.asked, passed - waiting, passed + waiting);
}

/// Adjusts the growth of the reference pockets of sealed spaces, so that all pockets together lose the volume of the
/// inflow.
template <int Dim>
void settle_references(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, double dt, std::vector<double>& growth) {
  const std::vector<double> brought = brought_by_ends(flow);
  for (int k = 0; k < static_cast<int>(growth.size()); ++k) {
    if (air.watch.reference_of(k) != k) continue;
    growth[k] = 0.0;
    for (int other = 0; other < static_cast<int>(growth.size()); ++other) {
      if (other != k && air.watch.reference_of(other) == k) growth[k] -= growth[other];
    }
    for (std::size_t e = 0; e < brought.size(); ++e) {
      if (air.watch.reference_of_end(e) == k) growth[k] -= (brought[e] - air.state.brought_before(e)) / dt;
    }
  }
}

}  // namespace

template <int Dim>
std::vector<double> brought_by_ends(const Flow<Dim>& flow) {
  const auto& ends = flow.template part<OpenEnds<Dim>>();
  std::vector<double> brought;
  for (std::size_t e = 0; e < ends.ends().size(); ++e) {
    const bool feeds = ends.ends()[e].flow.feeds();
    brought.push_back(feeds ? brought_by(ends.ends()[e], ends.states()[e]) : 0.0);
  }
  return brought;
}

template <int Dim>
void find_inflow(const Flow<Dim>& flow, EnclosedAir<Dim>& air, double dt) {
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<double> growth(air.state.pockets.size(), 0.0);
  air.step.inflow = growth;
  air.step.inflow_of_pairs = growth;
  const std::vector<std::size_t> driven =
      indices_where(particles.owned, [&](std::size_t i) { return flow.role[i] == Role::following; });
  std::vector<double> is_water(particles.size(), 0.0);
  for_each(particles.owned, [&](std::size_t i) { is_water[i] = flow.role[i] == Role::water ? 1.0 : 0.0; });
  flow.halo().exchange(is_water);
  std::vector<Vec<Dim>> pushes(driven.size());
  for (std::size_t k = 0; k < growth.size(); ++k) {
    const std::vector<double>& response = air.watch.response(air.state.pockets[k].number).pressure;
    flow.discretisation().reactions_seen_by_water(flow, driven, is_water, response, pushes);
    growth[k] = -sum_over(driven.size(), 0.0, [&](std::size_t n) {
      return particles.volume[driven[n]] * pushes[n].dot(particles.velocity[driven[n]]);
    });
  }
  flow.setup.ranks.sum_of_each(growth);
  air.step.inflow_of_pairs = growth;
  settle_references(flow, air, dt, growth);
  air.step.inflow = std::move(growth);
}

template <int Dim>
std::vector<double> growth_by_walls(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, double dt) {
  std::vector<double> growth = growth_at_walls(flow, air, dt);
  for (std::size_t k = 0; k < growth.size(); ++k) growth[k] += air.step.inflow[k];
  visit_moving(flow, dt, [&](const auto& moving, const AffineMap<Dim>& velocity) {
    add_growth_by_pairs(air.step, moving.wall, velocity, growth);
  });
  return growth;
}

template <int Dim>
void subtract_seen_air(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, std::span<const double> pressures,
                       std::vector<double>& field) {
  subtract_fractions<Dim>(flow, air.step.air_fractions, pressures, field);
}

TAILWATER_IN_2D_AND_3D(pressure_at);
TAILWATER_IN_2D_AND_3D(find_wall_pair_forces);
TAILWATER_IN_2D_AND_3D(common_velocity);
TAILWATER_IN_2D_AND_3D(growth_of_all_walls);
TAILWATER_IN_2D_AND_3D(growth_at_walls);
TAILWATER_IN_2D_AND_3D(brought_by_ends);
TAILWATER_IN_2D_AND_3D(find_inflow);
TAILWATER_IN_2D_AND_3D(growth_by_walls);
TAILWATER_IN_2D_AND_3D(subtract_seen_air);

}  // namespace tailwater
