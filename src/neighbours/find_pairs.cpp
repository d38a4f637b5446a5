#include "neighbours/find_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/batch.h"
#include "base/for_each.h"
#include "base/lane_loop.h"
#include "base/room.h"
#include "neighbours/pair_lanes.h"

namespace tailwater {
namespace {

/// By how much the square of a distance may be rounded below that of the least distance.
constexpr double parted_tolerance = 1e-3;

/// The share by which the square of the radius is less in the search, so that no pair beyond the support is rounded
/// into it.
constexpr double rounded_at_rim = 1e-6;

/// Particles that are searched for together are at most so many, and no farther apart along any axis than this share of
/// the support.
constexpr int most_in_group = 32;
constexpr double group_extent = 1.4;

/// A grid of the fluid alone. Most dummies are dry: in it they find empty cells only.
template <int Dim>
struct FluidGrid {
  FluidGrid(const Particles<Dim>& particles, double reach) {
    const std::vector<std::size_t> fluid =
        indices_where(particles.size(), [&](std::size_t n) { return particles.is_fluid(n); });
    std::vector<Vec<Dim>> position(fluid.size());
    for_each(fluid.size(), [&](std::size_t n) { position[n] = particles.position[fluid[n]]; });
    grid = CellGrid<Dim>(position, reach);
    order.resize(fluid.size() + batch_size);
    for_each(fluid.size(), [&](std::size_t n) { order[n] = static_cast<std::int32_t>(fluid[grid.order()[n]]); });
  }

  CellGrid<Dim> grid;
  std::vector<std::int32_t> order;
};

/// What a search goes through.
template <int Dim>
struct Searched {
  const CellGrid<Dim>& grid;
  const std::int32_t* order;  ///< of the grid, as indices of particles; may be read a batch beyond its end
  bool holds_those_who_search;
};

/// Particles that follow each other and are near each other. Their neighbours are looked for among the same candidates.
template <int Dim>
struct Group {
  Group(std::span<const Vec<Dim>> position, std::size_t first)
      : begin(static_cast<std::int32_t>(first)), end(begin + 1), low(position[first]), high(low) {}

  /// Takes the next particle in, unless the box would then be longer than `extent` [m].
  bool take(const Vec<Dim>& position, double extent) {
    const Vec<Dim> new_low = low.cwiseMin(position);
    const Vec<Dim> new_high = high.cwiseMax(position);
    if ((new_high - new_low).maxCoeff() > extent) return false;
    low = new_low;
    high = new_high;
    ++end;
    return true;
  }

  std::int32_t begin;
  std::int32_t end;
  Vec<Dim> low;  ///< m; of the box around them
  Vec<Dim> high;
};

/// Indices of particles, written a batch at a time. May be read a batch beyond the end, where there are indices too.
class IndexList {
 public:
  void clear() { count_ = 0; }
  /// For so many more.
  void make_room(std::size_t more) {
    if (count_ + more + batch_size > index_.size()) index_.resize(2 * (count_ + more + batch_size));
  }
  /// Those of a batch whose bit is set.
  void add(const std::int32_t* indices, unsigned bits) {
    count_ = write_chosen(indices, bits, index_.data() + count_) - index_.data();
  }
  /// Those that are in memory, from where they may be read a batch beyond the end.
  void add(std::span<const std::int32_t> indices) {
    make_room(indices.size());
    for (std::size_t n = 0; n < indices.size(); n += batch_size) {
      std::memcpy(index_.data() + count_ + n, indices.data() + n, batch_size * sizeof(std::int32_t));
    }
    count_ += indices.size();
  }
  /// From `begin` to `end`.
  void add_all(std::int32_t begin, std::int32_t end) {
    make_room(end - begin);
    for (; begin < end; ++begin) index_[count_++] = begin;
  }
  template <class Condition>
  void remove_if(const Condition& condition) {
    count_ = std::remove_if(index_.begin(), index_.begin() + static_cast<std::ptrdiff_t>(count_), condition) -
             index_.begin();
  }

