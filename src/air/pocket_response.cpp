#include "air/pocket_response.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/for_each.h"
#include "flow/pressure_equation.h"
#include "flow/stages.h"
#include "pressure/solve_rows.h"
#include "pressure/tolerance.h"

namespace tailwater {
namespace {

/// Number of passes of a response that begins.
constexpr int passes_at_start = 4;

/// Maximum change of a response in a pass. A larger change means that the air beside the water is different, because
/// pockets have joined, parted or torn, and the response is initialised again.
constexpr double largest_change = 0.2;

/// Updates walls. Above the surface a wall has water on one side only, below. With the mean alone it would hold back
/// the corner of the water. So it has the mean of its neighbours' fields extrapolated to its place, where grad q = -F.
template <int Dim>
void show_to_walls(const Flow<Dim>& flow, AirResponse<Dim>& response) {
  extend_to_walls(flow, response.pressure);
  flow.halo().exchange(response.force);
  const LinearSystem& rows = flow.equation->rows;
  const LinearSystem::Part part = rows.whole();
  const std::vector<Vec<Dim>>& x = flow.state.particles.position;
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (flow.role[i] != Role::wall) return;
    double excess = 0.0;
    for (std::size_t k = part.begin[i]; k < part.end[i]; ++k) {
      const auto j = static_cast<std::size_t>(part.column[k]);
      excess += part.weight[k] * response.force[j].dot(x[j] - x[i]);
    }
    response.pressure[i] += rows.scale(i) * excess;
  });
  flow.halo().exchange(response.pressure);
}

/// F of the water, 0 for all other particles.
template <int Dim>
std::vector<Vec<Dim>> force_of(const Flow<Dim>& flow, std::span<const PocketSide<Dim>> sides, int pocket,
                               const std::vector<double>& pressure) {
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<Vec<Dim>> force(particles.size(), Vec<Dim>::Zero());
  flow.discretisation().find_gradient(flow, pressure, std::span(force).first(particles.owned));
  for_each(particles.owned, [&](std::size_t i) {
    force[i] = flow.role[i] == Role::water ? Vec<Dim>(-force[i]) : Vec<Dim>(Vec<Dim>::Zero());
  });
  for (const PocketSide<Dim>& side : sides) {
    for (const PocketShare& share : side.shares) {
      if (share.pocket == pocket) force[side.particle] += share.share * side.push;
    }
  }
  return force;
}

/// The response by the matrix alone.
template <int Dim>
AirResponse<Dim> first_response(Flow<Dim>& flow, std::span<const PocketSide<Dim>> sides, int pocket, int& iterations) {
  LinearSystem& rows = flow.equation->rows;
  std::ranges::fill(rows.rhs(), 0.0);
  for (const PocketSide<Dim>& side : sides) {
    for (const PocketShare& share : side.shares) {
      if (share.pocket == pocket) rows.set_rhs(side.particle, share.share * side.weight);
    }
  }
  AirResponse<Dim> response{shares_of(flow, sides, pocket),
                            std::vector(flow.state.particles.size(), Vec<Dim>(Vec<Dim>::Zero()))};
  const double tolerance = rough_tolerance(flow.equation->solver.tolerance());
  iterations += solve_rows(flow, response.pressure, tolerance).iterations;
  return response;
}

/// Makes one pass of the correction; the next pass corrects the remainder. Returns the largest change.
template <int Dim>
double refine_response(Flow<Dim>& flow, std::span<const PocketSide<Dim>> sides, int pocket, AirResponse<Dim>& response,
                       int& iterations) {
  show_to_walls(flow, response);
  response.force = force_of(flow, sides, pocket, response.pressure);
  const std::vector<Vec<Dim>> at_rest(flow.state.wall_velocity.size(), Vec<Dim>::Zero());
  set_wall_velocities<Dim>(flow, at_rest, response.force);
  std::vector<double> divergence(flow.state.particles.owned, 0.0);
  flow.discretisation().find_divergence(flow, response.force, divergence);
  LinearSystem& rows = flow.equation->rows;
  for_each(divergence.size(), [&](std::size_t i) { rows.set_rhs(i, -divergence[i]); });
  std::vector<double> change(response.pressure.size(), 0.0);
  iterations += solve_rows(flow, change, tolerance_of_pass(flow.equation->solver.tolerance())).iterations;
  extend_to_walls(flow, change);
  flow.halo().exchange(change);
  for_each(change.size(), [&](std::size_t i) { response.pressure[i] += change[i]; });
  return flow.setup.ranks.largest(
      largest_over(divergence.size(), 0.0, [&](std::size_t i) { return std::abs(change[i]); }));
}

