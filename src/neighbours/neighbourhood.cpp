#include "neighbours/neighbourhood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace tailwater {
namespace {

/// Two particles nearer than this share of dx count as this far apart: directions stay defined, weights finite.
constexpr double least_distance_over_spacing = 1e-6;

template <class Value>
void permute(std::span<const std::int32_t> order, std::vector<Value>& field) {
  std::vector<Value> sorted(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    sorted[i] = field[order[i]];
  }
  field.swap(sorted);
}

/// Particle indices by slabs of thickness `spacing` across the fluid's longest extent, in each by rows across the next
/// longest, in each by cells. Positions far from the fluid are cut to a range that fits the keys.
template <int Dim>
std::vector<std::int32_t> slab_order(const Particles<Dim>& particles, double spacing) {
  Eigen::AlignedBox<double, Dim> box;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (particles.is_fluid(i)) box.extend(particles.position[i]);
  }
  std::array<int, Dim> axes;
  std::iota(axes.begin(), axes.end(), 0);
  if (!box.isEmpty()) {
    const Vec<Dim> extent = box.sizes();
    std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return extent[a] > extent[b]; });
  }
  constexpr double most = 1 << 20;
  std::vector<std::pair<std::int64_t, std::int32_t>> keys(particles.owned);
  for (std::size_t i = 0; i < particles.owned; ++i) {
    std::int64_t key = 0;
    for (const int axis : axes) {
      const double cell = std::floor((particles.position[i][axis] - (box.isEmpty() ? 0.0 : box.min()[axis])) / spacing);
      key = key * static_cast<std::int64_t>(2.0 * most) +
            static_cast<std::int64_t>(std::clamp(cell, -most, most - 1.0) + most);
    }
    keys[i] = {key, static_cast<std::int32_t>(i)};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::int32_t> order(keys.size());
  std::transform(keys.begin(), keys.end(), order.begin(), [](const auto& key) { return key.second; });
  return order;
}

}  // namespace

template <int Dim>
Neighbourhood<Dim>::Neighbourhood(Kernel<Dim> kernel, double spacing, double skin, WallRows wall_rows,
                                  PeriodicDomain<Dim> domain)
    : kernel_(std::move(kernel)), spacing_(spacing), skin_(skin), wall_rows_(wall_rows), domain_(std::move(domain)) {}

template <int Dim>
bool Neighbourhood<Dim>::update(Particles<Dim>& particles) {
  const bool renew = !lists_are_valid(particles);
  if (renew) {
    rebuild(particles);
  } else {
    halo_.exchange_positions(particles.position);
  }
  evaluate_pairs<Dim>(kernel_, particles.position, least_distance_over_spacing * spacing_, list_, pairs_);
  return renew;
}

template <int Dim>
void Neighbourhood<Dim>::reorder(Particles<Dim>& particles) {
  wrap(particles);
  particles.resize(particles.owned);
  const std::vector<std::int32_t> order = slab_order(particles, spacing_);
  permute(order, particles.position);
  permute(order, particles.velocity);
  permute(order, particles.pressure);
  permute(order, particles.volume);
  permute(order, particles.kind);
  permute(order, particles.wall_row);
  permute(order, particles.id);
  position_at_rebuild_.clear();
}

template <int Dim>
bool Neighbourhood<Dim>::lists_are_valid(const Particles<Dim>& particles) const {
  if (position_at_rebuild_.size() != particles.owned) return false;
  const double limit = 0.25 * skin_ * skin_;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if ((particles.position[i] - position_at_rebuild_[i]).squaredNorm() > limit) return false;
  }
  return true;
}

template <int Dim>
void Neighbourhood<Dim>::rebuild(Particles<Dim>& particles) {
  ++rebuilds_;
  const double reach = kernel_radius(kernel_) + skin_;
  particles.resize(particles.owned);
  halo_ = make_halo<Dim>(domain_, reach, particles);
  grid_ = CellGrid<Dim>(particles.position, reach);
  position_at_rebuild_.assign(particles.position.begin(),
                              particles.position.begin() + static_cast<std::ptrdiff_t>(particles.owned));

  list_.row_begin.resize(particles.owned + 1);
  list_.j.clear();
  std::vector<std::int32_t> row(particles.size());
  for (std::size_t i = 0; i < particles.owned; ++i) {
    const Vec<Dim> position = particles.position[i];
    const bool takes_walls = wall_rows_ == WallRows::all || particles.is_fluid(i);
    std::size_t n = 0;  // kept by overwriting, as in evaluate_pairs
    grid_.for_each_near(position, [&](std::int32_t j) {
      row[n] = j;
      n += (static_cast<std::size_t>(j) != i) & (takes_walls | particles.is_fluid(j)) &
           static_cast<std::size_t>((position - particles.position[j]).squaredNorm() < reach * reach);
    });
    std::sort(row.begin(), row.begin() + n);
    list_.j.insert(list_.j.end(), row.begin(), row.begin() + n);
    list_.row_begin[i + 1] = list_.j.size();
  }
}

template class Neighbourhood<2>;
template class Neighbourhood<3>;

}  // namespace tailwater
