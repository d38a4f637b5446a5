#include "neighbours/neighbourhood.h"

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

}  // namespace

template <int Dim>
Neighbourhood<Dim>::Neighbourhood(Kernel<Dim> kernel, double spacing, double skin, WallRows wall_rows,
                                  PeriodicDomain<Dim> domain)
    : kernel_(std::move(kernel)),
      least_distance_(least_distance_over_spacing * spacing),
      skin_(skin),
      wall_rows_(wall_rows),
      domain_(std::move(domain)) {}

template <int Dim>
bool Neighbourhood<Dim>::update(Particles<Dim>& particles) {
  const bool renew = !lists_are_valid(particles);
  if (renew) {
    rebuild(particles);
  } else {
    halo_.exchange_positions(particles.position);
  }
  evaluate_pairs<Dim>(kernel_, particles.position, least_distance_, pairs_);
  return renew;
}

template <int Dim>
void Neighbourhood<Dim>::reorder(Particles<Dim>& particles) {
  wrap(particles);
  particles.resize(particles.owned);
  const CellGrid<Dim> grid(particles.position, kernel_radius(kernel_) + skin_);
  permute(grid.order(), particles.position);
  permute(grid.order(), particles.velocity);
  permute(grid.order(), particles.pressure);
  permute(grid.order(), particles.volume);
  permute(grid.order(), particles.kind);
  permute(grid.order(), particles.wall_row);
  permute(grid.order(), particles.id);
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

  pairs_.row_begin.resize(particles.owned + 1);
  pairs_.row_begin[0] = 0;
  pairs_.j.clear();
  for (std::size_t i = 0; i < particles.owned; ++i) {
    const Vec<Dim> position = particles.position[i];
    const bool skip_walls = wall_rows_ == WallRows::fluid_only && !particles.is_fluid(i);
    grid_.for_each_near(position, [&](std::int32_t j) {
      if (static_cast<std::size_t>(j) == i || (skip_walls && !particles.is_fluid(j))) return;
      if ((position - particles.position[j]).squaredNorm() < reach * reach) pairs_.j.push_back(j);
    });
    pairs_.row_begin[i + 1] = pairs_.j.size();
  }
}

template class Neighbourhood<2>;
template class Neighbourhood<3>;

}  // namespace tailwater
