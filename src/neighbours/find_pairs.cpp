#include "neighbours/find_pairs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/batch.h"
#include "base/for_each.h"
#include "base/lanes.h"
#include "base/room.h"
#include "neighbours/pair_lanes.h"

namespace tailwater {
namespace {

/// By how much the square of a distance may be rounded below that of the least distance.
constexpr double parted_tolerance = 1e-3;

/// The share by which the square of the radius is less in the search, so that no pair beyond the support is rounded
/// into it.
constexpr double rounded_at_rim = 1e-6;

/// Places repeat after 16 supports. A grid whose reach is up to half as many offers none that far away, but one whose
/// cells are coarse, because some particles are distant, may.
constexpr double places_differ_within = 8.0;

/// Bit n is set if index n of a batch is at least `begin` and less than `end`.
inline unsigned bits_between(const std::int32_t* indices, std::int32_t begin, std::int32_t end) {
  const auto all = batch_at<IndexBatch>(indices);
  return bits_of((all >= begin) & (all < end));
}

/// The places of particles in the order of a grid, number by number, so that those of a range of cells are read in
/// lanes. The last range may be read beyond its end.
template <int Dim>
class OrderedPlaces {
 public:
  OrderedPlaces(std::span<const std::int32_t> order, std::span<const Place<Dim>> place)
      : index_(order.begin(), order.end()) {
    index_.resize(order.size() + batch);
    for (int d = 0; d < Dim; ++d) {
      at_[d].resize(index_.size());
      for_each(order.size(), [&](std::size_t n) { at_[d][n] = place[index_[n]].at[d]; });
    }
    signed_volume_.resize(index_.size());
    for_each(order.size(), [&](std::size_t n) { signed_volume_[n] = place[index_[n]].signed_volume; });
  }

  /// Where the numbers of place n of the order and those behind it are. Outside the class, so that a loop that writes
  /// keeps the addresses in registers.
  struct View {
    const std::int32_t* index;                 ///< of the particle
    std::array<const std::uint32_t*, Dim> at;  ///< in units of Pairs::unit
    const float* signed_volume;                ///< m^Dim; negative of a wall particle

    /// The squares of the distances [m^2] to `own`.
    FloatBatch squared_distances(const std::array<float, Dim>& unit, const Place<Dim>& own, std::size_t n) const {
      FloatBatch squared;
      for (int m = 0; m < batch; m += lane_count) {
        VecLanes<Dim> d;
        for (int a = 0; a < Dim; ++a) {
          IntegerLanes places;
          std::memcpy(&places, at[a] + n + m, sizeof(places));
          d.at[a] = difference(unit[a], own.at[a], places);
        }
        const Lanes square = d.dot(d);
        std::memcpy(reinterpret_cast<float*>(&squared) + m, &square, sizeof(square));
      }
      return squared;
    }
  };
  View view() const {
    View view{.index = index_.data(), .at = {}, .signed_volume = signed_volume_.data()};
    for (int d = 0; d < Dim; ++d) view.at[d] = at_[d].data();
    return view;
  }

 private:
  std::vector<std::int32_t> index_;
  std::array<std::vector<std::uint32_t>, Dim> at_;
  std::vector<float> signed_volume_;
};

/// A grid of the fluid alone. Most dummies are dry: in it they find empty cells only.
template <int Dim>
struct FluidGrid {
  FluidGrid(const Particles<Dim>& particles, double reach) {
    for (const std::size_t j : indices_where(particles.size(), [&](std::size_t n) { return particles.is_fluid(n); })) {
      order.push_back(static_cast<std::int32_t>(j));
    }
    std::vector<Vec<Dim>> position(order.size());
    for_each(order.size(), [&](std::size_t n) { position[n] = particles.position[order[n]]; });
    grid = CellGrid<Dim>(position, reach);
    const std::vector<std::int32_t> fluid = order;
    for_each(order.size(), [&](std::size_t n) { order[n] = fluid[grid.order()[n]]; });
  }

