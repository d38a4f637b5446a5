#include "neighbours/find_pairs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/for_each.h"
#include "base/lanes.h"
#include "base/room.h"
#include "neighbours/pair_lanes.h"

namespace tailwater {
namespace {

/// For each set of lanes, as bits: which lanes these are, put to the front.
constexpr std::array<std::array<std::int32_t, double_lane_count>, 1 << double_lane_count> lanes_of_bits = [] {
  std::array<std::array<std::int32_t, double_lane_count>, 1 << double_lane_count> lanes{};
  for (unsigned bits = 0; bits < lanes.size(); ++bits) {
    int count = 0;
    for (int lane = 0; lane < double_lane_count; ++lane) {
      if ((bits >> lane & 1U) != 0) lanes[bits][count++] = lane;
    }
  }
  return lanes;
}();

/// The particles in the order of a grid, their positions coordinate by coordinate, so that those of a range of cells
/// are read in lanes. The last range may be read beyond its end.
template <int Dim>
class OrderedParticles {
 public:
  OrderedParticles(std::span<const std::int32_t> order, std::span<const Vec<Dim>> position)
      : index_(order.begin(), order.end()) {
    index_.resize(order.size() + double_lane_count);
    for (int d = 0; d < Dim; ++d) {
      at_[d].resize(index_.size());
      for_each(order.size(), [&](std::size_t n) { at_[d][n] = position[index_[n]][d]; });
    }
  }

  /// Writes the indices of those particles at place n of the order and behind it whose bit is set. Writes to as many
  /// entries as there are lanes.
  void write(std::size_t n, unsigned bits, std::int32_t* row) const {
    // Without a branch: which candidates are near is unpredictable.
    for (int m = 0; m < double_lane_count; ++m) row[m] = index_[n + lanes_of_bits[bits][m]];
  }

  /// Bit m is set if the particle at place n + m of the order is nearer to `point` than the square root of `squared`.
  unsigned nearer(const Vec<Dim>& point, DoubleLanes squared, std::size_t n) const {
    DoubleLanes sum{};
    for (int d = 0; d < Dim; ++d) {
      DoubleLanes x;
      std::memcpy(&x, at_[d].data() + n, sizeof(x));
      x = point[d] - x;
      sum += x * x;
    }
    return bits_of(sum < squared);
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

/// Puts the indices below `self`, those above it and those from `owned` on, ghosts, one behind the other into
/// `ordered`, each kind in the order it has. Returns how many. `self` is left out.
std::size_t put_in_order(std::span<const std::int32_t> found, std::int32_t self, std::int32_t owned,
                         std::vector<std::int32_t>& behind, std::vector<std::int32_t>& ghosts, std::int32_t* ordered) {
  std::size_t before_count = 0;
  std::size_t behind_count = 0;
  std::size_t ghost_count = 0;
  for (const std::int32_t j : found) {  // each index to all three places, and only one of them moves on
    ordered[before_count] = j;
    behind[behind_count] = j;
    ghosts[ghost_count] = j;
    before_count += static_cast<std::size_t>(j < self);
    behind_count += static_cast<std::size_t>(j > self) & static_cast<std::size_t>(j < owned);
    ghost_count += static_cast<std::size_t>(j >= owned);
  }
  std::copy_n(behind.begin(), behind_count, ordered + before_count);
  std::copy_n(ghosts.begin(), ghost_count, ordered + before_count + behind_count);
  return before_count + behind_count + ghost_count;
}

/// Puts the particles nearer to `point` than `radius` into `row`, in the order of the grid. Returns how many. `row`
/// needs room for `double_lane_count` more.
template <int Dim>
std::size_t find_row(const CellGrid<Dim>& grid, const OrderedParticles<Dim>& ordered, const Vec<Dim>& point,
                     double radius, std::int32_t* row) {
  const DoubleLanes radius_squared = in_all_double_lanes(radius * radius);
  std::size_t found = 0;
  grid.for_each_range_near(point, [&](std::int32_t begin, std::int32_t end) {
    for (std::int32_t n = begin; n < end; n += double_lane_count) {
      const unsigned in_range = (1U << std::min(end - n, double_lane_count)) - 1U;
      const unsigned near = ordered.nearer(point, radius_squared, n) & in_range;
      ordered.write(n, near, row + found);
      found += std::popcount(near);
    }
  });
  return found;
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
  std::vector<std::int32_t> near(particles.size() + double_lane_count);
  std::vector<std::int32_t> behind(near.size());
  std::vector<std::int32_t> ghosts(near.size());
  std::vector<std::int32_t> row(near.size());

  pairs.position = particles.position;
  pairs.id = particles.id;
  pairs.least_distance = least_distance;
  pairs.kernel = kernel;
  pairs.row_begin.resize(particles.owned + 1);
  pairs.row_begin[0] = 0;
  // Puts the neighbours of particle i, and itself if it sees its kind, into `near`. Returns how many.
  const auto find_near = [&](std::size_t i) {
    const bool sees_all = wall_rows == WallRows::all || particles.is_fluid(i);
    return sees_all ? find_row(grid, ordered, position[i], radius, near.data())
                    : find_row(fluid.grid, ordered_fluid, position[i], radius, near.data());
  };
  // The first pairs are counted before they are kept; later ones are about as many as the last.
  const std::size_t before = pairs.j.size();
  const std::size_t expected = before > 0 ? before : count_each(particles.owned, find_near);
  empty_with_room(pairs.j, expected);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: rows are put one behind the other
    const std::size_t n =
        put_in_order({near.data(), find_near(i)}, static_cast<std::int32_t>(i), owned, behind, ghosts, row.data());
    pairs.j.insert(pairs.j.end(), row.begin(), row.begin() + static_cast<std::ptrdiff_t>(n));
    pairs.row_begin[i + 1] = pairs.j.size();
  }
  find_slopes(pairs);
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
      place.at[d] = static_cast<std::uint32_t>(std::llround(particles.position[i][d] / unit[d]));
    }
    const auto volume = static_cast<float>(particles.volume[i]);
    place.signed_volume = particles.is_fluid(i) ? volume : -volume;
  });
}

template <int Dim>
void find_slopes(Pairs<Dim>& pairs) {
  empty_with_room(pairs.F, pairs.j.size());
  pairs.F.resize(pairs.j.size());
  std::visit(
      [&](const auto chosen) {
        const Lanes least_squared = in_all_lanes(pairs.least_distance * pairs.least_distance);
        for_each(pairs.owned(), [&](std::size_t i) {
          for_each_lanes(
              pairs.begin(i), pairs.end(i), [&](auto range) __attribute__((always_inline)) {
                const VecLanes<Dim> d = places(pairs, range, range.neighbours(pairs.j.data()), i).d;
                range.store(chosen.steepness(sqrt_of(max_of(d.dot(d), least_squared))), pairs.F.data() + range.begin);
              });
        });
      },
      pairs.kernel);
}

template void find_pairs<2>(const Kernel<2>&, const CellGrid<2>&, const Particles<2>&, WallRows, double, Pairs<2>&);
template void find_pairs<3>(const Kernel<3>&, const CellGrid<3>&, const Particles<3>&, WallRows, double, Pairs<3>&);
template void find_places<2>(const Particles<2>&, const PeriodicDomain<2>&, double, Pairs<2>&);
template void find_places<3>(const Particles<3>&, const PeriodicDomain<3>&, double, Pairs<3>&);
template void find_slopes<2>(Pairs<2>&);
template void find_slopes<3>(Pairs<3>&);

}  // namespace tailwater
