#include "air/pocket_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace tailwater {
namespace {

/// [cells] from the air: the distance down to which water has the full fraction, and that from which on it has none.
/// Rows of particles are two cells apart, the outermost in the third.
constexpr int seen_in_full = 10;
constexpr int seen = 14;

/// [cells]; half the edge of the cube around a particle over which the mean is taken.
constexpr int sight = 2;

/// Cells beside a pocket that its space contains.
constexpr int margin = seen + sight;

/// omega is the mean of four indicators: of the cells within 3, 4, 5 and 6 cells of the pocket. They differ by the
/// distance of two rows of particles, so the row in which they cut the water does not matter.
constexpr int first_cut = 3;
constexpr int last_cut = 6;

double weight_of_layer(int layer) {
  return std::max(0.0, static_cast<double>(last_cut + 1 - std::max(layer, first_cut)) / (last_cut + 1 - first_cut));
}

/// The weight of the air in a cell, by its layer.
double sight_of_layer(int layer) {
  return std::clamp(static_cast<double>(seen - layer) / (seen - seen_in_full), 0.0, 1.0);
}

void add_share(int pocket, double share, std::vector<PocketShare>& shares) {
  const auto known = std::ranges::find(shares, pocket, &PocketShare::pocket);
  if (known == shares.end()) {
    shares.push_back({pocket, share});
  } else {
    known->share += share;
  }
}

/// Whether a plate stands between two places.
template <int Dim>
bool is_behind_plate(const Boundary<Dim>& boundary, const Vec<Dim>& from, const Vec<Dim>& to) {
  return std::ranges::any_of(boundary.screens_near(from, (to - from).norm()), [&](int s) {
    const Screen<Dim>& screen = boundary.screens[s];
    return screen.is_plate && !screen.is_beyond && screen.is_between(from, to);
  });
}

/// Maximum number of cells of a block along an axis: the cube of a particle is in three, or in four where cells are a
/// little smaller than dx/2.
constexpr int max_along = 4;

/// Calls `visit(offset, place)` for the cells `first` + `offset` of a block, `cells` along each axis, across a periodic
/// border too. The place is that in a box of `count` cells from `low`; -1 outside of it.
template <int Dim, class Visit>
void visit_block(const VoidGrid<Dim>& grid, const typename VoidGrid<Dim>::Cell& low,
                 const typename VoidGrid<Dim>::Cell& count, const typename VoidGrid<Dim>::Cell& first,
                 const typename VoidGrid<Dim>::Cell& cells, Visit&& visit) {
  constexpr std::int64_t outside = std::numeric_limits<std::int64_t>::min() / 4;
  std::array<std::array<std::int64_t, max_along>, Dim> parts;  // parts of the place, by axis
  std::int64_t stride = 1;
  for (int d = Dim - 1; d >= 0; --d) {
    for (int k = 0; k < cells[d]; ++k) {
      int c = first[d] + k;
      const bool is_inside = grid.wrap(d, c) && c >= low[d] && c < low[d] + count[d];
      parts[d][k] = is_inside ? stride * (c - low[d]) : outside;
    }
    stride *= count[d];
  }
  typename VoidGrid<Dim>::Cell offset{};
  for (int axis = 0; axis < Dim;) {
    std::int64_t place = 0;
    for (int d = 0; d < Dim; ++d) place += parts[d][offset[d]];
    visit(offset, std::max<std::int64_t>(place, -1));
    for (axis = 0; axis < Dim && ++offset[axis] == cells[axis]; ++axis) offset[axis] = 0;
  }
}

}  // namespace

template <int Dim>
PocketSpace<Dim>::PocketSpace(std::shared_ptr<const VoidGrid<Dim>> grid, double spacing, const Voids<Dim>& voids,
                              const CellMarks& walls, const Boundary<Dim>& boundary,
                              std::span<const FoundPocket> pockets)
    : grid_(std::move(grid)), spacing_(spacing), pockets_(static_cast<int>(pockets.size())) {
  if (pockets.empty()) return;
  find_bounds(pockets);
  fill(voids, walls, pockets);
  grow(boundary);
}

