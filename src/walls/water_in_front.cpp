#include "walls/water_in_front.h"

#include <algorithm>
#include <vector>

#include "base/for_each.h"
#include "neighbours/pair_lanes.h"

namespace tailwater {
namespace {

// dx; distances from a wall between which the weight of the water in front decreases from 1 to 0.
constexpr double in_full_until = 1.0;
constexpr double ends_at = 1.5;

/// Fraction of the wall particles in reach of particle i, weighted by the kernel, whose wall curves away from the
/// water.
template <int Dim>
double share_of_turning_walls(const WallScene<Dim>& scene, std::size_t i) {
  const Pairs<Dim>& pairs = scene.pairs;
  double turning = 0.0;
  double all = 0.0;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    if (scene.particles.is_fluid(j)) continue;
    const double W = pairs.value(i, k);
    all += W;
    if (scene.walls.curvature[scene.particles.wall_row[j]].trace() > 0.0) turning += W;
  }
  return all > 0.0 ? turning / all : 0.0;
}

/// Mean of `interior` over the fluid in front of particle i, in the direction of the unit vector n. The weight is the
/// kernel times the eighth power of the cosine, so that beside a wall that meets the surface only water of the same
/// depth counts.
template <int Dim>
double mean_in_front(const Pairs<Dim>& pairs, std::size_t i, const Vec<Dim>& n, std::span<const double> interior) {
  Lanes sum{};
  Lanes weights{};
  for_each_pair(pairs, i, [&](const auto& batch) {
    const PlaceLanes<Dim> place = batch.place();
    Lanes ahead{};
    for (int a = 0; a < Dim; ++a) ahead -= static_cast<float>(n[a]) * place.d.at[a];
    ahead = max_of(ahead, Lanes{});
    const Lanes square = ahead * ahead / place.d.dot(place.d);
    const Lanes weight = batch.kernel_of_fluid(place) * square * square * square * square;
    sum += weight * batch.of(interior);
    weights += weight;
  });
  const double weight = sum_of(weights);
  return weight > 0.0 ? sum_of(sum) / weight : 0.0;
}

}  // namespace

template <int Dim>
void see_water_in_front(const WallScene<Dim>& scene, double spacing, std::span<double> interior) {
  const Particles<Dim>& particles = scene.particles;
  std::vector<double> raised(scene.pairs.owned(), 0.0);
  for_each(raised.size(), [&](std::size_t i) {
    if (!particles.is_fluid(i) || interior[i] == 1.0 || scene.pairs.sees_wall[i] == 0) return;
    const double turning = share_of_turning_walls(scene, i);
    if (turning == 0.0) return;
    const double own_spacing = spacing * scene.pairs.relative_spacing_of(i);
    const NearestWall<Dim> wall = scene.walls.boundary.nearest(particles.position[i], ends_at * own_spacing);
    if (wall.face < 0 || wall.signed_distance <= 0.0) return;
    const double distance = wall.signed_distance / own_spacing;
    const double share = turning * std::min(1.0, (ends_at - distance) / (ends_at - in_full_until));
    const Vec<Dim> n = (particles.position[i] - wall.point).normalized();
    raised[i] = share * mean_in_front<Dim>(scene.pairs, i, n, interior);
  });
  for_each(raised.size(), [&](std::size_t i) { interior[i] = std::max(interior[i], raised[i]); });
}

TAILWATER_IN_2D_AND_3D(see_water_in_front);

}  // namespace tailwater