/// A new response. Beside films of one or two particles passes may not converge, and their errors grow from pass to
/// pass. A response is between 0 and 1, so the first change is at most 1, and each further one smaller than the last.
template <int Dim>
AirResponse<Dim> begin_response(Flow<Dim>& flow, std::span<const PocketSide<Dim>> sides, int pocket, int& iterations) {
  AirResponse<Dim> response = first_response(flow, sides, pocket, iterations);
  double last = 1.0;
  for (int pass = 0; pass < passes_at_start; ++pass) {
    std::vector<double> before = response.pressure;
    const double change = refine_response(flow, sides, pocket, response, iterations);
    if (change > last) {
      response.pressure = std::move(before);
      break;
    }
    last = change;
  }
  return response;
}

}  // namespace

template <int Dim>
void extend_to_walls(const Flow<Dim>& flow, std::vector<double>& field) {
  flow.halo().exchange(field);
  const LinearSystem& rows = flow.equation->rows;
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (flow.role[i] == Role::wall) field[i] = rows.scale(i) * rows.whole().sum(i, field.data());
  });
}

template <int Dim>
std::vector<double> shares_of(const Flow<Dim>& flow, std::span<const PocketSide<Dim>> sides, int pocket) {
  std::vector<double> field(flow.state.particles.size(), 0.0);
  for (const PocketSide<Dim>& side : sides) {
    for (const PocketShare& share : side.shares) {
      if (share.pocket == pocket) field[side.particle] = share.share;
    }
  }
  extend_to_walls(flow, field);
  return field;
}

template <int Dim>
int find_response(Flow<Dim>& flow, EnclosedAir<Dim>& air, std::span<const PocketSide<Dim>> sides, int pocket) {
  int iterations = 0;
  AirResponse<Dim>& response = air.watch.response(air.state.pockets[pocket].number);
  bool goes_on = !response.pressure.empty();
  if (goes_on) {
    response.pressure.resize(flow.state.particles.size(), 0.0);
    response.force.resize(flow.state.particles.size(), Vec<Dim>::Zero());
    goes_on = refine_response(flow, sides, pocket, response, iterations) <= largest_change;
  }
  if (!goes_on) response = begin_response(flow, sides, pocket, iterations);
  response.force = force_of(flow, sides, pocket, response.pressure);
  return iterations;
}

template <int Dim>
void set_reference_response(const Flow<Dim>& flow, EnclosedAir<Dim>& air, int pocket) {
  const Particles<Dim>& particles = flow.state.particles;
  AirResponse<Dim> response{std::vector(particles.size(), 0.0),
                            std::vector<Vec<Dim>>(particles.size(), Vec<Dim>::Zero())};
  for_each(particles.owned, [&](std::size_t i) {
    if (particles.is_fluid(i) && air.watch.reference_at(particles.position[i]) == pocket) response.pressure[i] = 1.0;
  });
  extend_to_walls(flow, response.pressure);
  flow.halo().exchange(response.pressure);
  for (std::size_t k = 0; k < air.state.pockets.size(); ++k) {
    const int other = static_cast<int>(k);
    if (other == pocket || air.watch.reference_of(other) != pocket) continue;
    const AirResponse<Dim>& of_other = air.watch.response(air.state.pockets[k].number);
    for_each(particles.size(), [&](std::size_t i) {
      response.pressure[i] -= of_other.pressure[i];
      response.force[i] -= of_other.force[i];
    });
  }
  air.watch.response(air.state.pockets[pocket].number) = std::move(response);
}

TAILWATER_IN_2D_AND_3D(extend_to_walls);
TAILWATER_IN_2D_AND_3D(shares_of);
TAILWATER_IN_2D_AND_3D(find_response);
TAILWATER_IN_2D_AND_3D(set_reference_response);

}  // namespace tailwater
