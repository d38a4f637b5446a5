#include "parts/damping_zones.h"

#include <algorithm>

#include "base/for_each.h"
#include "flow/flow.h"

namespace tailwater {

template <int Dim>
void DampingZones<Dim>::add_damping_rate(const Flow<Dim>& flow, const StepStart<Dim>& start,
                                         std::vector<double>& rate) const {
  const Particles<Dim>& particles = flow.state.particles;
  rate.resize(particles.owned);
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    for (const WaveZone<Dim>& zone : zones_) rate[i] += zone.rate_at(start.position[i]);
  });
}

template <int Dim>
void DampingZones<Dim>::add_relaxation(const Flow<Dim>& flow, const StepStart<Dim>& start,
                                       std::vector<Vec<Dim>>& drive) const {
  if (std::ranges::none_of(zones_, &WaveZone<Dim>::has_target)) return;
  const Particles<Dim>& particles = flow.state.particles;
  drive.resize(particles.owned, Vec<Dim>::Zero());
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    for (const WaveZone<Dim>& zone : zones_) {
      const double rate = zone.has_target() ? zone.rate_at(start.position[i]) : 0.0;
      if (rate > 0.0) drive[i] += rate * zone.target(start.position[i], flow.state.time);
    }
  });
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_damping_zones(const CaseSpec& spec, const Setup<Dim>& /*setup*/,
                                              const Boundary<Dim>& /*boundary*/) {
  if (spec.damping.empty()) return nullptr;
  std::vector<WaveZone<Dim>> zones;
  for (const DampingTable& table : spec.damping) zones.emplace_back(spec, table);
  return std::make_unique<DampingZones<Dim>>(std::move(zones));
}

template class DampingZones<2>;
template class DampingZones<3>;
TAILWATER_IN_2D_AND_3D(make_damping_zones);

}  // namespace tailwater
