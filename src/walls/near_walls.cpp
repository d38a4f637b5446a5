#include "walls/near_walls.h"

#include <algorithm>

#include "base/box.h"
#include "base/for_each.h"

namespace tailwater {
namespace {

constexpr std::int32_t nowhere = -1;

/// Around the wall particles of all ranks that do not move; at the origin if there are none.
template <int Dim>
Box<Dim> box_of_resting(const Communicator& ranks, const Walls<Dim>& walls) {
  Box<Dim> own;
  for (std::size_t row = walls.moving; row < walls.kept; ++row) own.extend(walls.particles.position[row]);
  Box<Dim> box;
  for (const Box<Dim>& part : ranks.all_gather(own)) box.extend(part);
  if (box.isEmpty()) box.extend(Vec<Dim>::Zero());
  return box;
}

}  // namespace

template <int Dim>
NearWalls<Dim>::NearWalls(const Communicator& ranks, const Walls<Dim>& walls, const PeriodicDomain<Dim>& domain,
                          double reach)
    : ranks_(ranks), images_(image_shifts<Dim>(domain)), edge_(reach) {
  const std::vector<Vec<Dim>>& position = walls.particles.position;
  const Box<Dim> box = box_of_resting(ranks, walls);
  // A few distant walls must not make the grid huge. Coarser cells only bring more walls near.
  const double max_cells = 64.0 * static_cast<double>(walls.all) + 1e5;
  while ((box.sizes() / edge_).each([](double cells) { return std::max(1.0, std::ceil(cells)); }).prod() > max_cells)
    edge_ *= 2.0;
  origin_ = box.min() - Vec<Dim>::Constant(edge_);
  std::size_t cells = 1;
  for (int d = 0; d < Dim; ++d) {
    count_[d] = static_cast<std::int32_t>(box.sizes()[d] / edge_) + 3;
    cells *= static_cast<std::size_t>(count_[d]);
  }
  is_near_.assign(cells, 0);

  std::vector<int> has_rows(cells, 0);
  for (std::size_t row = walls.moving; row < walls.kept; ++row) has_rows[cell_of(position[row])] = 1;
  ranks.largest_of_each(has_rows);
  has_rows_.assign(has_rows.begin(), has_rows.end());
  find_covered();
}

template <int Dim>
std::vector<std::int32_t> NearWalls<Dim>::update(const Walls<Dim>& walls, const Particles<Dim>& particles,
                                                 FarWalls far) {
  std::vector<int> is_wet(is_near_.size(), 0);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: many particles mark one cell
    if (!particles.is_fluid(i)) continue;
    for (const Vec<Dim>& shift : images_) {
      const std::int32_t cell = cell_of(particles.position[i] + shift);
      if (cell != nowhere) is_wet[cell] = 1;
    }
  }
  ranks_.largest_of_each(is_wet);

  const std::vector<std::uint8_t> was_near = is_near_;
  if (far == FarWalls::dropped) std::fill(is_near_.begin(), is_near_.end(), 0);
  for (std::size_t cell = 0; cell < is_wet.size(); ++cell) {
    if (is_wet[cell]) for_each_beside(static_cast<std::int32_t>(cell), [&](std::int32_t c) { is_near_[c] = 1; });
  }
  find_covered();
  std::vector<std::int32_t> arrived;
  for (std::size_t row = walls.moving; row < walls.kept; ++row) {
    const std::int32_t cell = cell_of(walls.particles.position[row]);
    if (is_near_[cell] && !was_near[cell]) arrived.push_back(static_cast<std::int32_t>(row));
  }
  return arrived;
}

template <int Dim>
bool NearWalls<Dim>::misses_some(const Particles<Dim>& particles) const {
  return count_each(particles.owned, [&](std::size_t i) {
           return particles.is_fluid(i) && std::ranges::any_of(images_, [&](const Vec<Dim>& shift) {
                    const std::int32_t cell = cell_of(particles.position[i] + shift);
                    return cell != nowhere && !is_covered_[cell];
                  });
         }) > 0;
}

template <int Dim>
void NearWalls<Dim>::restore(const Walls<Dim>& walls, const Particles<Dim>& particles) {
  std::vector<int> is_near(is_near_.size(), 0);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: many particles mark one cell
    if (particles.is_fluid(i) || static_cast<std::size_t>(particles.wall_row[i]) < walls.moving) continue;
    is_near[cell_of(walls.particles.position[particles.wall_row[i]])] = 1;
  }
  ranks_.largest_of_each(is_near);
  is_near_.assign(is_near.begin(), is_near.end());
  find_covered();
}

/// The cell that holds `place`, or `nowhere` outside the grid, where no wall is near.
template <int Dim>
std::int32_t NearWalls<Dim>::cell_of(const Vec<Dim>& place) const {
  std::int32_t cell = 0;
  for (int d = 0; d < Dim; ++d) {
    const double index = (place[d] - origin_[d]) / edge_;
    if (!(index >= 0.0 && index < count_[d])) return nowhere;
    cell = cell * count_[d] + static_cast<std::int32_t>(index);
  }
  return cell;
}

/// Calls visit(c) for the cell and all that touch it.
template <int Dim>
template <class Visit>
void NearWalls<Dim>::for_each_beside(std::int32_t cell, Visit&& visit) const {
  std::array<std::int32_t, Dim> index;
  for (int d = Dim; d-- > 0; cell /= count_[d]) index[d] = cell % count_[d];
  std::array<std::int32_t, 3> low{};
  std::array<std::int32_t, 3> high{};
  for (int d = 0; d < Dim; ++d) {
    low[d] = std::max(index[d] - 1, 0);
    high[d] = std::min(index[d] + 1, count_[d] - 1);
  }
  for (std::int32_t a = low[0]; a <= high[0]; ++a) {
    for (std::int32_t b = low[1]; b <= high[1]; ++b) {
      for (std::int32_t c = low[2]; c <= high[2]; ++c) {
        visit(Dim == 3 ? (a * count_[1] + b) * count_[Dim - 1] + c : a * count_[1] + b);
      }
    }
  }
}

template <int Dim>
void NearWalls<Dim>::find_covered() {
  is_covered_.assign(is_near_.size(), 1);
  for (std::size_t cell = 0; cell < is_near_.size(); ++cell) {
    if (is_near_[cell] || !has_rows_[cell]) continue;
    for_each_beside(static_cast<std::int32_t>(cell), [&](std::int32_t c) { is_covered_[c] = 0; });
  }
}

template class NearWalls<2>;
template class NearWalls<3>;

}  // namespace tailwater
