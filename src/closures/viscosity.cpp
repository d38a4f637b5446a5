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

/// Bits of ViscousEnd::shear: where walls with friction shear the water. A boundary layer is beside a wall too.
constexpr std::uint32_t beside_wall = 1U;
constexpr std::uint32_t in_layer = 2U;

/// The fields of a particle that the viscous forces of its pairs depend on.
template <int Dim>
struct alignas(Dim == 2 ? 32 : 64) ViscousEnd {
  std::array<float, Dim> velocity;        ///< m/s
  float viscosity;                        ///< m^2/s
  std::uint32_t shear;                    ///< beside_wall, in_layer, both or 0
  std::array<float, Dim * Dim> gradient;  ///< 1/s; of the velocity, column by column
};

template <int Dim>
std::vector<ViscousEnd<Dim>> viscous_ends(const Pairs<Dim>& pairs, const Particles<Dim>& particles,
                                          std::span<const double> viscosity, std::span<const Vec<Dim>> velocity,
                                          std::span<const Mat<Dim>> gradient) {
  const double radius = kernel_radius(pairs.kernel);
  std::vector<ViscousEnd<Dim>> ends(particles.size());
  for_each(ends.size(), [&](std::size_t i) {
    ViscousEnd<Dim>& end = ends[i];
    for (int a = 0; a < Dim; ++a) end.velocity[a] = static_cast<float>(velocity[i][a]);
    for (int n = 0; n < Dim * Dim; ++n) end.gradient[n] = static_cast<float>(gradient[i].data()[n]);
    end.viscosity = static_cast<float>(viscosity[i]);
    const bool is_in_layer = particles.layer_viscosity[i] > 0.0;
    const double reach = radius * pairs.relative_spacing_of(i);
    const bool is_beside_wall = particles.is_fluid(i) && particles.wall_distance[i] < reach;
    end.shear = (is_in_layer ? in_layer | beside_wall : 0U) | (is_beside_wall ? beside_wall : 0U);
  });
  return ends;
}

/// `lanes` where both densities are the same and not 0; 0 elsewhere.
Lanes of_same_liquid(Lanes lanes, float own, Lanes other) {
  return own == 0.0F ? Lanes{} : (other == own ? lanes : Lanes{});
}

template <int Dim>
bool is_any_sheared(const std::vector<ViscousEnd<Dim>>& ends) {
  return std::ranges::any_of(ends, [](const ViscousEnd<Dim>& end) { return end.shear != 0U; });
}

/// Several pairs of particle i as the viscous forces see them. The forces are computed per product of both volumes, so
/// that the forces on the two particles of a pair are opposite to the last bit.
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
  Lanes noise_spacing;   ///< mean spacing of both over that of the case, to which the noise viscosity is proportional
  Lanes morris_volumes;  ///< m^(2 Dim); the volumes, less for pairs that nearly coincide (laplacian_morris.h)
  std::uint32_t own_shear;  ///< bits of i
  IntegerLanes shear;       ///< bits of j

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
    shear = reinterpret_cast<IntegerLanes>(other[number(offsetof(End, shear))]);
    for (int n = 0; n < Dim * Dim; ++n) {
      const Lanes of_other = other[number(offsetof(End, gradient)) + n];
      gradients.column[n / Dim].at[n % Dim] = own.gradient[n] + of_other;
      change.column[n / Dim].at[n % Dim] = of_other - own.gradient[n];
    }
    squared = place.d.dot(place.d);
    volumes = in_all_lanes(particles.volume[batch.i]) * place.volume_of_fluid();
    morris_volumes = volumes * share_of_morris_weight(batch.squared_over_spacing(squared), spacing);
    noise_spacing = batch.relative_spacing();
  }

  /// Adds the force of a viscosity `noise_viscosity` [m^2/s] that damps noise alone: the part of the velocity
  /// difference that the mean velocity gradient and the shear at walls do not explain. `any_shear`: whether walls shear
  /// any water.
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
    const Lanes weight = static_cast<float>(2.0 * noise_viscosity) * noise_spacing * morris_volumes * F;
    for (int a = 0; a < Dim; ++a) terms.at[a] += weight * (noise.at[a] - given * difference.at[a]);
  }

 private:
  static constexpr float least = std::numeric_limits<float>::min();  ///< prevents 0/0

  /// The projection of `a` on `b` as a multiple of `b`; 0 where `b` is 0.
  static Lanes projection(const VecLanes<Dim>& a, const VecLanes<Dim>& b) {
    return a.dot(b) / max_of(b.dot(b), in_all_lanes(least));
  }

  /// Removes from the noise the part that shear at walls explains: between particles that are both in a boundary layer,
  /// the part along the explained difference; between others of which one is beside a wall with friction, the part
  /// within the range of the differences that the gradient of either particle alone explains.
  void allow_for_shear(const VecLanes<Dim>& explained, VecLanes<Dim>& noise) const {
    const LaneTruths both_in_layer = (own_shear & shear & in_layer) != 0U;
    const LaneTruths one_beside_wall = ((own_shear | shear) & beside_wall) != 0U;
    VecLanes<Dim> half_range = change.times(place.d);
    for (int a = 0; a < Dim; ++a) half_range.at[a] *= 0.5F;
    const Lanes one = in_all_lanes(1.0F);
    const Lanes within_range = max_of(-one, min_of(one, projection(noise, half_range)));
    const Lanes of_layer = both_in_layer ? projection(noise, explained) : Lanes{};
    const Lanes of_wall = one_beside_wall & ~both_in_layer ? within_range : Lanes{};
    for (int a = 0; a < Dim; ++a) noise.at[a] -= of_layer * explained.at[a] + of_wall * half_range.at[a];
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
                             std::span<const Mat<Dim>> gradient, std::span<Vec<Dim>> acceleration,
                             std::span<const float> density, std::span<const float> noise_factor) {
  const std::vector<ViscousEnd<Dim>> ends = viscous_ends(pairs, particles, viscosity, velocity, gradient);
  const bool any_shear = is_any_sheared(ends);
  for_each(pairs.owned(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    VecSum<Dim> sum;
    for_each_pair(pairs, i, [&](const auto& batch) {
      const PairVectorLanes<Dim> vectors = pair_vectors(batch);
      ViscousPairs<Dim> pair(batch, vectors.place, vectors.F, particles, ends, spacing);
      // The corrections may turn the sign, but only for pairs that nearly coincide.
      const Lanes F = max_of(Lanes{}, -vectors.a.dot(pair.place.d)) / pair.squared;
      const Lanes laplacian = 2.0F * pair.morris_volumes * F;
      VecLanes<Dim> terms;
      for (int d = 0; d < Dim; ++d) {
        const Lanes transposed = pair.volumes * pair.gradients.column[d].dot(vectors.a);
        terms.at[d] = pair.viscosity * fused(laplacian, pair.difference.at[d], transposed);
      }
      if (noise_viscosity > 0.0) {
        if (!density.empty()) pair.morris_volumes = of_same_liquid(pair.morris_volumes, density[i], batch.of(density));
        if (!noise_factor.empty()) pair.noise_spacing *= 0.5F * (noise_factor[i] + batch.of(noise_factor));
        pair.add_noise_force(noise_viscosity, any_shear, terms);
      }
      sum += terms;
    });
    acceleration[i] += sum.total() / particles.volume[i];
  });
}

TAILWATER_IN_2D_AND_3D(effective_viscosity);
TAILWATER_IN_2D_AND_3D(add_newtonian_viscosity);

}  // namespace tailwater
