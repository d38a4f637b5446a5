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

  /// A force at `x`; nothing if `body` is -1.
  void add(int body, const Vec<Dim>& x, const Vec<Dim>& force) {
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

/// Adds what `force(i)` does to the body of each owned wall particle i of a body.
template <int Dim, class Force>
void add_of_bodies(const Flow<Dim>& flow, ForceSums<Dim>& sums, Force&& force) {
  const Particles<Dim>& particles = flow.state.particles;
  const WallParticles<Dim>& table = flow.walls.particles;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: all add to the same few sums
    if (particles.is_fluid(i)) continue;
    const auto row = particles.wall_row[i];
    const int body = flow.setup.body_of_wall[table.wall[row]];
    if (body >= 0) sums.add(body, table.position[row], force(i));
  }
}

}  // namespace

template <int Dim>
std::vector<Twist<Dim>> ForcesOnBodies<Dim>::of_pressure(const std::vector<double>& pressure,
                                                         const std::vector<CoveredParticle>& covered) const {
  const Particles<Dim>& particles = flow_.state.particles;
  const auto force = [&](std::size_t i) {
    return Vec<Dim>(-particles.volume[i] * push_of_wall_particle(flow_, i, pressure));
  };
  ForceSums<Dim> sums(flow_, time_);
  add_of_bodies(flow_, sums, force);
  for (const CoveredParticle& one : covered) {
    sums.add(one.body, flow_.walls.particles.position[particles.wall_row[one.i]], one.share * force(one.i));
  }
  return sums.gather();
}

template <int Dim>
std::vector<Twist<Dim>> ForcesOnBodies<Dim>::of_friction() const {
  ForceSums<Dim> sums(flow_, time_);
  add_of_bodies(flow_, sums, [&](std::size_t i) { return flow_.wall_forces.friction[i]; });
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
    const NearestWall<Dim> nearest = boundary.nearest(particles.position[i], search_distance * flow_.setup.spacing);
    if (nearest.face < 0) continue;
    sums.add(flow_.setup.body_of_wall[boundary.faces[nearest.face].wall], nearest.point, force);
  }
  return sums.gather();
}

template class ForcesOnBodies<2>;
template class ForcesOnBodies<3>;

}  // namespace tailwater