template <int Dim>
void PocketSpace<Dim>::find_bounds(std::span<const FoundPocket> pockets) {
  Cell high{};
  for (int d = 0; d < Dim; ++d) {
    low_[d] = std::numeric_limits<int>::max();
    for (const FoundPocket& found : pockets) {
      for (const CellRun& run : found.pocket.cells) {
        low_[d] = std::min(low_[d], grid_->cell(run.row, run.begin)[d]);
        high[d] = std::max(high[d], grid_->cell(run.row, run.end - 1)[d]);
      }
    }
    low_[d] = grid_->repeats(d) ? 0 : std::max(0, low_[d] - margin);
    high[d] = grid_->repeats(d) ? grid_->count(d) - 1 : std::min(grid_->count(d) - 1, high[d] + margin);
    count_[d] = high[d] - low_[d] + 1;
  }
}

template <int Dim>
std::int64_t PocketSpace<Dim>::place(const Cell& c) const {
  std::int64_t place = 0;
  for (int d = 0; d < Dim; ++d) {
    const int k = c[d] - low_[d];
    if (k < 0 || k >= count_[d]) return -1;
    place = place * count_[d] + k;
  }
  return place;
}

/// Whether a place, in cells, is in this space. Outside, particles have no air of a pocket and do not count in its
/// volume.
template <int Dim>
bool PocketSpace<Dim>::is_inside(const Vec<Dim>& at) const {
  for (int d = 0; d < Dim; ++d) {
    if (!grid_->repeats(d) && (at[d] < low_[d] || at[d] > low_[d] + count_[d])) return false;
  }
  return true;
}

/// Calls visit(place, cell) for all cells in order.
template <int Dim>
template <class Visit>
void PocketSpace<Dim>::visit_cells(Visit&& visit) const {
  Cell c = low_;
  for (std::size_t place = 0; place < owner_.size(); ++place) {
    visit(static_cast<std::int64_t>(place), c);
    for (int axis = Dim - 1; axis >= 0 && ++c[axis] == low_[axis] + count_[axis]; --axis) c[axis] = low_[axis];
  }
}

/// Calls visit(place, cell, step) for the cells beside `c`; `step` [m] is from the centre of `c` to theirs.
template <int Dim>
template <class Visit>
void PocketSpace<Dim>::visit_sides(const Cell& c, Visit&& visit) const {
  for (int axis = 0; axis < Dim; ++axis) {
    for (const int direction : {-1, 1}) {
      Cell other = c;
      if (!grid_->step(other, axis, direction)) continue;
      const std::int64_t k = place(other);
      if (k >= 0) visit(k, other, Vec<Dim>(direction * grid_->edge()[axis] * Vec<Dim>::Unit(axis)));
    }
  }
}

template <int Dim>
void PocketSpace<Dim>::set(const CellRun& run, std::int16_t owner) {
  Cell c = grid_->cell(run.row, std::max<int>(run.begin, low_[Dim - 1]));
  const int end = std::min<int>(run.end, low_[Dim - 1] + count_[Dim - 1]);
  if (c[Dim - 1] >= end) return;
  const std::int64_t first = place(c);
  if (first >= 0) std::fill_n(owner_.begin() + first, end - c[Dim - 1], owner);
}

template <int Dim>
void PocketSpace<Dim>::fill(const Voids<Dim>& voids, const CellMarks& walls, std::span<const FoundPocket> pockets) {
  std::size_t cells = 1;
  for (const int count : count_) cells *= static_cast<std::size_t>(count);
  owner_.assign(cells, in_water);
  layer_.assign(cells, 0);
  visit_cells([&](std::int64_t k, const Cell& c) {
    if (walls(grid_->row_of(c), c[Dim - 1])) owner_[k] = behind_wall;
  });
  for (const CellRun& run : voids.runs()) set(run, open_air);
  for (std::size_t p = 0; p < pockets.size(); ++p) {
    for (const CellRun& run : pockets[p].pocket.cells) set(run, static_cast<std::int16_t>(p + 1));
  }
}

