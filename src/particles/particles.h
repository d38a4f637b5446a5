// Particles of one rank: those that it owns, then ghosts (copies of particles of other ranks, and periodic images).
// Structure of arrays; every array has size() entries.
#pragma once

#include <cstdint>
#include <vector>

#include "base/for_each.h"
#include "base/vec.h"

namespace tailwater {

/// m; distance from walls for water that no wall with friction influences.
inline constexpr double far_from_walls = 1e30;

enum class ParticleKind : std::uint8_t { fluid, wall };

/// Initial values of a particle: of water, or of a row of the table of wall particles.
template <int Dim>
struct NewParticle {
  Vec<Dim> position;                     ///< m
  Vec<Dim> velocity = Vec<Dim>::Zero();  ///< m/s
  double pressure = 0.0;                 ///< Pa
  double volume;                         ///< m^Dim
  std::int64_t id;
  std::int32_t wall_row = -1;  ///< -1: water
};

template <int Dim>
struct Particles {
  std::vector<Vec<Dim>> position;  ///< m
  std::vector<Vec<Dim>> velocity;  ///< m/s
  std::vector<double> pressure;    ///< Pa
  /// Pa; solution of the last step's second projection before the limit on negative pressure; 0 without a second
  /// projection. Each projection uses its last solution as initial guess.
  std::vector<double> second_pressure;
  std::vector<double> volume;  ///< m^Dim
  std::vector<ParticleKind> kind;
  /// For a wall particle its row in this rank's table of walls; -1 for fluid. Recomputed from the id wherever particles
  /// or ghosts arrive.
  std::vector<std::int32_t> wall_row;
  /// m^2/s; nu~ of Spalart & Allmaras, 0 where there is no boundary layer (closures/spalart_allmaras.h).
  std::vector<double> layer_viscosity;
  /// m; of fluid, from the nearest wall with friction, measured through the water; far_from_walls at the start and in
  /// spray.
  std::vector<double> wall_distance;
  std::vector<std::int64_t> id;  ///< unique, given at the start, never reused
  std::size_t owned = 0;

  std::size_t size() const { return position.size(); }
  bool is_fluid(std::size_t i) const { return kind[i] == ParticleKind::fluid; }

  /// Calls body with references to all fields.
  template <class Body>
  void apply_to_fields(Body&& body) {
    apply(*this, body);
  }
  template <class Body>
  void apply_to_fields(Body&& body) const {
    apply(*this, body);
  }

  void resize(std::size_t count) {
    apply_to_fields([count](auto&... field) { (field.resize(count), ...); });
  }

  /// Appends `count` owned particles, the n-th with the values of make(n). There must be no ghosts. Particles are
  /// created nowhere else.
  template <class Make>
  void add(std::size_t count, Make&& make) {
    const std::size_t before = owned;
    owned += count;
    resize(owned);
    for_each(count, [&](std::size_t n) { set(before + n, make(n)); });
  }

 private:
  void set(std::size_t i, const NewParticle<Dim>& made) {
    position[i] = made.position;
    velocity[i] = made.velocity;
    pressure[i] = made.pressure;
    second_pressure[i] = 0.0;
    volume[i] = made.volume;
    kind[i] = made.wall_row < 0 ? ParticleKind::fluid : ParticleKind::wall;
    wall_row[i] = made.wall_row;
    layer_viscosity[i] = 0.0;
    wall_distance[i] = far_from_walls;
    id[i] = made.id;
  }

  template <class Self, class Body>
  static void apply(Self& self, Body& body) {
    body(self.position, self.velocity, self.pressure, self.second_pressure, self.volume, self.kind, self.wall_row,
         self.layer_viscosity, self.wall_distance, self.id);
  }
};

}  // namespace tailwater
