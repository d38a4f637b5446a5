// The particles of one rank: what it owns, then ghosts (copies of particles owned elsewhere: by a periodic image here,
// by another rank later). Structure of arrays; every array has size() entries.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace tailwater {

enum class ParticleKind : std::uint8_t { fluid, wall };

template <int Dim>
struct Particles {
  std::vector<Vec<Dim>> position;  ///< m
  std::vector<Vec<Dim>> velocity;  ///< m/s
  std::vector<double> pressure;    ///< Pa
  std::vector<double> volume;      ///< m^Dim
  std::vector<ParticleKind> kind;
  /// For a wall particle its row in the table of WallParticles; -1 for fluid.
  std::vector<std::int32_t> wall_row;
  std::vector<std::int64_t> id;  ///< unique, given at the start, never reused
  std::size_t owned = 0;

  std::size_t size() const { return position.size(); }
  bool is_fluid(std::size_t i) const { return kind[i] == ParticleKind::fluid; }

  void resize(std::size_t count) {
    position.resize(count);
    velocity.resize(count);
    pressure.resize(count);
    volume.resize(count);
    kind.resize(count);
    wall_row.resize(count);
    id.resize(count);
  }
};

}  // namespace tailwater