  CellGrid<Dim> grid;
  std::vector<std::int32_t> order;  ///< of the grid, as indices of particles
};

/// What a search goes through.
template <int Dim>
struct Searched {
  const CellGrid<Dim>& grid;
  OrderedPlaces<Dim> places;
};

/// The neighbours of one particle at a time, and the squares of their distances. Its arrays, and those to which it
/// writes, are written up to a batch beyond their ends.
template <int Dim>
class NeighbourRow {
 public:
  explicit NeighbourRow(std::size_t all)
      : all_(static_cast<std::int32_t>(all)), j_(all + batch), squared_(all + batch) {}

  /// Finds the particles in the support of particle i, itself too if it is among those searched, in the order of the
  /// grid. Returns how many.
  std::size_t find(const Searched<Dim>& searched, const Pairs<Dim>& pairs, std::size_t i) {
    const double radius = kernel_radius(pairs.kernel);
    const FloatBatch radius_squared = FloatBatch{} + static_cast<float>((1.0 - rounded_at_rim) * radius * radius);
    typename CellGrid<Dim>::Ranges ranges;
    const int range_count = searched.grid.find_ranges_near(pairs.position[i], ranges);
    const auto places = searched.places.view();
    const Place<Dim> own = pairs.place[i];
    const std::array<float, Dim> unit = pairs.unit;
    std::int32_t* j_end = j_.data();
    float* squared_end = squared_.data();
    int walls = 0;
    for (int r = 0; r < range_count; ++r) {
      const std::int32_t end = ranges[r].end;
      for (std::int32_t n = ranges[r].begin; n < end; n += batch) {
        const FloatBatch squared = places.squared_distances(unit, own, n);
        const unsigned near = bits_of(squared < radius_squared) & first_bits(end - n);
        const unsigned wall = bits_of(batch_at<FloatBatch>(places.signed_volume + n) < 0.0F);
        j_end = write_chosen(places.index + n, near, j_end);
        squared_end = write_chosen(reinterpret_cast<const float*>(&squared), near, squared_end);
        walls += std::popcount(near & wall);
      }
    }
    count_ = j_end - j_.data();
    walls_ = walls;
    if (searched.grid.reach() > places_differ_within * radius) drop_far(pairs, i);
    return count_;
  }

  /// Writes what was found without `self`, neighbours to `j` and the squares of their distances to `squared`: the
  /// indices below `self`, those above it and those from `owned` on, ghosts, each kind in the order in which they were
  /// found. Returns how many.
  std::size_t write_in_order(std::int32_t self, std::int32_t owned, std::int32_t* j, float* squared) const {
    std::int32_t* end = j;
    const auto write_those_between = [&](std::int32_t begin_index, std::int32_t end_index) {
      if (begin_index == end_index) return;
      for (std::size_t n = 0; n < count_; n += batch) {
        const unsigned chosen = bits_between(j_.data() + n, begin_index, end_index) & first_bits(count_ - n);
        write_chosen(squared_.data() + n, chosen, squared + (end - j));
        end = write_chosen(j_.data() + n, chosen, end);
      }
    };
    write_those_between(0, self);
    write_those_between(self + 1, owned);
    write_those_between(owned, all_);
    return end - j;
  }

  /// How many wall particles were found, itself counted too.
  int walls() const { return walls_; }

 private:
  /// Drops those that are as far away as places take to repeat.
  void drop_far(const Pairs<Dim>& pairs, std::size_t i) {
    const double far = 4.0 * kernel_radius(pairs.kernel) * kernel_radius(pairs.kernel);
    std::size_t kept = 0;
    for (std::size_t n = 0; n < count_; ++n) {
      const std::int32_t j = j_[n];
      if ((pairs.position[i] - pairs.position[j]).squaredNorm() > far) {
        walls_ -= pairs.place[j].signed_volume < 0.0F ? 1 : 0;
        continue;
      }
      j_[kept] = j;
      squared_[kept++] = squared_[n];
    }
    count_ = kept;
  }