  std::size_t size() const { return count_; }
  const std::int32_t* data() const { return index_.data(); }

 private:
  std::vector<std::int32_t> index_ = std::vector<std::int32_t>(batch_size);
  std::size_t count_ = 0;
};

/// What a search finds of a row.
struct FoundRow {
  std::size_t size;
  bool sees_wall;
  bool is_crowded;  ///< some neighbours are nearer than the least distance
};

/// All that may be neighbours of the particles of a group, number by number, so that they are read in lanes. They have
/// the order of a row: indices below the group, the group, indices above it, ghosts.
template <int Dim>
class Candidates {
 public:
  void find(const Searched<Dim>& searched, const Pairs<Dim>& pairs, const Group<Dim>& group) {
    const auto owned = static_cast<std::int32_t>(pairs.owned());
    for (IndexList& list : lists_) list.clear();
    auto& [below, own, above, ghosts] = lists_;
    const bool has_ghosts = pairs.owned() < pairs.place.size();
    // Copied before they are told apart, because most ranges are shorter than a batch.
    near_.clear();
    searched.grid.for_each_range_near(group.low, group.high, [&](std::int32_t begin, std::int32_t end) {
      near_.add({searched.order + begin, searched.order + end});
    });
    for (IndexList* list : {&below, &above, &ghosts}) list->make_room(near_.size());
    for (std::size_t n = 0; n < near_.size(); n += batch_size) {
      const std::int32_t* const indices = near_.data() + n;
      const auto index = batch_at<IndexBatch>(indices);
      const unsigned all = first_bits(near_.size() - n);
      below.add(indices, all & bits_of(index < group.begin));
      above.add(indices, all & bits_of((index >= group.end) & (index < owned)));
      if (has_ghosts) ghosts.add(indices, all & bits_of(index >= owned));
    }
    if (searched.holds_those_who_search) own.add_all(group.begin, group.end);

    // In the coarse cells that a distant particle asks for, most are far away, some so far that places repeat.
    const double radius = kernel_radius(pairs.kernel);
    const bool is_coarse = searched.grid.reach() > 1.5 * radius;
    count_ = 0;
    holds_group_ = searched.holds_those_who_search;
    begin_of_group_ = group.begin;
    for (IndexList& list : lists_) {
      if (&list == &own) place_of_group_ = count_;
      if (is_coarse) {
        list.remove_if([&](std::int32_t j) { return squared_distance(pairs.position[j], group) > radius * radius; });
      }
      append(pairs, list);
    }
    for (int n = 0; n < batch_size; ++n) at_[0][count_ + n] = pairs.place[group.begin].at[0] + farthest;
  }

  std::size_t size() const { return count_; }

  /// Writes the neighbours of particle i of the group to `j`, and up to a batch beyond them.
  FoundRow write_neighbours(const Pairs<Dim>& pairs, std::int32_t i, std::int32_t* j) {
    // Meanwhile the particle stands elsewhere, so that it does not find itself.
    std::uint32_t nowhere = 0;
    std::uint32_t& of_itself = holds_group_ ? at_[0][place_of_group_ + (i - begin_of_group_)] : nowhere;
    of_itself += farthest;
    const FoundRow row = write_near(pairs, pairs.place[i], j);
    of_itself -= farthest;
    return row;
  }

 private:
  /// From any place, and from those of a group nearly, the place farthest from it.
  static constexpr std::uint32_t farthest = 1U << 31;

  static double squared_distance(const Vec<Dim>& position, const Group<Dim>& group) {
    return (position - position.cwiseMax(group.low).cwiseMin(group.high)).squaredNorm();
  }

