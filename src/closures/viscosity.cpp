#include "closures/viscosity.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/for_each.h"
#include "neighbours/pair_lanes.h"
#include "operators/laplacian_morris.h"

namespace tailwater {
namespace {

/// Where walls with friction shear the water.
enum Shear : std::uint8_t { none, beside_wall, in_layer };

/// What a particle brings to the viscous forces of its pairs.
template <int Dim>
struct alignas(Dim == 2 ? 32 : 64) ViscousEnd {
  std::array<float, Dim> velocity;        ///< m/s
  float viscosity;                        ///< m^2/s
  float shear;                            ///< a Shear
  std::array<float, Dim * Dim> gradient;  ///< 1/s; of the velocity, column by column
};

template <int Dim>
std::vector<ViscousEnd<Dim>> viscous_ends(const Particles<Dim>& particles, std::span<const double> viscosity,
                                          std::span<const Vec<Dim>> velocity, std::span<const Mat<Dim>> gradient,
                                          double reach) {
  std::vector<ViscousEnd<Dim>> ends(particles.size());
  for_each(ends.size(), [&](std::size_t i) {
    ViscousEnd<Dim>& end = ends[i];
    for (int a = 0; a < Dim; ++a) end.velocity[a] = static_cast<float>(velocity[i][a]);
    for (int n = 0; n < Dim * Dim; ++n) end.gradient[n] = static_cast<float>(gradient[i].data()[n]);
    end.viscosity = static_cast<float>(viscosity[i]);
    const bool is_beside_wall = particles.is_fluid(i) && particles.wall_distance[i] < reach;
    end.shear = particles.layer_viscosity[i] > 0.0 ? in_layer : is_beside_wall ? beside_wall : none;
  });
  return ends;
}

template <int Dim>
bool is_any_sheared(const std::vector<ViscousEnd<Dim>>& ends) {
  return std::ranges::any_of(ends, [](const ViscousEnd<Dim>& end) { return end.shear > 0.0F; });
}

/// What viscous forces need of several pairs of particle i. They are found over both volumes, which is opposite for the
/// two particles to the last bit.
template <int Dim>
struct ViscousPairs {
  const PlaceLanes<Dim>& place;
  Lanes F;                   ///< of the kernel
  VecLanes<Dim> difference;  ///< m/s; u_j - u_i
  Lanes viscosity;           ///< m^2/s; mean of both
  MatLanes<Dim> gradients;   ///< 1/s; sum of both velocity gradients
  MatLanes<Dim> change;      ///< 1/s; velocity gradient of j less that of i
  Lanes squared;             ///< m^2; d.d
  Lanes volumes;             ///< m^(2 Dim); w_i w_j, 0 of walls
  Lanes share_of_volumes;    ///< m^(2 Dim); in the weights of the Morris Laplacian
  float own_shear;           ///< of i
  Lanes shear;               ///< of j

  template <class Several>
  ViscousPairs(const Several& batch, const PlaceLanes<Dim>& place_of_pairs, Lanes F_of_pairs,
               const Particles<Dim>& particles, std::span<const ViscousEnd<Dim>> ends, double spacing)
      : place(place_of_pairs), F(F_of_pairs) {
    using End = ViscousEnd<Dim>;
    const auto number = [](std::size_t offset) { return offset / sizeof(float); };
    const auto other = batch.j.numbers(ends.data());
    const End& own = ends[batch.i];
    for (int a = 0; a < Dim; ++a) difference.at[a] = other[number(offsetof(End, velocity)) + a] - own.velocity[a];
    viscosity = 0.5F * (own.viscosity + other[number(offsetof(End, viscosity))]);
    own_shear = own.shear;
    shear = other[number(offsetof(End, shear))];
    for (int n = 0; n < Dim * Dim; ++n) {
      const Lanes of_other = other[number(offsetof(End, gradient)) + n];
      gradients.column[n / Dim].at[n % Dim] = own.gradient[n] + of_other;
      change.column[n / Dim].at[n % Dim] = of_other - own.gradient[n];
    }
    squared = place.d.dot(place.d);
    volumes = in_all_lanes(particles.volume[batch.i]) * place.volume_of_fluid();
    share_of_volumes = volumes * share_of_morris_weight(squared, spacing);
  }

