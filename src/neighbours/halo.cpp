#include "neighbours/halo.h"

#include <algorithm>

#include "base/box.h"
#include "base/for_each.h"
#include "geometry/images.h"

namespace tailwater {

namespace {

/// Around the owned particles and `margin` [m] beyond; empty without any.
template <int Dim>
Box<Dim> box_around(const Particles<Dim>& particles, double margin) {
  Box<Dim> box;
  for (int d = 0; d < Dim; ++d) {
    const auto x = [&](std::size_t i) { return particles.position[i][d]; };
    const auto minus_x = [&](std::size_t i) { return -particles.position[i][d]; };
    box.min()[d] = -largest_over(particles.owned, -box.min()[d], minus_x) - margin;
    box.max()[d] = largest_over(particles.owned, box.max()[d], x) + margin;
  }
  return box;
}

}  // namespace

template <int Dim>
std::vector<Vec<Dim>> image_shifts(const PeriodicDomain<Dim>& domain) {
  std::vector<Vec<Dim>> shifts{Vec<Dim>::Zero()};
  for (int d = 0; d < Dim; ++d) {
    if (!domain[d]) continue;
    const double length = domain[d]->second - domain[d]->first;
    const std::size_t count = shifts.size();
    for (std::size_t k = 0; k < count; ++k) {
      for (const double offset : {length, -length}) {
        shifts.push_back(shifts[k]);
        shifts.back()[d] += offset;
      }
    }
  }
  return shifts;
}

template <int Dim>
void Halo<Dim>::exchange_positions(std::vector<Vec<Dim>>& position) const {
  if (shift.empty()) {
    exchange(position);
    return;
  }
  const std::span<const std::int32_t> sent = plan.sent();
  std::vector<Vec<Dim>> image(sent.size());
  for_each(sent.size(), [&](std::size_t k) { image[k] = position[sent[k]] + shift[k]; });
  plan.deliver(std::span<const Vec<Dim>>(image), position);
}

template <int Dim>
void wrap_positions(const PeriodicDomain<Dim>& domain, Particles<Dim>& particles) {
  if (std::ranges::none_of(domain, [](const auto& interval) { return interval.has_value(); })) return;
  for_each(particles.owned,
           [&](std::size_t i) { particles.position[i] = wrapped<Dim>(domain, particles.position[i]); });
}

template <int Dim>
Halo<Dim> make_halo(const Communicator& ranks, const PeriodicDomain<Dim>& domain, double margin,
                    Particles<Dim>& particles) {
  const std::vector<Vec<Dim>> shifts = image_shifts<Dim>(domain);
  Halo<Dim> halo;
  std::vector<std::vector<std::int32_t>> sent(static_cast<std::size_t>(ranks.size()));
  const std::vector<Box<Dim>> boxes = ranks.all_gather(box_around(particles, margin));
  for (int rank = 0; rank < ranks.size(); ++rank) {
    for (const Vec<Dim>& shift : shifts) {
      if (rank == ranks.rank() && shift.isZero(0.0)) continue;  // the particles themselves
      const std::vector<std::size_t> seen = indices_where(
          particles.owned, [&](std::size_t i) { return boxes[rank].contains(particles.position[i] + shift); });
      sent[rank].insert(sent[rank].end(), seen.begin(), seen.end());
      if (shifts.size() > 1) halo.shift.insert(halo.shift.end(), seen.size(), shift);
    }
  }
  halo.plan = ExchangePlan(ranks, particles.owned, sent);
  particles.apply_to_fields([&](auto&... field) { halo.exchange(field...); });
  if (shifts.size() > 1) halo.exchange_positions(particles.position);
  return halo;
}

template struct Halo<2>;
template struct Halo<3>;
TAILWATER_IN_2D_AND_3D(image_shifts);
TAILWATER_IN_2D_AND_3D(wrap_positions);
TAILWATER_IN_2D_AND_3D(make_halo);

}  // namespace tailwater
