#include "neighbours/neighbourhood.h"

#include <utility>

#include "base/for_each.h"

namespace tailwater {
namespace {

/// Share of dx; particles nearer than this count as this far apart, so directions stay defined and weights finite.
constexpr double least_distance_over_spacing = 1e-6;

/// Cost of a row and of a wall particle's pair, in pairs of a fluid particle (docs/scaling.md).
constexpr double row_cost = 10.0;
constexpr double wall_pair_cost = 0.3;

template <class Value>
void pick(std::span<const std::int32_t> kept, std::vector<Value>& field) {
  std::vector<Value> picked(kept.size());
  for_each(kept.size(), [&](std::size_t i) { picked[i] = field[kept[i]]; });
  field.swap(picked);
}

/// Insertion sort, ascending: rows are nearly sorted.
void sort_row(std::int32_t* row, std::size_t count) {
  for (std::size_t n = 1; n < count; ++n) {
    const std::int32_t j = row[n];
    std::size_t place = n;
    for (; place > 0 && row[place - 1] > j; --place) row[place] = row[place - 1];
    row[place] = j;
  }
}

}  // namespace

template <int Dim>
Neighbourhood<Dim>::Neighbourhood(Kernel<Dim> kernel, double spacing, double skin, WallRows wall_rows,
                                  PeriodicDomain<Dim> domain, Communicator ranks)
    : kernel_(std::move(kernel)),
      spacing_(spacing),
      skin_(skin),
      wall_rows_(wall_rows),
      domain_(std::move(domain)),
      ranks_(std::move(ranks)) {}

template <int Dim>
bool Neighbourhood<Dim>::update(Particles<Dim>& particles) {
  const bool renew = ranks_.any(!lists_are_valid(particles));
  if (renew) {
    rebuild(particles);
  } else {
    halo_.exchange_positions(particles.position);
  }
  evaluate_pairs<Dim>(kernel_, particles.position, particles.id, least_distance_over_spacing * spacing_, list_, pairs_);
  return renew;
}

template <int Dim>
void Neighbourhood<Dim>::reorder(Particles<Dim>& particles) {
  wrap(particles);
  particles.resize(particles.owned);
  keep(particles, CellGrid<Dim>(particles.position, kernel_radius(kernel_) + skin_).order());
}

template <int Dim>
void Neighbourhood<Dim>::keep(Particles<Dim>& particles, std::span<const std::int32_t> kept) {
  particles.apply_to_fields([&](auto&... field) { (pick(kept, field), ...); });
  particles.owned = kept.size();
  has_lists_ = false;
}

template <int Dim>
void Neighbourhood<Dim>::forget(Particles<Dim>& particles) {
  particles.resize(particles.owned);
  has_lists_ = false;
}

template <int Dim>
std::vector<double> Neighbourhood<Dim>::work(const Particles<Dim>& particles) const {
  std::vector<double> work(particles.owned, 1.0);
  if (!has_lists_ || list_.row_begin.size() != particles.owned + 1) return work;
  for_each(particles.owned, [&](std::size_t i) {
    const auto neighbours = static_cast<double>(list_.row_begin[i + 1] - list_.row_begin[i]);
    work[i] = row_cost + (particles.is_fluid(i) ? 1.0 : wall_pair_cost) * neighbours;
  });
  return work;
}

template <int Dim>
bool Neighbourhood<Dim>::lists_are_valid(const Particles<Dim>& particles) const {
  if (!has_lists_ || position_at_rebuild_.size() != particles.owned) return false;
  const double limit = 0.25 * skin_ * skin_;
  return count_each(particles.owned, [&](std::size_t i) {
           return (particles.position[i] - position_at_rebuild_[i]).squaredNorm() > limit;
         }) == 0;
}

template <int Dim>
void Neighbourhood<Dim>::rebuild(Particles<Dim>& particles) {
  ++rebuilds_;
  has_lists_ = true;
  const double reach = kernel_radius(kernel_) + skin_;
  particles.resize(particles.owned);
  halo_ = make_halo<Dim>(ranks_, domain_, reach, particles);
  grid_ = CellGrid<Dim>(particles.position, reach);
  position_at_rebuild_.assign(particles.position.begin(),
                              particles.position.begin() + static_cast<std::ptrdiff_t>(particles.owned));

  list_.row_begin.resize(particles.owned + 1);
  list_.j.clear();
  std::vector<std::int32_t> buffer(particles.size());
  std::int32_t* const row = buffer.data();
  const Vec<Dim>* const position = particles.position.data();
  const double reach_squared = reach * reach;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: rows are put one behind the other
    const Vec<Dim> r_i = position[i];
    const auto self = static_cast<std::int32_t>(i);
    std::size_t n = 0;  // kept by overwriting, as in evaluate_pairs
    if (wall_rows_ == WallRows::all || particles.is_fluid(i)) {
      grid_.for_each_near(r_i, [&](std::int32_t j) {
        row[n] = j;
        n += static_cast<std::size_t>((r_i - position[j]).squaredNorm() < reach_squared) & (j != self);
      });
    } else {
      grid_.for_each_near(r_i, [&](std::int32_t j) {
        row[n] = j;
        n += static_cast<std::size_t>((r_i - position[j]).squaredNorm() < reach_squared) & particles.is_fluid(j);
      });
    }
    sort_row(row, n);
    list_.j.insert(list_.j.end(), row, row + n);
    list_.row_begin[i + 1] = list_.j.size();
  }
}

template class Neighbourhood<2>;
template class Neighbourhood<3>;

}  // namespace tailwater