  /// Writes those within the support around `own` to `j`, and up to a batch beyond them.
  FoundRow write_near(const Pairs<Dim>& pairs, const Place<Dim>& own, std::int32_t* j) const {
    const double radius = kernel_radius(pairs.kernel);
    const FloatBatch radius_squared = FloatBatch{} + static_cast<float>((1.0 - rounded_at_rim) * radius * radius);
    const FloatBatch too_near = FloatBatch{} + static_cast<float>(1.0 - parted_tolerance) * pairs.least_squared;
    const std::array<float, Dim> unit = pairs.unit;
    // Out of the vectors, so that a loop that writes keeps the addresses in registers.
    const std::int32_t* const index = index_.data();
    const float* const signed_volume = signed_volume_.data();
    std::array<const std::uint32_t*, Dim> at;
    for (int a = 0; a < Dim; ++a) at[a] = at_[a].data();
    const std::size_t count = count_;
    std::int32_t* end = j;
    IndexBatch walls{};
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
      const IndexBatch is_near = distances < radius_squared;
      walls |= is_near & batch_at<IndexBatch>(signed_volume + n);  // of which the sign counts
      least = distances < least ? distances : least;
      end = write_chosen(index + n, bits_of(is_near), end);
    }
    return {static_cast<std::size_t>(end - j), bits_of(walls < 0) != 0, bits_of(least < too_near) != 0};
  }

  /// Reads and writes up to a batch beyond the end.
  void append(const Pairs<Dim>& pairs, const IndexList& list) {
    const std::size_t room = count_ + list.size() + batch_size;
    if (room > index_.size()) {
      index_.resize(2 * room);
      signed_volume_.resize(2 * room);
      for (auto& at : at_) at.resize(2 * room);
    }
    for (std::size_t n = 0; n < list.size(); n += lane_count) {
      IntegerLanes j;
      std::memcpy(&j, list.data() + n, sizeof(j));
      const auto numbers = LaneIndices(j).numbers(pairs.place.data());
      std::memcpy(index_.data() + count_ + n, &j, sizeof(j));
      for (int a = 0; a < Dim; ++a) std::memcpy(at_[a].data() + count_ + n, &numbers[a], sizeof(j));
      std::memcpy(signed_volume_.data() + count_ + n, &numbers[Dim], sizeof(j));
    }
    count_ += list.size();
  }

  IndexList near_;
  std::array<IndexList, 4> lists_;
  std::vector<std::int32_t> index_;
  std::array<std::vector<std::uint32_t>, Dim> at_;  ///< in units of Pairs::unit
  std::vector<float> signed_volume_;                ///< m^Dim; negative of a wall particle
  std::size_t count_ = 0;
  bool holds_group_ = false;
  std::int32_t begin_of_group_ = 0;
  std::size_t place_of_group_ = 0;  ///< among the candidates
};

/// Of each two neighbours that are too near puts the one with the larger id where Pairs::d sees it, so that loops in
/// lanes need not ask. A particle that sees both as ghosts sees them at one place.
template <int Dim>
void part_coinciding(Pairs<Dim>& pairs) {
  const auto least = static_cast<std::uint32_t>(std::ceil(pairs.least_distance / pairs.unit[0]));
  // More than the search finds too near, whatever was rounded there: what it finds again has moved.
  const double too_near = (1.0 - 0.5 * parted_tolerance) * pairs.least_distance * pairs.least_distance;
  const auto squared_distance = [&](const Place<Dim>& a, const Place<Dim>& b) {
    double squared = 0.0;
    for (int d = 0; d < Dim; ++d) {
      const double apart = pairs.unit[d] * static_cast<double>(static_cast<std::int32_t>(a.at[d] - b.at[d]));
      squared += apart * apart;
    }
    return squared;
  };
  for (std::size_t i = 0; i < pairs.owned(); ++i) {  // in order: a place that was changed is compared again
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const std::size_t j = pairs.j[k];
      if (squared_distance(pairs.place[i], pairs.place[j]) >= too_near) continue;
      const auto [stays, goes] = pairs.id[i] < pairs.id[j] ? std::pair(i, j) : std::pair(j, i);
      pairs.place[goes].at = pairs.place[stays].at;
      pairs.place[goes].at[0] -= least;
    }
  }
}

