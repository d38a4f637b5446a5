#include "bodies/forces.h"

#include "air/pocket_pressure.h"
#include "bodies/force_sums.h"

namespace tailwater {
namespace {

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
