#include "walls/wet_walls.h"

#include <algorithm>
#include <array>

#include "base/for_each.h"

namespace tailwater {
namespace {

/// A wall particle is wet when its kernel sum over the fluid exceeds this fraction of W(0): some fluid particle is
/// inside its support, not merely on the edge.
constexpr double min_wet_weight = 1e-6;

/// Projection of `d` onto the cone that the columns of `others` and `own` span: the nearest point of the cone. Exact
/// where the columns are perpendicular to each other.
template <int Dim>
Vec<Dim> part_in_cone(const Vec<Dim>& d, const Mat<Dim>& others, const Vec<Dim>& own) {
  constexpr int sweeps = 8;
  const auto normal = [&](int k) { return k < Dim ? others.col(k) : own; };
  std::array<double, Dim + 1> share{};
  Vec<Dim> rest = d;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int k = 0; k <= Dim; ++k) {
      const double more = std::max(-share[k], normal(k).dot(rest));
      share[k] += more;
      rest -= more * normal(k);
    }
  }
  return d - rest;
}

/// Sum of W (r_f - r_i) over the fluid in reach of wall particle i.
template <int Dim>
Vec<Dim> towards_water(const Pairs<Dim>& pairs, std::size_t i) {
  VecLanes<Dim> sum{};
  for_each_pair(pairs, i, [&](const auto& batch) {
    const PlaceLanes<Dim> place = batch.place();
    sum += batch.kernel_of_fluid(place) * place.d;
  });
  return -sum_of(sum);
}

}  // namespace

template <int Dim>
void find_wet_walls(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double W_0,
                    std::span<double> fluid_weight, std::span<std::uint8_t> is_wet) {
  for_each(pairs.owned(), [&](std::size_t i) {
    fluid_weight[i] = 0.0;
    is_wet[i] = 0;
    if (particles.is_fluid(i)) return;
    LaneSum sum;
    for_each_pair(pairs, i, [&](const auto& batch) { sum += batch.kernel_of_fluid(); });
    fluid_weight[i] = sum.total();
    is_wet[i] = fluid_weight[i] > min_wet_weight * W_0;
  });
}

template <int Dim>
Mirror<Dim> mirror_at(const WallScene<Dim>& scene, std::size_t i) {
  const WallParticles<Dim>& walls = scene.walls.particles;
  const std::int32_t row = scene.particles.wall_row[i];
  const Mat<Dim>& beyond = walls.beyond_edges[row];
  const Mirror<Dim> own{walls.normal[row], walls.blocked[row]};
  if (beyond.isZero(0.0)) return own;
  const Vec<Dim> seen = part_in_cone<Dim>(towards_water(scene.pairs, i), beyond, own.normal);
  if (seen.isZero(0.0)) return own;
  const Vec<Dim> n = seen.normalized();
  return {n, n * n.transpose()};
}

TAILWATER_IN_2D_AND_3D(find_wet_walls);
TAILWATER_IN_2D_AND_3D(mirror_at);

}  // namespace tailwater
