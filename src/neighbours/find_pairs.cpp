// Search for pairs, group by group of particles that are near each other:
//
//   group    the particles of a group search the grid once, for the box around them;
//   filter   the indices from the grid are sorted into the order of a row (candidate_indices.h);
//   append   the places of these candidates are stored contiguously, so that they are read in lanes;
//   write    each particle of the group writes the candidates within its support, eight at a time, without a branch.
//
// Particles that coincide are then moved apart, and the rows are computed again.
#include "neighbours/find_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "base/batch.h"
#include "base/for_each.h"
#include "base/lane_loop.h"
#include "base/room.h"
#include "neighbours/candidate_indices.h"
#include "neighbours/pair_lanes.h"

namespace tailwater {
namespace {

/// Margin of the least squared distance for rounding errors, as a fraction of it.
constexpr double parted_tolerance = 1e-3;

/// Fraction by which the square of the radius is reduced in the search, so that no pair beyond the support is rounded
/// into it.
constexpr double rounded_at_rim = 1e-6;

/// Largest number of particles in a group, and the largest edge of the box around them in radii of the support.
constexpr int max_group_size = 32;
constexpr double max_group_extent = 1.4;

/// Grid of some particles.
template <int Dim>
struct PartGrid {
  PartGrid(const Particles<Dim>& particles, const std::vector<std::size_t>& part, double reach) {
    std::vector<Vec<Dim>> position(part.size());
    for_each(part.size(), [&](std::size_t n) { position[n] = particles.position[part[n]]; });
    grid = CellGrid<Dim>(position, reach);
    order.resize(part.size() + batch_size);
    for_each(part.size(), [&](std::size_t n) { order[n] = static_cast<std::int32_t>(part[grid.order()[n]]); });
  }

  CellGrid<Dim> grid;
  std::vector<std::int32_t> order;
};

/// Grids of the particles for which a condition holds. Where particles have several spacings, a grid has those with
/// spacings from a power of 1/2 up to the next one, and cells to match: with the cells and the reach of the largest
/// spacing, most candidates would be too far away.
template <int Dim>
class PartGrids {
 public:
  template <class Condition>
  PartGrids(const Particles<Dim>& particles, const Pairs<Dim>& pairs, const Condition& is_in) {
    const double radius = kernel_radius(pairs.kernel);
    const auto level_of = [&](std::size_t n) { return std::ilogb(1.0F / pairs.relative_spacing[n]); };
    int finest = 0;
    if (pairs.is_graded()) {
      for (std::size_t n = 0; n < particles.size(); ++n) finest = std::max(finest, level_of(n));
    }
    for (int level = 0; level <= finest; ++level) {
      const std::vector<std::size_t> part = indices_where(
          particles.size(), [&](std::size_t n) { return is_in(n) && (!pairs.is_graded() || level_of(n) == level); });
      const double largest = std::ldexp(1.0, -level);
      grids_.emplace_back(particles, part, largest * radius);
      spacings_.push_back(largest);
    }
  }

  SearchedSet<Dim> searched(bool holds_searchers) const {
    SearchedSet<Dim> set{{}, holds_searchers};
    for (std::size_t n = 0; n < grids_.size(); ++n) {
      set.grids.push_back({&grids_[n].grid, grids_[n].order.data(), spacings_[n]});
    }
    return set;
  }

 private:
  std::vector<PartGrid<Dim>> grids_;
  std::vector<double> spacings_;  ///< the largest in each grid, over that of the case
};

/// Properties of a row as written by Candidates.
struct FoundRow {
  std::size_t size;
  bool sees_wall;
  bool is_crowded;       ///< whether a neighbour is nearer than the least distance
  bool has_one_spacing;  ///< whether all particles have the same spacing
};

/// Candidates of a group, one array per component, so that they are read in lanes.
template <int Dim>
class Candidates {
 public:
  void find(const SearchedSet<Dim>& searched, const Pairs<Dim>& pairs, const Group<Dim>& group) {
    indices_.find(searched, pairs, group);
    count_ = 0;
    append(pairs, indices_.below());
    holds_group_ = searched.holds_searchers;
    offset_of_group_ = static_cast<std::ptrdiff_t>(count_) - group.begin;
    append(pairs, indices_.own());
    append(pairs, indices_.above());
    append(pairs, indices_.ghosts());
    // The last batch is read to its end: place the entries beyond the last candidate far from the group.
    for (int n = 0; n < batch_size; ++n) at_[0][count_ + n] = pairs.place[group.begin].at[0] + farthest;
  }

