#include "neighbours/neighbourhood.h"

#include <algorithm>
#include <utility>

#include "base/for_each.h"
#include "base/z_curve.h"
#include "neighbours/find_pairs.h"

namespace tailwater {
namespace {

/// Least distance in dx: nearer particles count as this far apart, so directions stay defined and weights finite.
constexpr double min_distance_over_spacing = 1e-6;

/// Cost of a row, and of a pair of a wall particle, in pairs of a fluid particle (docs/scaling.md).
constexpr double row_cost = 10.0;
constexpr double wall_pair_cost = 0.3;

/// The indices of `positions` in the order of a Z curve through cells with the given edge.
template <int Dim>
std::vector<std::int32_t> order_along_z_curve(std::span<const Vec<Dim>> positions, double edge) {
  std::vector<std::pair<std::uint64_t, std::int32_t>> numbered(positions.size());
  for_each(positions.size(), [&](std::size_t i) {
    numbered[i] = {z_number<Dim>(positions[i], edge), static_cast<std::int32_t>(i)};
  });
  std::ranges::sort(numbered);
  std::vector<std::int32_t> order(positions.size());
  for_each(order.size(), [&](std::size_t n) { order[n] = numbered[n].second; });
  return order;
}

template <class Value>
void pick(std::span<const std::int32_t> kept, std::vector<Value>& field) {
  std::vector<Value> picked(kept.size());
  for_each(kept.size(), [&](std::size_t i) { picked[i] = field[kept[i]]; });
  field.swap(picked);
}

}  // namespace

template <int Dim>
Neighbourhood<Dim>::Neighbourhood(Kernel<Dim> kernel, double spacing, double skin, WallRows wall_rows,
                                  PeriodicDomain<Dim> domain, Communicator ranks, SpacingField<Dim> field)
    : kernel_(std::move(kernel)),
      spacing_(spacing),
      skin_(skin),
      wall_rows_(wall_rows),
      domain_(std::move(domain)),
      ranks_(std::move(ranks)),
      field_(std::move(field)),
      has_ghosts_(!ranks_.is_alone() ||
                  std::ranges::any_of(domain_, [](const auto& interval) { return interval.has_value(); })) {}

template <int Dim>
bool Neighbourhood<Dim>::update(Particles<Dim>& particles) {
  const bool renew = ranks_.any(!ghosts_are_valid(particles));
  if (renew) {
    renew_ghosts(particles);
  } else {
    halo_.exchange_positions(particles.position);
  }
  grid_ = CellGrid<Dim>(particles.position, kernel_radius(kernel_));
  find_places<Dim>(particles, domain_, kernel_radius(kernel_), pairs_);
  find_relative_spacing(particles);
  find_pairs<Dim>(kernel_, grid_, particles, wall_rows_, min_distance_over_spacing * spacing_, pairs_);
  has_pairs_ = true;
  return renew;
}

template <int Dim>
void Neighbourhood<Dim>::reorder(Particles<Dim>& particles, ParticleOrder order) {
  wrap(particles);
  particles.resize(particles.owned);
  if (order == ParticleOrder::slabs) {
    keep(particles, CellGrid<Dim>(particles.position, kernel_radius(kernel_)).order());
  } else {
    keep(particles, order_along_z_curve<Dim>(particles.position, spacing_ * field_.finest()));
  }
}

template <int Dim>
void Neighbourhood<Dim>::keep(Particles<Dim>& particles, std::span<const std::int32_t> kept) {
  particles.apply_to_fields([&](auto&... field) { (pick(kept, field), ...); });
  particles.owned = kept.size();
  has_pairs_ = false;
}

template <int Dim>
void Neighbourhood<Dim>::forget(Particles<Dim>& particles) {
  particles.resize(particles.owned);
  has_pairs_ = false;
}

template <int Dim>
std::vector<double> Neighbourhood<Dim>::work(const Particles<Dim>& particles) const {
  std::vector<double> work(particles.owned, 1.0);
  if (!has_pairs_ || pairs_.owned() != particles.owned) return work;
  for_each(particles.owned, [&](std::size_t i) {
    const auto neighbours = static_cast<double>(pairs_.end(i) - pairs_.begin(i));
    work[i] = row_cost + (particles.is_fluid(i) ? 1.0 : wall_pair_cost) * neighbours;
  });
  return work;
}

template <int Dim>
void Neighbourhood<Dim>::find_relative_spacing(const Particles<Dim>& particles) {
  if (field_.is_uniform()) return;
  pairs_.inverse_cell = static_cast<float>(1.0 / power<Dim>(spacing_));
  pairs_.relative_spacing.resize(particles.size());
  for_each(particles.size(),
           [&](std::size_t i) { pairs_.relative_spacing[i] = static_cast<float>(field_.at(particles.position[i])); });
}

template <int Dim>
bool Neighbourhood<Dim>::ghosts_are_valid(const Particles<Dim>& particles) const {
  if (!has_pairs_ || halo_.plan.owned() != particles.owned) return false;
  if (!has_ghosts_) return true;
  const double limit = 0.25 * skin_ * skin_;
  return count_each(particles.owned, [&](std::size_t i) {
           return (particles.position[i] - position_at_renewal_[i]).squaredNorm() > limit;
         }) == 0;
}

template <int Dim>
void Neighbourhood<Dim>::renew_ghosts(Particles<Dim>& particles) {
  ++renewals_;
  particles.resize(particles.owned);
  halo_ = make_halo<Dim>(ranks_, domain_, kernel_radius(kernel_) + skin_, particles);
  if (!has_ghosts_) return;
  position_at_renewal_.assign(particles.position.begin(),
                              particles.position.begin() + static_cast<std::ptrdiff_t>(particles.owned));
}

template class Neighbourhood<2>;
template class Neighbourhood<3>;

}  // namespace tailwater
