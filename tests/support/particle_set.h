// Sets of fluid particles for tests: blocks of a lattice, regular or jittered, with their neighbourhood.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "neighbours/neighbourhood.h"

namespace tailwater {

/// Uniform numbers in [-1, 1), the same on every machine: SplitMix64 (Steele, Lea & Flood 2014).
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}

  double operator()() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
  }

  template <int Dim>
  Vec<Dim> vector() {
    Vec<Dim> result;
    for (int d = 0; d < Dim; ++d) result[d] = (*this)();
    return result;
  }

 private:
  std::uint64_t state_;
};

/// Fluid particles of volume dx^Dim at the given places, at rest, ids in order.
template <int Dim>
Particles<Dim> fluid_at(std::span<const Vec<Dim>> positions, double spacing) {
  Particles<Dim> particles;
  particles.resize(positions.size());
  particles.owned = positions.size();
  std::copy(positions.begin(), positions.end(), particles.position.begin());
  std::fill(particles.velocity.begin(), particles.velocity.end(), Vec<Dim>::Zero());
  std::fill(particles.pressure.begin(), particles.pressure.end(), 0.0);
  std::fill(particles.volume.begin(), particles.volume.end(), power<Dim>(spacing));
  std::fill(particles.kind.begin(), particles.kind.end(), ParticleKind::fluid);
  std::fill(particles.wall_row.begin(), particles.wall_row.end(), -1);
  std::iota(particles.id.begin(), particles.id.end(), std::int64_t{0});
  return particles;
}

/// Lattice points low + dx n, 0 <= n_d < count_d, first direction fastest.
template <int Dim>
std::vector<Vec<Dim>> lattice_points(const Vec<Dim>& low, const std::array<int, Dim>& count, double spacing) {
  std::vector<Vec<Dim>> points;
  std::array<int, Dim> n{};
  for (;;) {
    Vec<Dim> point = low;
    for (int d = 0; d < Dim; ++d) point[d] += spacing * n[d];
    points.push_back(point);
    int d = 0;
    while (d < Dim && ++n[d] == count[d]) n[d++] = 0;
    if (d == Dim) return points;
  }
}

/// A cube of `count`^Dim lattice points around the origin, each moved by up to jitter dx per coordinate. The same
/// count, jitter and seed give the same set at every spacing, only scaled.
template <int Dim>
std::vector<Vec<Dim>> jittered_cube(int count, double spacing, double jitter, std::uint64_t seed = 1) {
  std::array<int, Dim> counts;
  counts.fill(count);
  std::vector<Vec<Dim>> points = lattice_points<Dim>(Vec<Dim>::Constant(-0.5 * (count - 1) * spacing), counts, spacing);
  Noise noise(seed);
  for (Vec<Dim>& point : points) point += jitter * spacing * noise.vector<Dim>();
  return points;
}

/// Particles with up-to-date neighbours.
template <int Dim>
struct ParticleSet {
  ParticleSet(Particles<Dim> all, const Kernel<Dim>& kernel, double dx, PeriodicDomain<Dim> domain = {},
              SpacingField<Dim> field = {})
      : particles(std::move(all)),
        neighbourhood(kernel, dx, 0.2 * dx, WallRows::all, std::move(domain), {}, std::move(field)),
        spacing(dx) {
    neighbourhood.update(particles);
  }
  ParticleSet(std::span<const Vec<Dim>> positions, const Kernel<Dim>& kernel, double dx,
              PeriodicDomain<Dim> domain = {})
      : ParticleSet(fluid_at<Dim>(positions, dx), kernel, dx, std::move(domain)) {}

  const Pairs<Dim>& pairs() const { return neighbourhood.pairs(); }
  std::size_t size() const { return particles.size(); }
  const Vec<Dim>& position(std::size_t i) const { return particles.position[i]; }

  Particles<Dim> particles;
  Neighbourhood<Dim> neighbourhood;
  double spacing;
};

/// A jittered cube of fluid with a kernel that reaches three spacings.
template <int Dim>
ParticleSet<Dim> jittered_block(double spacing) {
  return ParticleSet<Dim>(jittered_cube<Dim>(Dim == 2 ? 14 : 8, spacing, 0.3),
                          make_kernel<Dim>(KernelName::wendland_c2, 3.0 * spacing), spacing);
}

/// `function` at every particle, ghosts included.
template <int Dim, class Function>
auto sample(const ParticleSet<Dim>& set, Function&& function) {
  std::vector<std::decay_t<decltype(function(set.position(0)))>> field;
  field.reserve(set.size());
  for (const Vec<Dim>& position : set.particles.position) field.push_back(function(position));
  return field;
}

}  // namespace tailwater