  std::size_t size() const { return count_; }

  /// Writes the neighbours of particle i of the group to `j`, and up to a batch beyond them.
  FoundRow write_neighbours(const Pairs<Dim>& pairs, std::size_t i, std::int32_t* j) {
    std::uint32_t not_a_candidate = 0;
    std::uint32_t& own_place = holds_group_ ? at_[0][offset_of_group_ + i] : not_a_candidate;
    own_place += farthest;  // excludes the particle itself
    const FoundRow row = pairs.is_graded() ? write_near<true>(pairs, i, j) : write_near<false>(pairs, i, j);
    own_place -= farthest;
    return row;
  }

 private:
  /// Largest distance between two places in units, because integer places repeat.
  static constexpr std::uint32_t farthest = 1U << 31;

  /// Writes the candidates within the support of particle i to `j`, and up to a batch beyond them.
  template <bool is_graded>
  FoundRow write_near(const Pairs<Dim>& pairs, std::size_t i, std::int32_t* j) const {
    const Place<Dim>& own = pairs.place[i];
    const double radius = kernel_radius(pairs.kernel);
    const FloatBatch radius_squared = FloatBatch{} + static_cast<float>((1.0 - rounded_at_rim) * radius * radius);
    const FloatBatch too_near = FloatBatch{} + static_cast<float>(1.0 - parted_tolerance) * pairs.min_distance_squared;
    const std::array<float, Dim> unit = pairs.unit;
    // Copies of the addresses: the loop, which writes, keeps them in registers.
    const std::int32_t* const index = index_.data();
    const float* const signed_volume = signed_volume_.data();
    std::array<const std::uint32_t*, Dim> at;
    for (int a = 0; a < Dim; ++a) at[a] = at_[a].data();
    const std::size_t count = count_;
    std::int32_t* end = j;
    IndexBatch walls{};
    IndexBatch others{};  // of another spacing
    FloatBatch least = radius_squared;
    for (std::size_t n = 0; n < count; n += batch_size) {
      FloatBatch distances;
      for (int m = 0; m < batch_size; m += lane_count) {
        VecLanes<Dim> d;
        for (int a = 0; a < Dim; ++a) {
          IntegerLanes places;
          std::memcpy(&places, at[a] + n + m, sizeof(places));
          d.at[a] = difference(unit[a], own.at[a], places);
        }
        const Lanes square = d.dot(d);
        std::memcpy(reinterpret_cast<float*>(&distances) + m, &square, sizeof(square));
      }
      FloatBatch reach_squared = radius_squared;
      IndexBatch is_other{};
      if constexpr (is_graded) {
        const auto relative = batch_at<FloatBatch>(relative_spacing_.data() + n);
        const FloatBatch mean = 0.5F * (pairs.relative_spacing[i] + relative);
        reach_squared *= mean * mean;
        is_other = relative != pairs.relative_spacing[i];
      }
      const IndexBatch is_near = distances < reach_squared;
      others |= is_near & is_other;
      walls |= is_near & batch_at<IndexBatch>(signed_volume + n);  // only the sign of the volume matters
      least = distances < least ? distances : least;
      end = write_chosen(index + n, bits_of(is_near), end);
    }
    return {static_cast<std::size_t>(end - j), bits_of(walls < 0) != 0, bits_of(least < too_near) != 0,
            bits_of(others) == 0};
  }

  /// Appends candidates. Reads and writes up to a batch beyond the end.
  void append(const Pairs<Dim>& pairs, const IndexList& list) {
    const std::size_t room = count_ + list.size() + batch_size;
    if (room > index_.size()) {
      index_.resize(2 * room);
      signed_volume_.resize(2 * room);
      if (pairs.is_graded()) relative_spacing_.resize(2 * room);
      for (auto& at : at_) at.resize(2 * room);
    }
    for (std::size_t n = 0; n < list.size(); n += lane_count) {
      IntegerLanes j;
      std::memcpy(&j, list.data() + n, sizeof(j));
      const auto numbers = LaneIndices(j).numbers(pairs.place.data());
      std::memcpy(index_.data() + count_ + n, &j, sizeof(j));
      for (int a = 0; a < Dim; ++a) std::memcpy(at_[a].data() + count_ + n, &numbers[a], sizeof(j));
      std::memcpy(signed_volume_.data() + count_ + n, &numbers[Dim], sizeof(j));
      if (!pairs.is_graded()) continue;
      const Lanes relative = LaneIndices(j)(pairs.relative_spacing.data());
      std::memcpy(relative_spacing_.data() + count_ + n, &relative, sizeof(relative));
    }
    count_ += list.size();
  }

