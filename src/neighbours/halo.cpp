#include "neighbours/halo.h"

#include <algorithm>
#include <cmath>

namespace tailwater {

template <int Dim>
void Halo<Dim>::exchange_positions(std::vector<Vec<Dim>>& position) const {
  exchange(position);
  for (std::size_t k = 0; k < source.size(); ++k) {
    position[owned + k] += shift[k];
  }
}

template <int Dim>
Vec<Dim> wrapped(const PeriodicDomain<Dim>& domain, Vec<Dim> position) {
  for (int d = 0; d < Dim; ++d) {
    if (!domain[d]) continue;
    const auto [low, high] = *domain[d];
    const double length = high - low;
    position[d] -= length * std::floor((position[d] - low) / length);
  }
  return position;
}

template <int Dim>
void wrap_positions(const PeriodicDomain<Dim>& domain, Particles<Dim>& particles) {
  if (std::ranges::none_of(domain, [](const auto& interval) { return interval.has_value(); })) return;
  for (std::size_t i = 0; i < particles.owned; ++i) particles.position[i] = wrapped<Dim>(domain, particles.position[i]);
}

template <int Dim>
Halo<Dim> make_halo(const PeriodicDomain<Dim>& domain, double margin, Particles<Dim>& particles) {
  Halo<Dim> halo;
  halo.owned = particles.owned;
  const auto position_of = [&](std::size_t i) -> Vec<Dim> {
    if (i < halo.owned) return particles.position[i];
    const std::size_t k = i - halo.owned;
    return particles.position[halo.source[k]] + halo.shift[k];
  };
  // Direction by direction, images of images included: that makes the corners.
  for (int d = 0; d < Dim; ++d) {
    if (!domain[d]) continue;
    const auto [low, high] = *domain[d];
    const std::size_t count = halo.owned + halo.source.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Vec<Dim> position = position_of(i);
      const auto add_image = [&](double offset) {
        Vec<Dim> shift = i < halo.owned ? Vec<Dim>(Vec<Dim>::Zero()) : halo.shift[i - halo.owned];
        shift[d] += offset;
        halo.source.push_back(halo.owner(static_cast<std::int32_t>(i)));
        halo.shift.push_back(shift);
      };
      if (position[d] < low + margin) add_image(high - low);
      if (position[d] > high - margin) add_image(low - high);
    }
  }
  halo.exchange_positions(particles.position);
  halo.exchange(particles.velocity);
  halo.exchange(particles.pressure);
  halo.exchange(particles.volume);
  halo.exchange(particles.kind);
  halo.exchange(particles.wall_row);
  halo.exchange(particles.id);
  return halo;
}

template struct Halo<2>;
template struct Halo<3>;
template Vec<2> wrapped<2>(const PeriodicDomain<2>&, Vec<2>);
template Vec<3> wrapped<3>(const PeriodicDomain<3>&, Vec<3>);
template void wrap_positions<2>(const PeriodicDomain<2>&, Particles<2>&);
template void wrap_positions<3>(const PeriodicDomain<3>&, Particles<3>&);
template Halo<2> make_halo<2>(const PeriodicDomain<2>&, double, Particles<2>&);
template Halo<3> make_halo<3>(const PeriodicDomain<3>&, double, Particles<3>&);

}  // namespace tailwater
