#include "rheology/liquid_balances.h"

#include <nlohmann/json.hpp>

#include "base/for_each.h"
#include "flow/water_amount.h"

namespace tailwater {
namespace {

/// Sums over the particles of one liquid.
struct LiquidSums {
  double particles = 0.0;
  double volume = 0.0;
  double kinetic_energy = 0.0;
  double potential_energy = 0.0;
  double mixed = 0.0;  ///< m^Dim

  LiquidSums& operator+=(const LiquidSums& other) {
    particles += other.particles;
    volume += other.volume;
    kinetic_energy += other.kinetic_energy;
    potential_energy += other.potential_energy;
    mixed += other.mixed;
    return *this;
  }
};

/// Whether most neighbours of fluid particle i within the kernel are of other liquids.
template <int Dim>
bool is_mixed(const Flow<Dim>& flow, std::size_t i) {
  const Pairs<Dim>& pairs = flow.pairs();
  const Particles<Dim>& particles = flow.state.particles;
  const ParticleLiquids& liquids = flow.setup.liquids;
  const int own = liquids.of(particles.id[i]);
  const double radius = kernel_radius(pairs.kernel);
  int excess = 0;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    if (particles.is_fluid(j) && pairs.r(i, k) < radius) excess += liquids.of(particles.id[j]) == own ? -1 : 1;
  }
  return excess > 0;
}

}  // namespace

template <int Dim>
Json balances_of_liquids(const Flow<Dim>& flow, std::span<const LiquidTable> liquids) {
  const Particles<Dim>& particles = flow.state.particles;
  const bool has_pairs = flow.pairs().owned() == particles.owned;
  Json all = Json::array();
  for (std::size_t liquid = 0; liquid < liquids.size(); ++liquid) {
    LiquidSums sums = sum_over(particles.owned, LiquidSums{}, [&](std::size_t i) -> LiquidSums {
      if (!particles.is_fluid(i) || flow.setup.liquids.of(particles.id[i]) != static_cast<int>(liquid)) return {};
      const double volume = particles.volume[i];
      return {1.0, volume, flow.kinetic_energy_of(i), flow.potential_energy_of(i),
              has_pairs && is_mixed(flow, i) ? volume : 0.0};
    });
    flow.setup.ranks.sum_each(sums.particles, sums.volume, sums.kinetic_energy, sums.potential_energy, sums.mixed);
    Json block = summary_of(
        WaterAmount{static_cast<std::int64_t>(sums.particles), sums.volume, liquids[liquid].density * sums.volume});
    block["name"] = liquids[liquid].name;
    block["rheology"] = name_of(liquids[liquid].rheology);
    block["kinetic_energy_J"] = sums.kinetic_energy;
    block["potential_energy_J"] = sums.potential_energy;
    block["mixed_fraction"] = sums.volume > 0.0 ? sums.mixed / sums.volume : 0.0;
    all.push_back(std::move(block));
  }
  return all;
}

TAILWATER_IN_2D_AND_3D(balances_of_liquids);

}  // namespace tailwater