  CandidateIndices<Dim> indices_;
  std::vector<std::int32_t> index_;
  std::array<std::vector<std::uint32_t>, Dim> at_;  ///< in units of Pairs::unit
  std::vector<float> signed_volume_;                ///< m^Dim; negative for wall particles
  std::vector<float> relative_spacing_;             ///< only if particles have several spacings
  std::size_t count_ = 0;
  bool holds_group_ = false;
  std::ptrdiff_t offset_of_group_ = 0;  ///< from the index of a particle of the group to its candidate
};

/// Moves neighbours apart that are nearer than the least distance, so that loops in lanes need no check. The particle
/// with the larger id moves to the place where Pairs::d sees it. A particle that sees both as ghosts sees them at one
/// place.
template <int Dim>
void part_coinciding(Pairs<Dim>& pairs) {
  const auto least = static_cast<std::uint32_t>(std::ceil(pairs.min_distance / pairs.unit[0]));
  // The threshold exceeds that of the search for any rounding error: pairs that are found twice have moved in between.
  const double too_near = (1.0 - 0.5 * parted_tolerance) * pairs.min_distance * pairs.min_distance;
  const auto squared_distance = [&](const Place<Dim>& a, const Place<Dim>& b) {
    double squared = 0.0;
    for (int d = 0; d < Dim; ++d) {
      const double apart = pairs.unit[d] * static_cast<double>(static_cast<std::int32_t>(a.at[d] - b.at[d]));
      squared += apart * apart;
    }
    return squared;
  };
  for (std::size_t i = 0; i < pairs.owned(); ++i) {  // in order: a place that has moved is compared again
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const std::size_t j = pairs.j[k];
      if (squared_distance(pairs.place[i], pairs.place[j]) >= too_near) continue;
      const auto [stays, goes] = pairs.id[i] < pairs.id[j] ? std::pair(i, j) : std::pair(j, i);
      pairs.place[goes].at = pairs.place[stays].at;
      pairs.place[goes].at[0] -= least;
    }
  }
}

/// The grids, and the choice between them for each particle.
template <int Dim>
struct RowSearch {
  const Particles<Dim>& particles;
  WallRows wall_rows;
  SearchedSet<Dim> all;
  SearchedSet<Dim> fluid;

  bool sees_all(std::size_t i) const { return wall_rows == WallRows::all || particles.is_fluid(i); }

