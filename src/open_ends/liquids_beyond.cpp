#include "open_ends/liquids_beyond.h"

#include <algorithm>
#include <cmath>

namespace tailwater {

template <int Dim>
LiquidsBeyond::LiquidsBeyond(const OpenEnd<Dim>& end, const Flow<Dim>& flow) : step_(end.spacing) {
  const Particles<Dim>& particles = flow.state.particles;
  const ParticleLiquids& liquids = flow.setup.liquids;
  const auto steps = static_cast<std::size_t>(std::max(1L, std::lround(end.height / end.spacing)));
  const std::size_t kinds = liquids.density.size();
  step_ = end.height / static_cast<double>(steps);
  std::vector<double> found(steps * kinds, 0.0);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: several may be at a height
    const Vec<Dim>& x = particles.position[i];
    if (!particles.is_fluid(i) || !end.holds(x)) continue;
    const double step = std::clamp(std::floor(end.rise.dot(x - end.low) / step_), 0.0, static_cast<double>(steps - 1));
    found[static_cast<std::size_t>(step) * kinds + static_cast<std::size_t>(liquids.of(particles.id[i]))] += 1.0;
  }
  flow.setup.ranks.sum_of_each(found);
  liquid_.assign(steps, -1);
  for (std::size_t step = 0; step < steps; ++step) {
    const auto begin = found.begin() + static_cast<std::ptrdiff_t>(step * kinds);
    const auto most = std::max_element(begin, begin + static_cast<std::ptrdiff_t>(kinds));
    if (*most > 0.0) liquid_[step] = static_cast<int>(most - begin);
  }
  // A height without water has the liquid below it; those below all water have the lowest one.
  const auto lowest = std::ranges::find_if(liquid_, [](int liquid) { return liquid >= 0; });
  int last = lowest == liquid_.end() ? 0 : *lowest;
  for (int& liquid : liquid_) last = liquid = liquid < 0 ? last : liquid;
}

int LiquidsBeyond::at(double height) const {
  if (liquid_.empty()) return 0;
  return liquid_[static_cast<std::size_t>(
      std::clamp(std::floor(height / step_), 0.0, static_cast<double>(liquid_.size() - 1)))];
}

double LiquidsBeyond::mean_density(double low, double high, std::span<const double> density) const {
  if (!(high > low)) return density[static_cast<std::size_t>(at(low))];
  double sum = 0.0;
  double from = low;
  while (from < high) {
    const double step = std::clamp(std::floor(from / step_ + 1e-9), 0.0, static_cast<double>(liquid_.size() - 1));
    const bool is_last = step + 1.0 >= static_cast<double>(liquid_.size());
    const double to = is_last ? high : std::min(high, (step + 1.0) * step_);
    sum += (to - from) * density[static_cast<std::size_t>(liquid_[static_cast<std::size_t>(step)])];
    from = to;
  }
  return sum / (high - low);
}

template <int Dim>
double density_above(const Flow<Dim>& flow, const OpenEnd<Dim>& end, const OpenEndState& state,
                     const LiquidsBeyond& liquids, const Vec<Dim>& x) {
  const Setup<Dim>& setup = flow.setup;
  if (!setup.liquids.are_several()) return setup.liquid.density;
  const double surface = state.is_full ? state.level - end.floor : state.depth;
  return liquids.mean_density(end.rise.dot(x - end.low), surface, setup.liquids.density);
}

template double density_above(const Flow<2>&, const OpenEnd<2>&, const OpenEndState&, const LiquidsBeyond&,
                              const Vec<2>&);
template double density_above(const Flow<3>&, const OpenEnd<3>&, const OpenEndState&, const LiquidsBeyond&,
                              const Vec<3>&);
template LiquidsBeyond::LiquidsBeyond(const OpenEnd<2>&, const Flow<2>&);
template LiquidsBeyond::LiquidsBeyond(const OpenEnd<3>&, const Flow<3>&);

}  // namespace tailwater
