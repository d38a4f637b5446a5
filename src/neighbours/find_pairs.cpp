#include "neighbours/find_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
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

/// Bit n is set if index n of a batch is at least `begin` and less than `end`.
inline unsigned bits_between(const std::int32_t* indices, std::int32_t begin, std::int32_t end) {
  const auto all = batch_at<IndexBatch>(indices);
  return bits_of((all >= begin) & (all < end));
}

/// The particles in the order of a grid, their positions coordinate by coordinate, so that those of a range of cells
/// are read in lanes. The last range may be read beyond its end.
template <int Dim>
class OrderedParticles {
 public:
  OrderedParticles(std::span<const std::int32_t> order, std::span<const Vec<Dim>> position)
      : index_(order.begin(), order.end()) {
    index_.resize(order.size() + batch);
    for (int d = 0; d < Dim; ++d) {
      at_[d].resize(index_.size());
      for_each(order.size(), [&](std::size_t n) { at_[d][n] = position[index_[n]][d]; });
    }
  }

  /// The index of the particle at place n of the order.
  const std::int32_t* index(std::size_t n) const { return index_.data() + n; }

  /// Bit m is set if the particle at place n + m of the order is nearer to `point` than the square root of `squared`.
  unsigned nearer(const Vec<Dim>& point, DoubleLanes squared, std::size_t n) const {
    unsigned bits = 0;
    for (int m = 0; m < batch; m += double_lane_count) {
      DoubleLanes sum{};
      for (int d = 0; d < Dim; ++d) {
        DoubleLanes x;
        std::memcpy(&x, at_[d].data() + n + m, sizeof(x));
        x = point[d] - x;
        sum += x * x;
      }
      bits |= bits_of(sum < squared) << m;
    }
    return bits;
  }

 private:
  std::vector<std::int32_t> index_;
  std::array<std::vector<double>, Dim> at_;  ///< m
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

/// The neighbours of one particle at a time. Its arrays are written up to a batch beyond their ends.
class NeighbourRow {
 public:
  explicit NeighbourRow(std::size_t all) : all_(static_cast<std::int32_t>(all)), found_(all + batch) {}

  /// Finds the particles nearer to `point` than `radius`, in the order of the grid. Returns how many.
  template <int Dim>
  std::size_t find(const CellGrid<Dim>& grid, const OrderedParticles<Dim>& ordered, const Vec<Dim>& point,
                   double radius) {
    const DoubleLanes radius_squared = in_all_double_lanes(radius * radius);
    std::int32_t* found_end = found_.data();
    grid.for_each_range_near(point, [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t n = begin; n < end; n += batch) {
        const unsigned near = ordered.nearer(point, radius_squared, n) & first_bits(end - n);
        found_end = write_chosen(ordered.index(n), near, found_end);
      }
    });
    count_ = found_end - found_.data();
    return count_;
  }

  /// Writes what was found without `self` to `row`: the indices below it, those above it and those from `owned` on,
  /// ghosts, each kind in the order in which they were found. Returns the end of the row, which has room for a batch
  /// behind it.
  std::int32_t* write_in_order(std::int32_t self, std::int32_t owned, std::int32_t* row) {
    row = write_those_between(0, self, row);
    row = write_those_between(self + 1, owned, row);
    return write_those_between(owned, all_, row);
  }

 private:
  std::int32_t* write_those_between(std::int32_t begin, std::int32_t end, std::int32_t* row) const {
    if (begin == end) return row;
    for (std::size_t n = 0; n < count_; n += batch) {
      const std::int32_t* const indices = found_.data() + n;
      row = write_chosen(indices, bits_between(indices, begin, end) & first_bits(count_ - n), row);
    }
    return row;
  }

  std::int32_t all_;  ///< how many particles there are
  std::vector<std::int32_t> found_;
  std::size_t count_ = 0;
};