  /// The longest group from `first` on that fits into a box and searches a single set.
  Group<Dim> group_from(std::size_t first, const Pairs<Dim>& pairs) const {
    Group<Dim> group(particles.position, first);
    const double max_extent = max_group_extent * kernel_radius(pairs.kernel) * pairs.relative_spacing_of(first);
    const std::size_t end = std::min<std::size_t>(particles.owned, first + max_group_size);
    group.largest_spacing = pairs.relative_spacing_of(first);
    for (std::size_t next = first + 1; next < end; ++next) {
      if (sees_all(next) != sees_all(first) || !group.add(particles.position[next], max_extent)) break;
      group.largest_spacing = std::max(group.largest_spacing, pairs.relative_spacing_of(next));
    }
    return group;
  }
};

/// Calls body(candidates, i) for each owned particle i, in order.
template <int Dim, class Body>
void for_each_row(const RowSearch<Dim>& search, const Pairs<Dim>& pairs, Body&& body) {
  Candidates<Dim> candidates;
  for (std::size_t i = 0; i < search.particles.owned;) {  // in order: a group begins at the end of the previous one
    const Group<Dim> group = search.group_from(i, pairs);
    candidates.find(search.sees_all(i) ? search.all : search.fluid, pairs, group);
    for (const auto end = static_cast<std::size_t>(group.end); i < end; ++i) body(candidates, i);
  }
}

template <int Dim>
std::size_t count_pairs(const RowSearch<Dim>& search, const Pairs<Dim>& pairs) {
  std::size_t count = 0;
  std::vector<std::int32_t> j;
  for_each_row(search, pairs, [&](Candidates<Dim>& candidates, std::size_t i) {
    j.resize(std::max(j.size(), candidates.size() + batch_size));
    count += candidates.write_neighbours(pairs, i, j.data()).size;
  });
  return count;
}

/// Computes the rows from the places. Returns the number of rows with neighbours nearer than the least distance.
template <int Dim>
std::size_t find_rows(const RowSearch<Dim>& search, Pairs<Dim>& pairs) {
  const std::size_t owned = search.particles.owned;
  pairs.row_begin.resize(owned + 1);
  pairs.row_begin[0] = 0;
  pairs.sees_wall.resize(owned);
  if (pairs.is_graded()) pairs.has_one_spacing.resize(owned);
  // The first search counts the pairs before it stores them; later ones expect as many as the last. A lattice, as at
  // the start, may have many particles just outside the support.
  std::size_t expected = pairs.j.size();
  if (expected == 0) {
    expected = count_pairs(search, pairs);
    expected += expected / 4;
  }
  make_room(pairs.j, expected);
  std::size_t crowded = 0;
  for_each_row(search, pairs, [&](Candidates<Dim>& candidates, std::size_t i) {
    const std::size_t begin = pairs.row_begin[i];
    const std::size_t max_end = begin + candidates.size() + batch_size;
    if (max_end > pairs.j.capacity()) pairs.j.reserve(with_room(max_end * (owned / (i + 1) + 1)));
    if (max_end > pairs.j.size()) pairs.j.resize(pairs.j.capacity());
    const FoundRow row = candidates.write_neighbours(pairs, i, pairs.j.data() + begin);
    pairs.row_begin[i + 1] = begin + row.size;
    pairs.sees_wall[i] = row.sees_wall ? 1 : 0;
    if (pairs.is_graded()) pairs.has_one_spacing[i] = row.has_one_spacing ? 1 : 0;
    crowded += row.is_crowded ? 1 : 0;
  });
  pairs.j.resize(pairs.row_begin.back());
  return crowded;
}

}  // namespace

template <int Dim>
void find_pairs(const Kernel<Dim>& kernel, const CellGrid<Dim>& grid, const Particles<Dim>& particles,
                WallRows wall_rows, double min_distance, Pairs<Dim>& pairs) {
  pairs.position = particles.position;
  pairs.weight.clear();
  pairs.id = particles.id;
  pairs.min_distance = min_distance;
  pairs.min_distance_squared = static_cast<float>(min_distance * min_distance);
  pairs.kernel = kernel;
  pairs.kernel_in_lanes = in_single_precision(kernel);
  // Most dummies are dry and meet only empty cells in the grids of the fluid.
  const PartGrids<Dim> fluid(particles, pairs, [&](std::size_t n) { return particles.is_fluid(n); });
  const auto all = pairs.is_graded() ? std::optional<PartGrids<Dim>>(std::in_place, particles, pairs,
                                                                     [](std::size_t /*n*/) { return true; })
                                     : std::nullopt;
  const RowSearch<Dim> search{particles, wall_rows,
                              all ? all->searched(true) : SearchedSet<Dim>{{{&grid, grid.order().data()}}, true},
                              fluid.searched(false)};
  while (find_rows(search, pairs) > 0) part_coinciding(pairs);
}

template <int Dim>
void find_places(const Particles<Dim>& particles, const PeriodicDomain<Dim>& domain, double radius, Pairs<Dim>& pairs) {
  Vec<Dim> unit = Vec<Dim>::Constant(static_cast<float>(radius * 0x1p-28));
  for (int d = 0; d < Dim; ++d) {
    if (domain[d]) {  // a whole number of units in a period, so that images are exactly as far away as their owners
      const double period = domain[d]->second - domain[d]->first;
      unit[d] = period / std::round(period / unit[d]);
    }
    pairs.unit[d] = static_cast<float>(unit[d]);
  }
  pairs.place.resize(particles.size());
  for_each(particles.size(), [&](std::size_t i) {
    Place<Dim>& place = pairs.place[i];
    for (int d = 0; d < Dim; ++d) {
      place.at[d] = static_cast<std::uint32_t>(std::llrint(particles.position[i][d] / unit[d]));
    }
    const auto volume = static_cast<float>(particles.volume[i]);
    place.signed_volume = particles.is_fluid(i) ? volume : -volume;
  });
}

TAILWATER_IN_2D_AND_3D(find_pairs);
TAILWATER_IN_2D_AND_3D(find_places);

}  // namespace tailwater
