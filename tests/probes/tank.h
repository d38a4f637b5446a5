// A tank of still water on a lattice, walls as three rows of dummies: what every probe can be checked on by hand.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "probes/context.h"

namespace tailwater {

template <int Dim>
struct Tank {
  static constexpr double dx = 0.05;
  static constexpr double width = 1.0;   ///< m; of the inside, in every horizontal direction
  static constexpr double height = 1.5;  ///< m; of the walls
  static constexpr double rho = 1000.0;
  static constexpr double g = 9.81;

  CaseSpec spec;
  Boundary<Dim> boundary;
  Particles<Dim> particles;
  Kernel<Dim> kernel;
  CellGrid<Dim> grid;

  /// Water where `is_water(x)`, with the hydrostatic pressure rho g (level - z) of a tank filled to `level`.
  explicit Tank(double level, const std::function<bool(const Vec<Dim>&)>& is_water,
                KernelName kernel_name = KernelName::wendland_c2)
      : kernel(make_kernel<Dim>(kernel_name, 3.0 * dx)) {
    spec.general.dimension = Dim;
    spec.particles.spacing = dx;
    spec.physics.gravity.assign(Dim, 0.0);
    spec.physics.gravity.back() = -g;
    spec.walls.resize(1);
    spec.walls[0].shape = WallShape::box;
    spec.walls[0].fluid_side = FluidSide::inside;
    spec.walls[0].min.assign(Dim, 0.0);
    spec.walls[0].max.assign(Dim, width);
    spec.walls[0].max.back() = height;
    spec.walls[0].open = {Dim == 2 ? "+y" : "+z"};
    boundary = make_boundary<Dim>(spec);

    constexpr int layers = 3;
    const int across = static_cast<int>(std::lround(width / dx));
    const int high = static_cast<int>(std::lround(height / dx));
    const int depth_low = Dim == 3 ? -layers : 0;
    const int depth_high = Dim == 3 ? across + layers : 1;
    for (int k = -layers; k < high; ++k) {
      for (int j = depth_low; j < depth_high; ++j) {
        for (int i = -layers; i < across + layers; ++i) {
          const bool is_inside = k >= 0 && i >= 0 && i < across && (Dim == 2 || (j >= 0 && j < across));
          Vec<Dim> x = Vec<Dim>::Constant((j + 0.5) * dx);
          x[0] = (i + 0.5) * dx;
          x[Dim - 1] = (k + 0.5) * dx;
          if (!is_inside || is_water(x)) add(x, is_inside, rho * g * (level - x[Dim - 1]));
        }
      }
    }
    locate();
  }

  /// Full up to `level`.
  static Tank filled(double level, KernelName kernel_name = KernelName::wendland_c2) {
    return Tank(
        level, [level](const Vec<Dim>& x) { return x[Dim - 1] < level; }, kernel_name);
  }

  void add(const Vec<Dim>& x, bool is_fluid, double pressure) {
    particles.position.push_back(x);
    particles.velocity.push_back(Vec<Dim>::Zero());
    particles.pressure.push_back(pressure);
    particles.volume.push_back(power<Dim>(dx));
    particles.kind.push_back(is_fluid ? ParticleKind::fluid : ParticleKind::wall);
    particles.wall_row.push_back(-1);
    particles.id.push_back(static_cast<std::int64_t>(particles.id.size()));
    particles.owned = particles.size();
  }

  /// To be called after particles were added or moved.
  void locate() { grid = CellGrid<Dim>(particles.position, 3.0 * dx); }

  /// Gives the walls the acceleration (x) of the whole tank, and the water the pressure that belongs to it.
  void accelerate(double a) {
    blocked.assign(particles.size(), Mat<Dim>::Zero());
    acceleration.assign(particles.size(), Vec<Dim>::Zero());
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const Vec<Dim>& x = particles.position[i];
      particles.pressure[i] += rho * a * (width - x[0]);
      if (particles.is_fluid(i)) continue;
      particles.wall_row[i] = static_cast<std::int32_t>(i);
      for (int d = 0; d < Dim; ++d) blocked[i](d, d) = x[d] < 0.0 || (d < Dim - 1 && x[d] > width) ? 1.0 : 0.0;
      acceleration[i] = blocked[i] * (a * Vec<Dim>::Unit(0));
    }
  }
  std::vector<Mat<Dim>> blocked;
  std::vector<Vec<Dim>> acceleration;

  ProbeContext<Dim> context(double time = 0.0) const {
    Vec<Dim> gravity = Vec<Dim>::Zero();
    gravity[Dim - 1] = -g;
    return {particles, grid, kernel, boundary, rho, gravity, dx, time, {}};
  }

  /// The point at `x` from the left (and in the middle in 3D), `z` above the floor.
  static Coordinates at(double x, double z) { return Dim == 2 ? Coordinates{x, z} : Coordinates{x, 0.5 * width, z}; }
};

inline ProbeTable probe_at(ProbeType type, const Coordinates& at) {
  ProbeTable probe;
  probe.name = "test";
  probe.type = type;
  probe.at = at;
  return probe;
}

inline ProbeTable probe_along(ProbeType type, const Coordinates& from, const Coordinates& to) {
  ProbeTable probe;
  probe.name = "test";
  probe.type = type;
  probe.from = from;
  probe.to = to;
  return probe;
}

}  // namespace tailwater
