#include "parts/damping_zones.h"

#include "base/for_each.h"
#include "flow/flow.h"
#include "geometry/from_spec.h"

namespace tailwater {

template <int Dim>
DampingZone<Dim>::DampingZone(const DampingTable& table)
    : low_(to_vec<Dim>(table.min, CaseLabel("damping", table.name), "min")),
      high_(to_vec<Dim>(table.max, CaseLabel("damping", table.name), "max")),
      axis_(static_cast<int>(table.towards) / 2),
      grows_upwards_(static_cast<int>(table.towards) % 2 == 1),
      strength_(table.strength) {}

template <int Dim>
double DampingZone<Dim>::rate_at(const Vec<Dim>& x) const {
  if ((x.array() < low_.array()).any() || (x.array() > high_.array()).any()) return 0.0;
  const double from_low = (x[axis_] - low_[axis_]) / (high_[axis_] - low_[axis_]);
  const double fraction = grows_upwards_ ? from_low : 1.0 - from_low;
  return strength_ * fraction * fraction;
}

template <int Dim>
void DampingZones<Dim>::add_damping_rate(const Flow<Dim>& flow, const StepStart<Dim>& start,
                                         std::vector<double>& rate) const {
  const Particles<Dim>& particles = flow.state.particles;
  rate.resize(particles.owned);
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    for (const DampingZone<Dim>& zone : zones_) rate[i] += zone.rate_at(start.position[i]);
  });
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_damping_zones(const CaseSpec& spec, const Setup<Dim>& /*setup*/,
                                              const Boundary<Dim>& /*boundary*/) {
  if (spec.damping.empty()) return nullptr;
  std::vector<DampingZone<Dim>> zones;
  for (const DampingTable& table : spec.damping) zones.emplace_back(table);
  return std::make_unique<DampingZones<Dim>>(std::move(zones));
}

template class DampingZone<2>;
template class DampingZone<3>;
template class DampingZones<2>;
template class DampingZones<3>;
TAILWATER_IN_2D_AND_3D(make_damping_zones);

}  // namespace tailwater