  /// Adds `noise_viscosity` times the force by the noise in the difference of velocity. `any_shear`: whether walls
  /// shear any of the water.
  void add_noise_force(double noise_viscosity, bool any_shear, VecLanes<Dim>& terms) const {
    VecLanes<Dim> explained = gradients.times(place.d);
    VecLanes<Dim> noise;
    for (int a = 0; a < Dim; ++a) {
      explained.at[a] *= -0.5F;
      noise.at[a] = difference.at[a] - explained.at[a];
    }
    if (any_shear) allow_for_shear(explained, noise);
    const Lanes work = min_of(Lanes{}, noise.dot(difference));
    const Lanes given = work / max_of(difference.dot(difference), in_all_lanes(least));
    const Lanes weight = static_cast<float>(2.0 * noise_viscosity) * share_of_volumes * F;
    for (int a = 0; a < Dim; ++a) terms.at[a] += weight * (noise.at[a] - given * difference.at[a]);
  }

 private:
  static constexpr float least = std::numeric_limits<float>::min();  ///< prevents 0/0

  /// Leaves of the noise what shear by walls does not explain. In a boundary layer, to which both particles belong,
  /// that is what is across the explained difference; where one of them is beside a wall with friction, what lies
  /// beyond the differences that either gradient alone explains.
  void allow_for_shear(const VecLanes<Dim>& explained, VecLanes<Dim>& noise) const {
    VecLanes<Dim> half_range = change.times(place.d);
    for (int a = 0; a < Dim; ++a) half_range.at[a] *= 0.5F;
    const Lanes one = in_all_lanes(1.0F);
    const Lanes in_range = noise.dot(half_range) / max_of(half_range.dot(half_range), in_all_lanes(least));
    const Lanes in_shear = noise.dot(explained) / max_of(explained.dot(explained), in_all_lanes(least));
    const Lanes layers = min_of(in_all_lanes(own_shear), shear);
    const Lanes walls = max_of(in_all_lanes(own_shear), shear);
    const Lanes of_layer = layers > in_all_lanes(1.5F) ? in_shear : Lanes{};
    const Lanes of_wall = walls > in_all_lanes(0.5F) ? max_of(-one, min_of(one, in_range)) : Lanes{};
    const Lanes of_range = layers > in_all_lanes(1.5F) ? Lanes{} : of_wall;
    for (int a = 0; a < Dim; ++a) noise.at[a] -= of_layer * explained.at[a] + of_range * half_range.at[a];
  }
};

}  // namespace

template <int Dim>
void effective_viscosity(const ViscosityLaw& law, std::span<const Vec<Dim>> velocity, std::span<double> viscosity) {
  for_each(velocity.size(), [&](std::size_t i) { viscosity[i] = law.at_speed(velocity[i].norm()); });
}

template <int Dim>
void add_newtonian_viscosity(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double spacing,
                             const PairVectorField<Dim>& pair_vectors, std::span<const double> viscosity,
                             double noise_viscosity, std::span<const Vec<Dim>> velocity,
                             std::span<const Mat<Dim>> gradient, std::span<Vec<Dim>> acceleration) {
  const std::vector<ViscousEnd<Dim>> ends =
      viscous_ends(particles, viscosity, velocity, gradient, kernel_radius(pairs.kernel));
  const bool any_shear = is_any_sheared(ends);
  for_each(pairs.owned(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    VecSum<Dim> sum;
    for_each_pair(pairs, i, [&](const auto& batch) {
      const PairVectorLanes<Dim> vectors = pair_vectors(batch);
      const ViscousPairs<Dim> pair(batch, vectors.place, vectors.F, particles, ends, spacing);
      // Only of pairs that nearly coincide may the corrections turn the sign.
      const Lanes F = max_of(Lanes{}, -vectors.a.dot(pair.place.d)) / pair.squared;
      const Lanes laplacian = 2.0F * pair.share_of_volumes * F;
      VecLanes<Dim> terms;
      for (int d = 0; d < Dim; ++d) {
        const Lanes transposed = pair.volumes * pair.gradients.column[d].dot(vectors.a);
        terms.at[d] = pair.viscosity * fused(laplacian, pair.difference.at[d], transposed);
      }
      if (noise_viscosity > 0.0) pair.add_noise_force(noise_viscosity, any_shear, terms);
      sum += terms;
    });
    acceleration[i] += sum.total() / particles.volume[i];
  });
}

TAILWATER_IN_2D_AND_3D(effective_viscosity);
TAILWATER_IN_2D_AND_3D(add_newtonian_viscosity);

}  // namespace tailwater