/// Finds F and sees_wall. Returns in how many rows neighbours are nearer than the least distance.
template <int Dim>
std::size_t find_slopes(Pairs<Dim>& pairs) {
  return std::visit(
      [&](const auto kernel) {
        const Lanes least_squared = in_all_lanes(pairs.least_distance * pairs.least_distance);
        const Lanes too_near = in_all_lanes(1.0 - parted_tolerance) * least_squared;
        return count_each(pairs.owned(), [&](std::size_t i) {
          Lanes least_square = in_all_lanes(std::numeric_limits<float>::max());
          Lanes least_volume{};
          for_each_lanes(
              pairs.begin(i), pairs.end(i), [&](auto range) __attribute__((always_inline)) {
                const PlaceLanes<Dim> place = neighbour_places(pairs, range, range.neighbours(pairs.j.data()), i);
                const Lanes square = place.d.dot(place.d);
                range.store(kernel.steepness(sqrt_of(max_of(square, least_squared))), pairs.F.data() + range.begin);
                least_square = min_of(least_square, square);
                least_volume = min_of(least_volume, place.signed_volume);
              });
          pairs.sees_wall[i] = any_of(least_volume < Lanes{}) ? 1 : 0;
          return any_of(least_square < too_near);
        });
      },
      pairs.kernel_in_lanes);
}

/// Of each two neighbours that are too near puts the one with the larger id where Pairs::d sees it, so that loops in
/// lanes need not ask. A particle that sees both as ghosts sees them at one place.
template <int Dim>
void part_coinciding(Pairs<Dim>& pairs) {
  const auto least = static_cast<std::uint32_t>(std::ceil(pairs.least_distance / pairs.unit[0]));
  // More than find_slopes finds too near, whatever was rounded there: what it finds again has moved.
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

}  // namespace

template <int Dim>
void find_pairs(const Kernel<Dim>& kernel, const CellGrid<Dim>& grid, const Particles<Dim>& particles,
                WallRows wall_rows, double least_distance, Pairs<Dim>& pairs) {
  const double radius = kernel_radius(kernel);
  const Vec<Dim>* const position = particles.position.data();
  const OrderedParticles<Dim> ordered(grid.order(), particles.position);
  const FluidGrid<Dim> fluid(particles, radius);
  const OrderedParticles<Dim> ordered_fluid(fluid.order, particles.position);
  const auto owned = static_cast<std::int32_t>(particles.owned);
  NeighbourRow row(particles.size());

  pairs.position = particles.position;
  pairs.id = particles.id;
  pairs.least_distance = least_distance;
  pairs.kernel = kernel;
  pairs.kernel_in_lanes = in_single_precision(kernel);
  pairs.row_begin.resize(particles.owned + 1);
  pairs.row_begin[0] = 0;
  // Finds the neighbours of particle i, and itself if it sees its kind. Returns how many.
  const auto find_row = [&](std::size_t i) {
    const bool sees_all = wall_rows == WallRows::all || particles.is_fluid(i);
    return sees_all ? row.find(grid, ordered, position[i], radius)
                    : row.find(fluid.grid, ordered_fluid, position[i], radius);
  };
  // The first pairs are counted before they are kept; later ones are about as many as the last.
  const std::size_t before = pairs.j.size();
  const std::size_t expected = before > 0 ? before : count_each(particles.owned, find_row);
  make_room(pairs.j, expected);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: rows are put one behind the other
    const std::size_t begin = pairs.row_begin[i];
    const std::size_t most = begin + find_row(i) + batch;
    if (most > pairs.j.size()) pairs.j.resize(std::max(most, pairs.j.capacity()));
    const std::int32_t* const end = row.write_in_order(static_cast<std::int32_t>(i), owned, pairs.j.data() + begin);
    pairs.row_begin[i + 1] = end - pairs.j.data();
  }
  pairs.j.resize(pairs.row_begin.back());
  make_room(pairs.F, pairs.j.size());
  pairs.F.resize(pairs.j.size());
  pairs.sees_wall.resize(pairs.owned());
  while (find_slopes(pairs) > 0) part_coinciding(pairs);
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
