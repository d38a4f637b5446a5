#include "probes/front.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/for_each.h"
#include "probes/places.h"

namespace tailwater {

/// Particles in the support around one at the tip of a tongue two rows thick, on the lattice: 5 and 27. Inside a sheet
/// one row thick there are 4 and 24.
template <int Dim>
constexpr int neighbours_of_tip = Dim == 2 ? 5 : 25;

template <int Dim>
bool is_connected(const ProbeContext<Dim>& context, std::int32_t i, int least) {
  int neighbours = 0;
  for_each_weight(context, context.particles.position[i], [&](std::int32_t j, double) {
    if (j != i && context.particles.is_fluid(j)) ++neighbours;
  });
  return neighbours >= least;
}

namespace {

constexpr double behind_all = -std::numeric_limits<double>::max();

/// The edges of the foremost particle and of the foremost connected particle of this rank.
struct Front {
  double all = behind_all;
  double connected = behind_all;
};

template <int Dim>
Front find_front(const ProbeContext<Dim>& context, const Vec<Dim>& direction) {
  const Particles<Dim>& particles = context.particles;
  std::vector<std::pair<double, std::int32_t>> heap;
  const auto counts = [&](std::size_t k) {
    return context.is_measured(k) && !context.boundary.is_in_duct(particles.position[k]);
  };
  for (const std::size_t i : indices_where(particles.owned, counts)) {
    const Vec<Dim>& x = particles.position[i];
    heap.emplace_back(x.dot(direction) + 0.5 * context.spacing_at(x), static_cast<std::int32_t>(i));
  }
  if (heap.empty()) return {};
  std::make_heap(heap.begin(), heap.end());
  const double front = heap.front().first;
  // Checks the foremost particles one by one until one is connected.
  while (!heap.empty()) {
    if (is_connected(context, heap.front().second, neighbours_of_tip<Dim>)) return {front, heap.front().first};
    std::pop_heap(heap.begin(), heap.end());
    heap.pop_back();
  }
  return {.all = front};
}

/// Collective.
template <int Dim>
Row read_front(const ProbeContext<Dim>& context, const Vec<Dim>& direction) {
  const Front own = find_front(context, direction);
  Row row;
  for (const double coordinate : {own.all, own.connected}) {
    const double foremost = context.ranks.largest(coordinate);
    row.push_back(foremost == behind_all ? 0.0 : foremost);
  }
  return row;
}

}  // namespace

template <int Dim>
Reading<Dim> front_reading(const ProbeTable& probe) {
  Vec<Dim> direction = Vec<Dim>::UnitX();
  if (!probe.direction.empty()) direction = to_vec<Dim>(probe.direction, label(probe), "direction");
  if (direction.norm() == 0.0) {
    throw CaseError("probe-direction-zero",
                    {"{} = {} has no length", label(probe).with_key("direction"), vector_text(direction)},
                    {"give the direction in which the front moves, such as [1, 0]"});
  }
  direction.normalize();
  return {columns_of(probe, Dim), [direction](const ProbeContext<Dim>& context) -> std::vector<Row> {
            return {read_front(context, direction)};
          }};
}

TAILWATER_IN_2D_AND_3D(is_connected);
TAILWATER_IN_2D_AND_3D(front_reading);

}  // namespace tailwater