/// Assigns the cells of the water to the nearest air, in steps through the sides of cells but not through plates.
template <int Dim>
void PocketSpace<Dim>::grow(const Boundary<Dim>& boundary) {
  std::vector<Cell> front;
  visit_cells([&](std::int64_t k, const Cell& c) {
    if (owner_[k] < 0) return;
    bool is_beside_water = false;
    visit_sides(
        c, [&](std::int64_t other, const Cell&, const Vec<Dim>&) { is_beside_water |= owner_[other] == in_water; });
    if (is_beside_water) front.push_back(c);
  });
  std::vector<Cell> next;
  for (int layer = 1; layer < seen; ++layer, front.swap(next)) {
    next.clear();
    for (const Cell& c : front) {
      const std::int16_t owner = owner_[place(c)];
      const Vec<Dim> centre = grid_->centre(c);
      visit_sides(c, [&](std::int64_t k, const Cell& other, const Vec<Dim>& step) {
        if (owner_[k] != in_water || is_behind_plate<Dim>(boundary, centre, centre + step)) return;
        owner_[k] = owner;
        layer_[k] = static_cast<std::int8_t>(layer);
        next.push_back(other);
      });
    }
  }
}

template <int Dim>
double PocketSpace<Dim>::in_front(const Cell& c, const Boundary<Dim>& boundary) const {
  Cell first;
  Cell cells;
  for (int d = 0; d < Dim; ++d) {
    first[d] = c[d] - 1;
    cells[d] = 3;
  }
  bool is_beside_wall = false;
  visit_block(*grid_, low_, count_, first, cells, [&](const Cell& /*offset*/, std::int64_t k) {
    is_beside_wall = is_beside_wall || (k >= 0 && owner_[k] == behind_wall);
  });
  if (!is_beside_wall) return 1.0;
  const NearestWall<Dim> nearest = boundary.nearest(grid_->centre(c), spacing_);
  if (nearest.face < 0 || boundary.walls[boundary.faces[nearest.face].wall].is_plate) return 1.0;
  return std::clamp(0.5 + nearest.signed_distance / grid_->edge().maxCoeff(), 0.0, 1.0);
}

template <int Dim>
double PocketSpace<Dim>::weight_of(std::int64_t place) const {
  return place >= 0 && owner_[place] > 0 ? weight_of_layer(layer_[place]) : 0.0;
}

/// Whether a cell, beside or around `x`, is in front of the walls and plates that `x` is in front of.
template <int Dim>
bool PocketSpace<Dim>::is_seen(const Boundary<Dim>& boundary, const Vec<Dim>& x, const Cell& c,
                               std::int64_t place) const {
  if (place >= 0 && owner_[place] == behind_wall) return false;
  return !is_behind_plate<Dim>(boundary, x, grid_->centre(c));
}

/// Subtracts the water of one particle from the volumes. The part of its cube that is behind walls belongs in front of
/// them.
template <int Dim>
void PocketSpace<Dim>::take_water(const Boundary<Dim>& boundary, const Vec<Dim>& x, double volume,
                                  std::vector<double>& volumes) const {
  const Vec<Dim> at = grid_->in_cells(x);
  if (!is_inside(at)) return;
  Cell first;
  Cell cells;
  for (int d = 0; d < Dim; ++d) {
    const double half = 0.5 * spacing_ / grid_->edge()[d];
    first[d] = static_cast<int>(std::floor(at[d] - half + 0.5));
    cells[d] = static_cast<int>(std::floor(at[d] + half + 0.5)) - first[d] + 1;
  }
  std::array<std::pair<int, double>, static_cast<std::size_t>(power<Dim>(max_along))> taken;  // by pocket
  std::size_t count = 0;
  double all = 0.0;
  visit_block(*grid_, low_, count_, first, cells, [&](const Cell& offset, std::int64_t k) {
    double part = 1.0;
    Cell c;
    for (int d = 0; d < Dim; ++d) {
      const double half = 0.5 * spacing_ / grid_->edge()[d];
      c[d] = first[d] + offset[d];
      part *= std::max(0.0, std::min(c[d] + 0.5, at[d] + half) - std::max(c[d] - 0.5, at[d] - half));
    }
    if (!is_seen(boundary, x, c, k)) return;
    all += part;
    const double weight = weight_of(k);
    if (part * weight > 0.0) taken[count++] = {owner_[k] - 1, part * weight};
  });
  for (std::size_t n = 0; n < count; ++n) volumes[taken[n].first] -= volume * taken[n].second / all;
}

