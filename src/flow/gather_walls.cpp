#include "base/for_each.h"
#include "flow/distribution.h"
#include "flow/stages.h"
#include "flow/wall_particle.h"
#include "neighbours/neighbourhood.h"

namespace tailwater {
namespace {

/// Where the particle of a row of the table stands.
template <int Dim>
Vec<Dim> place_of_row(const Flow<Dim>& flow, std::int32_t row) {
  return flow.neighbourhood->wrapped(flow.walls.particles.position[row]);
}

/// Hands rows to the ranks in whose parts of space they stand; returns those that came, or were here.
template <int Dim>
std::vector<std::int32_t> hand_to_owners(Flow<Dim>& flow, std::vector<std::int32_t> rows) {
  const Communicator& ranks = flow.setup.ranks;
  if (ranks.is_alone()) return rows;
  std::vector<std::vector<std::int32_t>> sent(static_cast<std::size_t>(ranks.size()));
  for (const std::int32_t row : rows)
    sent[flow.distribution->decomposition.cuts().part_of(place_of_row(flow, row))].push_back(row);
  std::vector<std::int32_t> own = std::move(sent[ranks.rank()]);
  sent[ranks.rank()].clear();
  const std::size_t first = flow.distribution->shared_rows.hand_out(flow.walls, sent);
  for (std::size_t row = first; row < flow.walls.particles.size(); ++row) own.push_back(static_cast<std::int32_t>(row));
  return own;
}

/// Makes particles of the rows from all ranks that stand in this rank's part of space. Ghosts and lists are discarded.
template <int Dim>
void add_walls(Flow<Dim>& flow, std::vector<std::int32_t> rows) {
  Particles<Dim>& particles = flow.state.particles;
  const std::vector<std::int32_t> own = hand_to_owners(flow, std::move(rows));
  flow.neighbourhood->forget(particles);
  particles.add(own.size(), [&](std::size_t n) {
    NewParticle<Dim> particle = wall_particle(flow.setup, flow.walls.particles, own[n]);
    particle.position = place_of_row(flow, own[n]);
    return particle;
  });
}

}  // namespace

template <int Dim>
void gather_walls(Flow<Dim>& flow) {
  if (!flow.setup.ranks.any(flow.distribution->near_walls.misses_some(flow.state.particles))) return;
  add_walls<Dim>(flow, flow.distribution->near_walls.update(flow.walls, flow.state.particles, FarWalls::kept));
}

template <int Dim>
void regather_walls(Flow<Dim>& flow) {
  Particles<Dim>& particles = flow.state.particles;
  std::vector<std::int32_t> arrived = flow.distribution->near_walls.update(flow.walls, particles, FarWalls::dropped);
  const std::vector<std::size_t> kept = indices_where(particles.owned, [&](std::size_t i) {
    return particles.is_fluid(i) || flow.distribution->near_walls.is_near(flow.walls, particles.wall_row[i]);
  });
  if (kept.size() < particles.owned) {
    flow.neighbourhood->keep(particles, std::vector<std::int32_t>(kept.begin(), kept.end()));
  }
  flow.distribution->shared_rows.drop_halo_rows(flow.walls, particles);
  add_walls<Dim>(flow, std::move(arrived));
}

TAILWATER_IN_2D_AND_3D(gather_walls);
TAILWATER_IN_2D_AND_3D(regather_walls);

}  // namespace tailwater
