#include "bodies/forces.h"

#include "air/pocket_pressure.h"
#include "bodies/force_sums.h"
#include "pressure/wet_patches.h"

namespace tailwater {
namespace {

/// Largest error of pairs around a body, over the sum of the magnitudes of the forces. Disorder reaches 0.01, the
/// beginning of the balanced pressure 0.03.
constexpr double max_error_of_pairs = 0.1;

/// Sums about the centres of the bodies at `time` [s].
template <int Dim>
ForceSums<Dim> sums_on_bodies(const Flow<Dim>& flow, double time) {
  std::vector<Vec<Dim>> centres;
  for (const BodyState<Dim>& body : flow.state.motion.bodies.each) centres.push_back(body.centre_at(time));
  return ForceSums<Dim>(flow.setup.ranks, std::move(centres));
}

}  // namespace

template <int Dim>
std::vector<Twist<Dim>> ForcesOnBodies<Dim>::of_pressure(const std::vector<double>& pressure) const {
  ForceSums<Dim> sums = sums_on_bodies(flow_, time_);
  add_pressure_of_pairs<Dim>(flow_, bodies_.body_of_wall, pressure, sums);
  return sums.gather();
}

template <int Dim>
std::vector<Twist<Dim>> ForcesOnBodies<Dim>::of_gaps(const std::vector<double>& pressure,
                                                     const NarrowGaps<Dim>& gaps) const {
  ForceSums<Dim> sums = sums_on_bodies(flow_, time_);
  const bool is_root = flow_.setup.ranks.is_root();
  gaps.visit_forces(pressure, [&](int body, const Vec<Dim>& x, const Vec<Dim>& force, const Turn<Dim>& couple) {
    if (is_root) sums.add(body, x, force, couple);
  });
  gaps.visit_pairs_in_films(pressure,
                            [&](int body, const Vec<Dim>& x, const Vec<Dim>& force) { sums.add(body, x, -force); });
  return sums.gather();
}

template <int Dim>
std::vector<Twist<Dim>> ForcesOnBodies<Dim>::of_air(std::span<const double> pressures) const {
  ForceSums<Dim> sums = sums_on_bodies(flow_, time_);
  for (const PocketWall<Dim>& wall : air_of(flow_).step.walls) {
    if (!flow_.setup.ranks.is_root()) break;
    const double pressure = pressure_at<Dim>(wall, pressures);
    sums.add(bodies_.body_of_wall[wall.wall], wall.x, pressure * wall.area, pressure * wall.couple);
  }
  return sums.gather();
}

template <int Dim>
std::vector<Twist<Dim>> ForcesOnBodies<Dim>::error_of_pairs(const BalancedPressure<Dim>& balanced,
                                                            std::vector<double>& thrust) const {
  ForceSums<Dim> sums = sums_on_bodies(flow_, time_);
  const std::vector<double> q = balanced.at_each(flow_.state.particles.position);
  add_pressure_of_pairs<Dim>(flow_, bodies_.body_of_wall, q, sums);
  thrust.assign(bodies_.bodies.size(), 0.0);
  const Boundary<Dim>& boundary = flow_.walls.boundary;
  std::vector<const WallPatch<Dim>*> patches;
  std::vector<PatchInReach<Dim>> in_reach;
  for (const WallPatch<Dim>& patch : bodies_.patches) {
    const Vec<Dim> x = patch.centre(boundary);
    if (balanced.at(x) <= 0.0) continue;
    patches.push_back(&patch);
    in_reach.push_back({.face = patch.face, .centre = x});
  }
  const WetPatches<Dim> wet(flow_, in_reach);
  for (std::size_t n = 0; n < patches.size(); ++n) {
    if (!wet.is_wet(n)) continue;
    const WallFace<Dim>& face = boundary.faces[patches[n]->face];
    const int body = bodies_.body_of_wall[face.wall];
    const Vec<Dim>& x = in_reach[n].centre;
    const Vec<Dim> against = balanced.on_wall(x, face.normal) * patches[n]->measure * face.normal;
    thrust[body] += against.norm();
    if (flow_.setup.ranks.is_root()) sums.add(body, x, against);
  }
  return sums.gather();
}

template <int Dim>
std::vector<std::optional<Twist<Dim>>> ForcesOnBodies<Dim>::errors_of_pairs() const {
  using Balanced = BalancedPressure<Dim>;
  std::vector<std::optional<Twist<Dim>>> errors(bodies_.bodies.size(), std::optional<Twist<Dim>>(Twist<Dim>::Zero()));
  const Balanced balanced(flow_);
  if (balanced.is_linear()) return errors;
  std::vector<double> thrust;
  const std::vector<Twist<Dim>> used = error_of_pairs(balanced, thrust);
  const StepMemory& memory = flow_.state.last_step;
  const std::vector<Twist<Dim>> in_all_water =
      memory.lowest_unbalanced == memory.lowest_beside_air
          ? used
          : error_of_pairs(Balanced(flow_, Balanced::Extent::all_water), thrust);
  for (std::size_t b = 0; b < errors.size(); ++b) {
    const bool is_in_water = in_all_water[b].template head<Dim>().norm() <= max_error_of_pairs * thrust[b];
    errors[b] = is_in_water ? std::optional(used[b]) : std::nullopt;
  }
  return errors;
}

template <int Dim>
std::vector<Twist<Dim>> ForcesOnBodies<Dim>::of_friction() const {
  const std::vector<std::size_t> walls = walls_of_hulls<Dim>(flow_, bodies_.body_of_wall);
  ForceSums<Dim> sums = sums_on_bodies(flow_, time_);
  add_on_hulls<Dim>(flow_, bodies_.body_of_wall, walls, sums,
                    [&](std::size_t n) { return flow_.walls.forces.friction[walls[n]]; });
  return sums.gather();
}

template <int Dim>
std::vector<Twist<Dim>> ForcesOnBodies<Dim>::of_guard() const {
  ForceSums<Dim> sums = sums_on_bodies(flow_, time_);
  add_guard<Dim>(flow_, bodies_.body_of_wall, sums);
  return sums.gather();
}

template class ForcesOnBodies<2>;
template class ForcesOnBodies<3>;

}  // namespace tailwater
