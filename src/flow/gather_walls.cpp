#include "base/for_each.h"
#include "flow/verbs.h"

namespace tailwater {
namespace {

/// Makes particles of those of the rows that stand in this rank's part of space. Ghosts and lists are forgotten.
template <int Dim>
void add_walls(Flow<Dim>& flow, std::span<const std::int32_t> rows) {
  const Communicator& ranks = flow.setup.ranks;
  Particles<Dim>& particles = flow.state.particles;
  const auto place_of = [&](std::int32_t row) {
    return flow.neighbourhood.wrapped(flow.walls.particles.position[row]);
  };
  std::vector<std::int32_t> own;
  for (const std::int32_t row : rows) {
    if (ranks.is_alone() || flow.decomposition.cuts().part_of(place_of(row)) == ranks.rank()) own.push_back(row);
  }
  flow.neighbourhood.forget(particles);
  const std::size_t before = particles.owned;
  particles.owned += own.size();
  particles.resize(particles.owned);
  for_each(own.size(), [&](std::size_t n) {
    const std::size_t i = before + n;
    particles.position[i] = place_of(own[n]);
    particles.velocity[i].setZero();
    particles.pressure[i] = 0.0;
    particles.volume[i] = flow.walls.particles.share[own[n]] * power<Dim>(flow.setup.spacing);
    particles.kind[i] = ParticleKind::wall;
    particles.wall_row[i] = own[n];
    particles.id[i] = flow.setup.first_wall_id + own[n];
  });
  flow.end_of.resize(particles.owned, -1);
}

}  // namespace

template <int Dim>
void gather_walls(Flow<Dim>& flow) {
  if (!flow.setup.ranks.any(flow.near_walls.misses_some(flow.state.particles))) return;
  add_walls<Dim>(flow, flow.near_walls.update(flow.setup.ranks, flow.state.particles, false));
}

template <int Dim>
void regather_walls(Flow<Dim>& flow) {
  Particles<Dim>& particles = flow.state.particles;
  const std::vector<std::int32_t> arrived = flow.near_walls.update(flow.setup.ranks, particles, true);
  const std::vector<std::size_t> kept = indices_where(particles.owned, [&](std::size_t i) {
    return particles.is_fluid(i) || flow.near_walls.is_near(particles.wall_row[i]);
  });
  if (kept.size() < particles.owned) {
    flow.neighbourhood.keep(particles, std::vector<std::int32_t>(kept.begin(), kept.end()));
  }
  add_walls<Dim>(flow, arrived);
}

#define TAILWATER_INSTANTIATE(Dim)             \
  template void gather_walls<Dim>(Flow<Dim>&); \
  template void regather_walls<Dim>(Flow<Dim>&);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