  std::int32_t all_;  ///< how many particles there are
  std::vector<std::int32_t> j_;
  std::vector<float> squared_;  ///< m^2
  std::size_t count_ = 0;
  int walls_ = 0;
};

/// Of row i finds F from the squares of distances in its place. Returns whether some are less than the least one's.
template <int Dim>
bool find_steepness(Pairs<Dim>& pairs, std::size_t i) {
  const Lanes least_squared = in_all_lanes(pairs.least_distance * pairs.least_distance);
  const Lanes too_near = in_all_lanes(1.0 - parted_tolerance) * least_squared;
  return with_kernel(
      pairs.kernel_in_lanes, [&](const auto& kernel) __attribute__((always_inline)) {
        Lanes nearer{};
        for_each_lanes(
            pairs.begin(i), pairs.end(i), [&](auto range) __attribute__((always_inline)) {
              const Lanes squared = range.load(pairs.F.data());
              range.store(kernel.steepness(sqrt_of(max_of(squared, least_squared))), pairs.F.data() + range.begin);
              nearer = max_of(nearer, range.only(too_near - squared));
            });
        return any_of(nearer > Lanes{});
      });
}

/// Of each two neighbours that are too near puts the one with the larger id where Pairs::d sees it, so that loops in
/// lanes need not ask. A particle that sees both as ghosts sees them at one place.
template <int Dim>
void part_coinciding(Pairs<Dim>& pairs) {
  const auto least = static_cast<std::uint32_t>(std::ceil(pairs.least_distance / pairs.unit[0]));
  // More than find_steepness finds too near, whatever was rounded there: what it finds again has moved.
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
  const Searched<Dim> all{grid, {grid.order(), pairs.place}};
  const Searched<Dim> only_fluid{fluid.grid, {fluid.order, pairs.place}};
  const auto sees_all = [&](std::size_t i) { return wall_rows == WallRows::all || particles.is_fluid(i); };
  NeighbourRow<Dim> row(particles.size());
  const auto find_row = [&](std::size_t i) { return row.find(sees_all(i) ? all : only_fluid, pairs, i); };
  pairs.row_begin.resize(particles.owned + 1);
  pairs.row_begin[0] = 0;
  pairs.sees_wall.resize(particles.owned);
  // The first pairs are counted before they are kept; later ones are about as many as the last.
  const std::size_t before = pairs.j.size();
  const std::size_t expected = before > 0 ? before : count_each(particles.owned, find_row);
  make_room(pairs.j, expected);
  make_room(pairs.F, expected);
  std::size_t crowded = 0;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: rows are put one behind the other
    const std::size_t begin = pairs.row_begin[i];
    const std::size_t most = begin + find_row(i) + batch;
    if (most > pairs.j.size()) {
      pairs.j.resize(std::max(most, pairs.j.capacity()));
      pairs.F.resize(pairs.j.size());
    }
    const std::size_t count =
        row.write_in_order(static_cast<std::int32_t>(i), static_cast<std::int32_t>(particles.owned),
                           pairs.j.data() + begin, pairs.F.data() + begin);
    pairs.row_begin[i + 1] = begin + count;
    const int finds_itself_as_wall = sees_all(i) && !particles.is_fluid(i) ? 1 : 0;
    pairs.sees_wall[i] = row.walls() > finds_itself_as_wall ? 1 : 0;
    crowded += find_steepness(pairs, i) ? 1 : 0;
  }
  pairs.j.resize(pairs.row_begin.back());
  pairs.F.resize(pairs.row_begin.back());
  return crowded;
}

}  // namespace

template <int Dim>
void find_pairs(const Kernel<Dim>& kernel, const CellGrid<Dim>& grid, const Particles<Dim>& particles,
                WallRows wall_rows, double least_distance, Pairs<Dim>& pairs) {
  pairs.position = particles.position;
  pairs.id = particles.id;
  pairs.least_distance = least_distance;
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

template void find_pairs<2>(const Kernel<2>&, const CellGrid<2>&, const Particles<2>&, WallRows, double, Pairs<2>&);
template void find_pairs<3>(const Kernel<3>&, const CellGrid<3>&, const Particles<3>&, WallRows, double, Pairs<3>&);
template void find_places<2>(const Particles<2>&, const PeriodicDomain<2>&, double, Pairs<2>&);
template void find_places<3>(const Particles<3>&, const PeriodicDomain<3>&, double, Pairs<3>&);

}  // namespace tailwater
