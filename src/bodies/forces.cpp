#include "bodies/forces.h"

#include "air/pocket_pressure.h"
#include "pressure/operators.h"
#include "walls/wall_contact.h"

namespace tailwater {
namespace {

/// Sums of the forces on each body, and of their moments about its centre.
template <int Dim>
class ForceSums {
 public:
  /// `time` [s] determines the centres of the bodies.
  ForceSums(const Flow<Dim>& flow, double time) : flow_(flow), sums_(size * flow.state.motion.bodies.each.size(), 0.0) {
    for (const BodyState<Dim>& body : flow.state.motion.bodies.each) centres_.push_back(body.centre_at(time));
  }

  /// Adds a force at `x` and a couple to a body; no effect if `body` is -1.
  void add(int body, const Vec<Dim>& x, const Vec<Dim>& force, const Turn<Dim>& couple = Turn<Dim>::Zero()) {
    if (body < 0) return;
    const Twist<Dim> both = twist_of<Dim>(force, moment_of<Dim>(x - centres_[body], force) + couple);
    both.add_to(sums_.data() + static_cast<std::size_t>(body) * size);
  }

  /// Forces and moments, summed over all ranks. Collective.
  std::vector<Twist<Dim>> gather() {
    flow_.setup.ranks.sum_of_each(sums_);
    std::vector<Twist<Dim>> forces;
    for (std::size_t b = 0; b < centres_.size(); ++b) {
      forces.push_back(Twist<Dim>::Map(sums_.data() + b * size));
    }
    return forces;
  }

 private:
  static constexpr int size = Dim + turns<Dim>;
  const Flow<Dim>& flow_;
  std::vector<Vec<Dim>> centres_;
  std::vector<double> sums_;
};

/// The owned wall particles of bodies.
template <int Dim>
std::vector<std::size_t> walls_of_bodies(const Flow<Dim>& flow, const FloatingBodies<Dim>& bodies) {
  const Particles<Dim>& particles = flow.state.particles;
  return indices_where(particles.owned, [&](std::size_t i) {
    return !particles.is_fluid(i) && bodies.body_of_wall[flow.walls.particles.wall[particles.wall_row[i]]] >= 0;
  });
}

/// Adds force(n) on each of these wall particles of bodies to its body.
template <int Dim, class Force>
void add_on_bodies(const Flow<Dim>& flow, const FloatingBodies<Dim>& bodies, const std::vector<std::size_t>& walls,
                   ForceSums<Dim>& sums, Force&& force) {
  const WallParticles<Dim>& table = flow.walls.particles;
  for (std::size_t n = 0; n < walls.size(); ++n) {  // in order: all add to the same few sums
    const auto row = flow.state.particles.wall_row[walls[n]];
    sums.add(bodies.body_of_wall[table.wall[row]], table.position[row], force(n));
  }
}

}  // namespace

template <int Dim>
std::vector<Twist<Dim>> ForcesOnBodies<Dim>::of_pressure(const std::vector<double>& pressure) const {
  const Particles<Dim>& particles = flow_.state.particles;
  const std::vector<std::size_t> walls = walls_of_bodies(flow_, bodies_);
  const std::vector<Vec<Dim>> pushes = reactions_of_walls<Dim>(flow_, walls, pressure);
  ForceSums<Dim> sums(flow_, time_);
  add_on_bodies(flow_, bodies_, walls, sums,
                [&](std::size_t n) { return Vec<Dim>(-particles.volume[walls[n]] * pushes[n]); });
  return sums.gather();
}

template <int Dim>
std::vector<Twist<Dim>> ForcesOnBodies<Dim>::of_gaps(const std::vector<double>& pressure,
                                                     const NarrowGaps<Dim>& gaps) const {
  ForceSums<Dim> sums(flow_, time_);
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
  ForceSums<Dim> sums(flow_, time_);
  for (const PocketWall<Dim>& wall : air_of(flow_).step.walls) {
    if (!flow_.setup.ranks.is_root()) break;
    const double pressure = pressure_at<Dim>(wall, pressures);
    sums.add(bodies_.body_of_wall[wall.wall], wall.x, pressure * wall.area, pressure * wall.couple);
  }
  return sums.gather();
}

template <int Dim>
std::vector<Twist<Dim>> ForcesOnBodies<Dim>::of_friction() const {
  const std::vector<std::size_t> walls = walls_of_bodies(flow_, bodies_);
  ForceSums<Dim> sums(flow_, time_);
  add_on_bodies(flow_, bodies_, walls, sums, [&](std::size_t n) { return flow_.wall_forces.friction[walls[n]]; });
  return sums.gather();
}

template <int Dim>
std::vector<Twist<Dim>> ForcesOnBodies<Dim>::of_guard() const {
  ForceSums<Dim> sums(flow_, time_);
  const Particles<Dim>& particles = flow_.state.particles;
  const Boundary<Dim>& boundary = flow_.walls.boundary;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: all add to the same few sums
    const Vec<Dim>& force = flow_.wall_forces.pressure[i];
    if (!particles.is_fluid(i) || force.isZero(0.0)) continue;
    const NearestWall<Dim> nearest =
        boundary.nearest(particles.position[i], search_distance * flow_.setup.scale.spacing);
    if (nearest.face < 0) continue;
    sums.add(bodies_.body_of_wall[boundary.faces[nearest.face].wall], nearest.point, force);
  }
  return sums.gather();
}

template class ForcesOnBodies<2>;
template class ForcesOnBodies<3>;

}  // namespace tailwater