/// Finds the rows from the places. Returns in how many of them neighbours are nearer than the least distance.
template <int Dim>
std::size_t find_rows(const CellGrid<Dim>& grid, const FluidGrid<Dim>& fluid, const Particles<Dim>& particles,
                      WallRows wall_rows, Pairs<Dim>& pairs) {
  const Searched<Dim> all{grid, grid.order().data(), true};
  const Searched<Dim> only_fluid{fluid.grid, fluid.order.data(), false};  // searched by walls
  const auto sees_all = [&](std::size_t i) { return wall_rows == WallRows::all || particles.is_fluid(i); };
  const double extent = group_extent * kernel_radius(pairs.kernel);
  Candidates<Dim> candidates;
  const auto for_each_row = [&](auto&& body) {
    for (std::size_t i = 0; i < particles.owned;) {  // in order: a group begins where the last one ends
      Group<Dim> group(pairs.position, i);
      while (group.end - group.begin < most_in_group && group.end < static_cast<std::int32_t>(particles.owned) &&
             sees_all(group.end) == sees_all(i) && group.take(pairs.position[group.end], extent)) {
      }
      candidates.find(sees_all(i) ? all : only_fluid, pairs, group);
      for (const auto end = static_cast<std::size_t>(group.end); i < end; ++i) body(i);
    }
  };
  const auto write_row = [&](std::size_t i, std::int32_t* j) {
    return candidates.write_neighbours(pairs, static_cast<std::int32_t>(i), j);
  };
  pairs.row_begin.resize(particles.owned + 1);
  pairs.row_begin[0] = 0;
  pairs.sees_wall.resize(particles.owned);
  // The first pairs are counted before they are kept; later ones are about as many as the last.
  std::size_t expected = pairs.j.size();
  if (expected == 0) {
    std::vector<std::int32_t> j;
    for_each_row([&](std::size_t i) {
      j.resize(std::max(j.size(), candidates.size() + batch_size));
      expected += write_row(i, j.data()).size;
    });
    expected += expected / 4;  // of a lattice, as at the start: many may stand just beyond the rim
  }
  make_room(pairs.j, expected);
  std::size_t crowded = 0;
  for_each_row([&](std::size_t i) {  // in order: rows are put one behind the other
    const std::size_t begin = pairs.row_begin[i];
    const std::size_t most = begin + candidates.size() + batch_size;
    if (most > pairs.j.capacity()) pairs.j.reserve(with_room(most * (particles.owned / (i + 1) + 1)));
    if (most > pairs.j.size()) pairs.j.resize(pairs.j.capacity());
    const FoundRow row = write_row(i, pairs.j.data() + begin);
    pairs.row_begin[i + 1] = begin + row.size;
    pairs.sees_wall[i] = row.sees_wall ? 1 : 0;
    crowded += row.is_crowded ? 1 : 0;
  });
  pairs.j.resize(pairs.row_begin.back());
  return crowded;
}

}  // namespace

template <int Dim>
void find_pairs(const Kernel<Dim>& kernel, const CellGrid<Dim>& grid, const Particles<Dim>& particles,
                WallRows wall_rows, double least_distance, Pairs<Dim>& pairs) {
  pairs.position = particles.position;
  pairs.id = particles.id;
  pairs.least_distance = least_distance;
  pairs.least_squared = static_cast<float>(least_distance * least_distance);
  pairs.kernel = kernel;
  pairs.kernel_in_lanes = in_single_precision(kernel);
  const FluidGrid<Dim> fluid(particles, kernel_radius(kernel));
  while (find_rows(grid, fluid, particles, wall_rows, pairs) > 0) part_coinciding(pairs);
}

template <int Dim>
void find_places(const Particles<Dim>& particles, const PeriodicDomain<Dim>& domain, double radius, Pairs<Dim>& pairs) {
  Vec<Dim> unit = Vec<Dim>::Constant(static_cast<float>(radius * 0x1p-28));
  for (int d = 0; d < Dim; ++d) {
    if (domain[d]) {  // a whole number of units in a period, so that images are as far away as their owners
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
