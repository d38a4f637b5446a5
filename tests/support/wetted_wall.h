// Water above a flat wall, for tests of wall models.
#pragma once

#include <memory>
#include <vector>

#include "operators/lattice.h"
#include "support/particle_set.h"
#include "walls/wall_friction.h"
#include "walls/wet_walls.h"

namespace tailwater {

inline constexpr double wetted_dx = 0.1;

/// A cube of fluid above the plane y = 0 and two layers of wall particles under it (a third would be 3 dx away). The
/// last wall particle is far from all others and dry. All wall particles block the directions that `blocked` projects
/// on.
template <int Dim>
struct WettedWall {
  WettedWall(const Mat<Dim>& blocked, double friction, std::unique_ptr<const WallModel<Dim>> chosen)
      : set(particles(), make_kernel<Dim>(KernelName::wendland_c2, 3.0 * wetted_dx), wetted_dx),
        model(std::move(chosen)) {
    surroundings.resize(set.size(), false);
    for (std::size_t i = 0; i < set.size(); ++i) {
      if (set.particles.is_fluid(i)) continue;
      walls.particles.position.push_back(set.position(i));
      walls.particles.normal.push_back(Vec<Dim>::UnitY());
      walls.particles.blocked.push_back(blocked);
      walls.particles.beyond_edges.push_back(Mat<Dim>::Zero());
      walls.particles.is_beyond_end.push_back(0);
      walls.particles.wall.push_back(0);
      walls.particles.number.push_back(static_cast<std::int64_t>(walls.particles.number.size()));
      walls.friction.push_back(friction);
      walls.roughness.push_back(0.0);
      walls.depth.push_back(-set.position(i)[1]);
      V.push_back(Vec<Dim>::Zero());
    }
    find_wet_walls<Dim>(set.pairs(), set.particles, kernel_value(set.neighbourhood.kernel(), 0.0),
                        surroundings.wall_fluid_weight, surroundings.is_wet);
  }

  static Particles<Dim> particles() {
    std::array<int, Dim> count;
    count.fill(7);
    Vec<Dim> low = Vec<Dim>::Constant(0.5 * wetted_dx);
    std::vector<Vec<Dim>> points = lattice_points<Dim>(low, count, wetted_dx);
    const std::size_t fluid_count = points.size();
    count[1] = 2;
    low[1] = -1.5 * wetted_dx;
    const auto wall = lattice_points<Dim>(low, count, wetted_dx);
    points.insert(points.end(), wall.begin(), wall.end());
    points.push_back(Vec<Dim>::Constant(-9.0));
    Particles<Dim> all = fluid_at<Dim>(points, wetted_dx);
    for (std::size_t i = fluid_count; i < all.owned; ++i) {
      all.kind[i] = ParticleKind::wall;
      all.wall_row[i] = static_cast<std::int32_t>(i - fluid_count);
    }
    return all;
  }

  std::vector<Vec<Dim>> with_walls(std::vector<Vec<Dim>> velocity) {
    model->show_velocity(scene(), V, velocity);
    return velocity;
  }

  /// The acceleration by friction for this velocity, walls included.
  std::vector<Vec<Dim>> friction_acceleration(const FrictionLaw& law, const std::vector<Vec<Dim>>& velocity) const {
    std::vector<Vec<Dim>> no_slip(set.size(), Vec<Dim>::Zero());
    std::vector<Vec<Dim>> acceleration(set.size(), Vec<Dim>::Zero());
    model->find_no_slip_velocity(scene(), V, velocity, no_slip);
    add_wall_friction<Dim>(scene(), law, friction_walls(law, velocity), no_slip, velocity, acceleration);
    return acceleration;
  }

  std::vector<FrictionWall<Dim>> friction_walls(const FrictionLaw& law, const std::vector<Vec<Dim>>& velocity) const {
    return find_friction_walls<Dim>(scene(), law, V, velocity);
  }

  WallScene<Dim> scene() const { return {set.pairs(), set.particles, walls, surroundings}; }

  ParticleSet<Dim> set;
  std::unique_ptr<const WallModel<Dim>> model;
  Walls<Dim> walls;
  std::vector<Vec<Dim>> V;
  Surroundings<Dim> surroundings;
};

template <int Dim>
FrictionLaw friction_law(double viscosity) {
  const Kernel<Dim> kernel = make_kernel<Dim>(KernelName::wendland_c2, 3.0 * wetted_dx);
  return {.viscosity = viscosity,
          .spacing = wetted_dx,
          .exchange_length = 1.0 / lattice_sums<Dim>(kernel, wetted_dx).across_plane};
}

template <int Dim>
Mat<Dim> flat() {
  return Vec<Dim>::UnitY() * Vec<Dim>::UnitY().transpose();
}

template <int Dim>
Vec<Dim> some_velocity() {
  Vec<Dim> u = Vec<Dim>::Constant(0.4);
  u[0] = 1.3;
  u[1] = -0.7;
  return u;
}

}  // namespace tailwater
