// Sums of forces on hulls (hulls.h), with their moments.
#pragma once

#include <span>
#include <vector>

#include "base/for_each.h"
#include "flow/flow.h"
#include "motion/floating_body.h"
#include "pressure/operators.h"
#include "walls/wall_contact.h"

namespace tailwater {

/// Sums of the forces on each hull, and of their moments about its centre.
template <int Dim>
class ForceSums {
 public:
  ForceSums(const Communicator& ranks, std::vector<Vec<Dim>> centres)
      : ranks_(ranks), centres_(std::move(centres)), sums_(size * centres_.size(), 0.0) {}

  /// Adds a force at `x` and a couple to a hull; no effect if `hull` is -1.
  void add(int hull, const Vec<Dim>& x, const Vec<Dim>& force, const Turn<Dim>& couple = Turn<Dim>::Zero()) {
    if (hull < 0) return;
    const Twist<Dim> both = twist_of<Dim>(force, moment_of<Dim>(x - centres_[hull], force) + couple);
    both.add_to(sums_.data() + static_cast<std::size_t>(hull) * size);
  }

  /// Forces and moments, summed over all ranks. Collective.
  std::vector<Twist<Dim>> gather() {
    ranks_.sum_of_each(sums_);
    std::vector<Twist<Dim>> forces;
    for (std::size_t b = 0; b < centres_.size(); ++b) {
      forces.push_back(Twist<Dim>::Map(sums_.data() + b * size));
    }
    return forces;
  }

 private:
  static constexpr int size = Dim + turns<Dim>;
  const Communicator& ranks_;
  std::vector<Vec<Dim>> centres_;
  std::vector<double> sums_;
};

/// The owned wall particles of hulls; `of_wall` has the hull of each wall, or -1.
template <int Dim>
std::vector<std::size_t> walls_of_hulls(const Flow<Dim>& flow, std::span<const int> of_wall) {
  const Particles<Dim>& particles = flow.state.particles;
  return indices_where(particles.owned, [&](std::size_t i) {
    return !particles.is_fluid(i) && of_wall[flow.walls.particles.wall[particles.wall_row[i]]] >= 0;
  });
}

/// Adds force(n) on each of these wall particles to its hull.
template <int Dim, class Force>
void add_on_hulls(const Flow<Dim>& flow, std::span<const int> of_wall, const std::vector<std::size_t>& walls,
                  ForceSums<Dim>& sums, Force&& force) {
  const WallParticles<Dim>& table = flow.walls.particles;
  for (std::size_t n = 0; n < walls.size(); ++n) {  // in order: all add to the same few sums
    const auto row = flow.state.particles.wall_row[walls[n]];
    sums.add(of_wall[table.wall[row]], table.position[row], force(n));
  }
}

/// Adds the pair forces of a pressure field [Pa] that is up to date on ghosts and on the hulls' particles.
template <int Dim>
void add_pressure_of_pairs(const Flow<Dim>& flow, std::span<const int> of_wall, const std::vector<double>& pressure,
                           ForceSums<Dim>& sums) {
  const std::vector<std::size_t> walls = walls_of_hulls(flow, of_wall);
  const std::vector<Vec<Dim>> pushes = reactions_of_walls<Dim>(flow, walls, pressure);
  add_on_hulls(flow, of_wall, walls, sums,
               [&](std::size_t n) { return Vec<Dim>(-flow.state.particles.volume[walls[n]] * pushes[n]); });
}

/// Adds the reaction of the last guard that kept water in front of hulls.
template <int Dim>
void add_guard(const Flow<Dim>& flow, std::span<const int> of_wall, ForceSums<Dim>& sums) {
  const Particles<Dim>& particles = flow.state.particles;
  const Boundary<Dim>& boundary = flow.walls.boundary;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: all add to the same few sums
    const Vec<Dim>& force = flow.walls.forces.pressure[i];
    if (!particles.is_fluid(i) || force.isZero(0.0)) continue;
    const NearestWall<Dim> nearest =
        boundary.nearest(particles.position[i], search_distance * flow.setup.scale.spacing);
    if (nearest.face < 0) continue;
    sums.add(of_wall[boundary.faces[nearest.face].wall], nearest.point, force);
  }
}

}  // namespace tailwater
