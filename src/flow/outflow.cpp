// Particles that are no longer computed: they have passed an open end, or fallen below all walls.
#include <algorithm>

#include "base/for_each.h"
#include "flow/stages.h"

namespace tailwater {
namespace {

/// A place along gravity below which nothing can bring water back: a support below all walls and open ends, and the
/// edges of a periodic domain.
template <int Dim>
struct Floor {
  Vec<Dim> down = Vec<Dim>::Zero();  ///< of length 1; zero: there is no floor
  double depth = 0.0;                ///< m; along `down`

  bool is_passed_by(const Vec<Dim>& x) const { return down.dot(x) > depth; }
};

template <int Dim>
Floor<Dim> find_floor(const Flow<Dim>& flow) {
  const Setup<Dim>& setup = flow.setup;
  Eigen::AlignedBox<double, Dim> box = flow.box();
  if (box.isEmpty() || setup.gravity.norm() == 0.0) return {};
  for (int d = 0; d < Dim; ++d) {
    if (!setup.domain[d]) continue;
    box.min()[d] = std::min(box.min()[d], setup.domain[d]->first);
    box.max()[d] = std::max(box.max()[d], setup.domain[d]->second);
  }
  const Vec<Dim> down = setup.gravity.normalized();
  const Vec<Dim> lowest = (down.array() > 0.0).select(box.max(), box.min());
  return {down, down.dot(lowest) + kernel_radius(setup.kernel)};
}

}  // namespace

template <int Dim>
bool remove_outflow(Flow<Dim>& flow) {
  const std::vector<OpenEnd<Dim>>& ends = flow.setup.open_ends;
  const Particles<Dim>& particles = flow.state.particles;
  const Floor<Dim> floor = find_floor(flow);
  const std::size_t falls = ends.size();
  const std::size_t stays = ends.size() + 1;
  std::vector<std::uint8_t> leaves(particles.owned, 0);
  for (const auto& part : flow.parts) part->take_out(flow, leaves);
  std::vector<std::size_t> leaves_by(particles.owned);  // the end that it passes, `falls` or `stays`
  for_each(particles.owned, [&](std::size_t i) {
    leaves_by[i] = stays;
    if (!particles.is_fluid(i) || leaves[i] != 0) return;
    const Vec<Dim>& x = particles.position[i];
    const auto end =
        std::find_if(ends.begin(), ends.end(), [&](const OpenEnd<Dim>& e) { return e.opening.is_passed_by(x); });
    if (end != ends.end()) {
      leaves_by[i] = static_cast<std::size_t>(end - ends.begin());
    } else if (floor.is_passed_by(x)) {
      leaves_by[i] = falls;
    }
  });
  const std::vector<std::size_t> kept =
      indices_where(particles.owned, [&](std::size_t i) { return leaves_by[i] == stays && leaves[i] == 0; });
  const bool some_left = kept.size() != particles.owned;
  if (!flow.setup.ranks.any(some_left)) return false;
  for (const auto& part : flow.parts) part->reordered(Reordering::removed);
  for (std::size_t w = 0; w <= falls; ++w) {
    WaterAmount passed = sum_over(particles.owned, WaterAmount{}, [&](std::size_t i) -> WaterAmount {
      if (leaves_by[i] != w) return {};
      return {1, particles.volume[i], flow.kinetic_energy_of(i) + flow.potential_energy_of(i)};
    });
    flow.setup.ranks.sum_each(passed.particles, passed.volume, passed.energy);
    (w == falls ? flow.state.fallen : flow.state.open_ends[w].departed) += passed;
  }
  if (some_left) flow.neighbourhood.keep(flow.state.particles, std::vector<std::int32_t>(kept.begin(), kept.end()));
  return some_left;
}

TAILWATER_IN_2D_AND_3D(remove_outflow);

}  // namespace tailwater
