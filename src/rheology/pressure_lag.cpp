#include "rheology/pressure_lag.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/for_each.h"
#include "neighbours/halo.h"

namespace tailwater {
namespace {

constexpr int averages = 3;

constexpr double max_change_by_pressure = 0.03;
/// Factors of the step, from one to the next.
constexpr double strongest_decrease = 0.5;
constexpr double strongest_increase = 1.2;

/// Averages a velocity of the water over each particle and its neighbours.
template <int Dim>
void average(const Flow<Dim>& flow, std::vector<Vec<Dim>>& velocity) {
  const Pairs<Dim>& pairs = flow.pairs();
  std::vector<Vec<Dim>> of_all = velocity;
  of_all.resize(flow.state.particles.size(), Vec<Dim>::Zero());
  flow.halo().exchange(of_all);
  for_each(velocity.size(), [&](std::size_t i) {
    if (flow.role[i] != Role::water) return;
    Vec<Dim> sum = of_all[i];
    double count = 1.0;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      if (!flow.state.particles.is_fluid(pairs.j[k])) continue;
      sum += of_all[pairs.j[k]];
      count += 1.0;
    }
    velocity[i] = sum / count;
  });
}

/// m/s; the largest speed of the walls that move, and of the liquid whose velocity openings prescribe.
template <int Dim>
double pushing_speed(const Flow<Dim>& flow) {
  const std::vector<Vec<Dim>>& of_walls = flow.state.wall_velocity;
  const double of_wall = largest_over(of_walls.size(), 0.0, [&](std::size_t row) { return of_walls[row].norm(); });
  const Particles<Dim>& particles = flow.state.particles;
  const double at_opening = largest_over(particles.owned, 0.0, [&](std::size_t i) {
    const bool is_prescribed = flow.role[i] == Role::prescribed || flow.role[i] == Role::following;
    return is_prescribed ? particles.velocity[i].norm() : 0.0;
  });
  return flow.setup.ranks.largest(std::max(of_wall, at_opening));
}

}  // namespace

template <int Dim>
double change_by_pressure(const Flow<Dim>& flow, std::span<const Vec<Dim>> before) {
  const double push = pushing_speed(flow);
  if (push == 0.0) return 0.0;
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<Vec<Dim>> change(particles.owned, Vec<Dim>::Zero());
  for_each(particles.owned, [&](std::size_t i) {
    if (flow.role[i] == Role::water) change[i] = particles.velocity[i] - before[i];
  });
  for (int n = 0; n < averages; ++n) average(flow, change);
  const auto sum_of_water = [&](auto&& of) {
    return sum_over(particles.owned, 0.0,
                    [&](std::size_t i) { return flow.role[i] == Role::water ? particles.volume[i] * of(i) : 0.0; });
  };
  double changed = sum_of_water([&](std::size_t i) { return change[i].squaredNorm(); });
  double all = sum_of_water([&](std::size_t i) { return before[i].squaredNorm(); });
  double volume = sum_of_water([](std::size_t /*i*/) { return 1.0; });
  flow.setup.ranks.sum_each(changed, all, volume);
  return volume > 0.0 ? std::sqrt(changed / std::max(all, volume * push * push)) : 0.0;
}

double longest_step_after(double change, double dt, double shortest) {
  const double factor = max_change_by_pressure / std::max(change, max_change_by_pressure / strongest_increase);
  return std::max(shortest, dt * std::max(factor, strongest_decrease));
}

template double change_by_pressure<2>(const Flow<2>&, std::span<const Vec<2>>);
template double change_by_pressure<3>(const Flow<3>&, std::span<const Vec<3>>);

}  // namespace tailwater
