#include "bodies/forces.h"

#include "pressure/operators.h"
#include "walls/wall_contact.h"

namespace tailwater {
namespace {

/// Forces on each body, and their moments about its centre, which add up.
template <int Dim>
class ForceSums {
 public:
  /// With the centres where they are at `time`.
  ForceSums(const Flow<Dim>& flow, double time) : flow_(flow), sums_(size * flow.setup.bodies.size(), 0.0) {
    for (const BodyState<Dim>& body : flow.state.motion.bodies.each) centres_.push_back(body.centre_at(time));
  }

  /// A force at `x` on the body that the wall is of; nothing if it is of none.
  void add(int wall, const Vec<Dim>& x, const Vec<Dim>& force) {
    const int body = flow_.setup.body_of_wall[wall];
    if (body < 0) return;
    Eigen::Map<Twist<Dim>> sum(sums_.data() + static_cast<std::size_t>(body) * size);
    sum.template head<Dim>() += force;
    sum.template tail<turns<Dim>>() += moment_of<Dim>(x - centres_[body], force);
  }

  /// Of all ranks. Collective.
  std::vector<Twist<Dim>> gather() {
    flow_.setup.ranks.sum_of_each(sums_);
    std::vector<Twist<Dim>> forces;
    for (std::size_t b = 0; b < centres_.size(); ++b) {
      forces.push_back(Eigen::Map<const Twist<Dim>>(sums_.data() + b * size));
    }
    return forces;
  }

 private:
  static constexpr int size = Dim + turns<Dim>;
  const Flow<Dim>& flow_;
  std::vector<Vec<Dim>> centres_;
  std::vector<double> sums_;
};

/// Sum over the owned wall particles of bodies of what `force(i)` does to the body of each.
template <int Dim, class Force>
std::vector<Twist<Dim>> sum_on_bodies(const Flow<Dim>& flow, double time, Force&& force) {
  ForceSums<Dim> sums(flow, time);
  const Particles<Dim>& particles = flow.state.particles;
  const WallParticles<Dim>& table = flow.walls.particles;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: all add to the same few sums
    if (particles.is_fluid(i)) continue;
    const auto row = particles.wall_row[i];
    const int wall = table.wall[row];
    if (flow.setup.body_of_wall[wall] >= 0) sums.add(wall, table.position[row], force(i));
  }
  return sums.gather();
}

}  // namespace

template <int Dim>
std::vector<Twist<Dim>> pressure_on_bodies(const Flow<Dim>& flow, const std::vector<double>& pressure, double time) {
  const Particles<Dim>& particles = flow.state.particles;
  return sum_on_bodies(flow, time, [&](std::size_t i) {
    return Vec<Dim>(-particles.volume[i] * push_of_wall_particle(flow, i, pressure));
  });
}

template <int Dim>
std::vector<Twist<Dim>> friction_on_bodies(const Flow<Dim>& flow, double time) {
  return sum_on_bodies(flow, time, [&](std::size_t i) { return flow.wall_forces.friction[i]; });
}

template <int Dim>
std::vector<Twist<Dim>> guard_on_bodies(const Flow<Dim>& flow, double time) {
  ForceSums<Dim> sums(flow, time);
  const Particles<Dim>& particles = flow.state.particles;
  const Boundary<Dim>& boundary = flow.walls.boundary;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: all add to the same few sums
    const Vec<Dim>& force = flow.wall_forces.pressure[i];
    if (!particles.is_fluid(i) || force.isZero(0.0)) continue;
    const NearestWall<Dim> nearest = boundary.nearest(particles.position[i], search_distance * flow.setup.spacing);
    if (nearest.face >= 0) sums.add(boundary.faces[nearest.face].wall, nearest.point, force);
  }
  return sums.gather();
}

#define TAILWATER_INSTANTIATE(Dim)                                                                                \
  template std::vector<Twist<Dim>> pressure_on_bodies<Dim>(const Flow<Dim>&, const std::vector<double>&, double); \
  template std::vector<Twist<Dim>> friction_on_bodies<Dim>(const Flow<Dim>&, double);                             \
  template std::vector<Twist<Dim>> guard_on_bodies<Dim>(const Flow<Dim>&, double);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