template <int Dim>
std::vector<double> PocketSpace<Dim>::volumes(const Boundary<Dim>& boundary, const Particles<Dim>& particles,
                                              const Communicator& ranks) const {
  std::vector<double> volumes(pockets_, 0.0);
  if (pockets_ == 0) return volumes;
  visit_cells([&](std::int64_t k, const Cell& c) {
    const double weight = weight_of(k);
    const bool is_mine = grid_->row_of(c) % ranks.size() == ranks.rank();
    if (weight > 0.0 && is_mine) volumes[owner_[k] - 1] += weight * grid_->cell_volume() * in_front(c, boundary);
  });
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: sums by pocket
    if (particles.is_fluid(i)) take_water(boundary, particles.position[i], particles.volume[i], volumes);
  }
  ranks.sum_of_each(volumes);
  for (double& volume : volumes) volume = std::max(volume, grid_->cell_volume());
  return volumes;
}

template <int Dim>
int PocketSpace<Dim>::pocket_at(const Vec<Dim>& x) const {
  if (pockets_ == 0) return -1;
  int pocket = -1;
  double nearest = std::numeric_limits<double>::infinity();
  grid_->visit_ball(x, spacing_, [&](int row, int begin, int end) {
    for (int n = begin; n < end; ++n) {
      const Cell c = grid_->cell(row, n);
      const std::int64_t k = place(c);
      const double square = (grid_->centre(c) - x).squaredNorm();
      if (k < 0 || owner_[k] < 0 || layer_[k] > 0 || square >= nearest) continue;
      nearest = square;
      pocket = owner_[k] - 1;
    }
  });
  return pocket;
}

template <int Dim>
std::vector<PocketShare> PocketSpace<Dim>::shares_at(const Boundary<Dim>& boundary, const Vec<Dim>& x) const {
  std::vector<PocketShare> shares;
  if (pockets_ == 0) return shares;
  const Vec<Dim> at = grid_->in_cells(x);
  if (!is_inside(at)) return shares;
  // Weights that fall to 0 at the faces of the cube make the fractions continuous in x.
  constexpr int edge = 2 * sight;
  Cell first;
  Cell cells;
  std::array<std::array<double, edge>, Dim> weights;
  for (int d = 0; d < Dim; ++d) {
    cells[d] = edge;
    first[d] = static_cast<int>(std::ceil(at[d])) - sight;
    for (int k = 0; k < edge; ++k) weights[d][k] = sight - std::abs(first[d] + k - at[d]);
  }
  double all = 0.0;
  visit_block(*grid_, low_, count_, first, cells, [&](const Cell& offset, std::int64_t k) {
    double weight = 1.0;
    Cell c;
    for (int d = 0; d < Dim; ++d) {
      weight *= weights[d][offset[d]];
      c[d] = first[d] + offset[d];
    }
    if (!is_seen(boundary, x, c, k)) return;
    all += weight;
    if (weight > 0.0 && k >= 0 && owner_[k] > 0) add_share(owner_[k] - 1, weight * sight_of_layer(layer_[k]), shares);
  });
  for (PocketShare& share : shares) share.share /= all;
  return shares;
}

template class PocketSpace<2>;
template class PocketSpace<3>;

}  // namespace tailwater
