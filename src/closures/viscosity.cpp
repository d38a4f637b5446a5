#include "closures/viscosity.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/for_each.h"
#include "closures/wall_law.h"
#include "neighbours/pair_lanes.h"
#include "operators/laplacian_morris.h"

namespace tailwater {
namespace {

/// What a particle brings to the viscous forces of its pairs.
template <int Dim>
struct alignas(Dim == 2 ? 32 : 64) ViscousEnd {
  std::array<float, Dim> velocity;        ///< m/s
  float viscosity;                        ///< m^2/s
  float layer_viscosity;                  ///< m^2/s
  std::array<float, Dim * Dim> gradient;  ///< 1/s; of the velocity, column by column
};

template <int Dim>
std::vector<ViscousEnd<Dim>> viscous_ends(const Particles<Dim>& particles, std::span<const double> viscosity,
                                          std::span<const Vec<Dim>> velocity, std::span<const Mat<Dim>> gradient) {
  std::vector<ViscousEnd<Dim>> ends(particles.size());
  for_each(ends.size(), [&](std::size_t i) {
    ViscousEnd<Dim>& end = ends[i];
    for (int a = 0; a < Dim; ++a) end.velocity[a] = static_cast<float>(velocity[i][a]);
    for (int n = 0; n < Dim * Dim; ++n) end.gradient[n] = static_cast<float>(gradient[i].data()[n]);
    end.viscosity = static_cast<float>(viscosity[i]);
    end.layer_viscosity = static_cast<float>(particles.layer_viscosity[i]);
  });
  return ends;
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
  Lanes squared;             ///< m^2; d.d
  Lanes volumes;             ///< m^(2 Dim); w_i w_j, 0 of walls
  Lanes share_of_volumes;    ///< m^(2 Dim); in the weights of the Morris Laplacian
  bool is_in_layer;          ///< of i; a boundary layer
  Lanes layer_viscosity;     ///< m^2/s; of j

  template <class Several>
  ViscousPairs(const Several& several, const PlaceLanes<Dim>& place_of_pairs, Lanes F_of_pairs,
               const Particles<Dim>& particles, std::span<const ViscousEnd<Dim>> ends, double spacing)
      : place(place_of_pairs), F(F_of_pairs) {
    using End = ViscousEnd<Dim>;
    const auto number = [](std::size_t offset) { return offset / sizeof(float); };
    const auto other = several.j.numbers(ends.data());
    const End& own = ends[several.i];
    for (int a = 0; a < Dim; ++a) difference.at[a] = other[number(offsetof(End, velocity)) + a] - own.velocity[a];
    viscosity = 0.5F * (own.viscosity + other[number(offsetof(End, viscosity))]);
    is_in_layer = own.layer_viscosity > 0.0F;
    layer_viscosity = other[number(offsetof(End, layer_viscosity))];
    for (int n = 0; n < Dim * Dim; ++n) {
      gradients.column[n / Dim].at[n % Dim] = own.gradient[n] + other[number(offsetof(End, gradient)) + n];
    }
    squared = place.d.dot(place.d);
    volumes = in_all_lanes(particles.volume[several.i]) * place.volume_of_fluid();
    share_of_volumes = volumes * share_of_morris_weight(squared, spacing);
  }

  /// Adds `noise_viscosity` times the force by the noise in the difference of velocity. The shear of a boundary layer,
  /// to which both particles belong, is left alone.
  void add_noise_force(double noise_viscosity, VecLanes<Dim>& terms) const {
    constexpr double least = std::numeric_limits<float>::min();  // prevents 0/0
    VecLanes<Dim> explained = gradients.times(place.d);
    VecLanes<Dim> noise;
    for (int a = 0; a < Dim; ++a) {
      explained.at[a] *= -0.5F;
      noise.at[a] = difference.at[a] - explained.at[a];
    }
    if (is_in_layer) {
      const Lanes in_shear = noise.dot(explained) / max_of(explained.dot(explained), in_all_lanes(least));
      const Lanes left_alone = layer_viscosity > Lanes{} ? in_shear : Lanes{};
      for (int a = 0; a < Dim; ++a) noise.at[a] -= left_alone * explained.at[a];
    }
    const Lanes work = min_of(Lanes{}, noise.dot(difference));
    const Lanes given = work / max_of(difference.dot(difference), in_all_lanes(least));
    const Lanes weight = static_cast<float>(2.0 * noise_viscosity) * share_of_volumes * F;
    for (int a = 0; a < Dim; ++a) terms.at[a] += weight * (noise.at[a] - given * difference.at[a]);
  }
};

}  // namespace

double ViscosityLaw::side_wall_rate(double speed) const {
  if (channel_width == 0.0) return 0.0;
  const double laminar = 12.0 * molecular / channel_width / channel_width;
  if (speed == 0.0) return laminar;
  const WallLaw law{molecular, channel_roughness};
  const double u_tau = law.turbulent_friction_velocity_of_mean(speed, 0.5 * channel_width);
  return std::max(laminar, 2.0 * u_tau * u_tau / (channel_width * speed));
}

template <int Dim>
void effective_viscosity(const ViscosityLaw& law, std::span<const Vec<Dim>> velocity, std::span<double> viscosity) {
  for_each(velocity.size(), [&](std::size_t i) { viscosity[i] = law.at_speed(velocity[i].norm()); });
}

template <int Dim>
void add_newtonian_viscosity(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double spacing,
                             const PairVectorField<Dim>& pair_vectors, std::span<const double> viscosity,
                             double noise_viscosity, std::span<const Vec<Dim>> velocity,
                             std::span<const Mat<Dim>> gradient, std::span<Vec<Dim>> acceleration) {
  const std::vector<ViscousEnd<Dim>> ends = viscous_ends(particles, viscosity, velocity, gradient);
  for_each(pairs.owned(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    VecSum<Dim> sum;
    for_each_pair(pairs, i, [&](const auto& several) {
      const PairVectorLanes<Dim> vectors = pair_vectors(several);
      const ViscousPairs<Dim> pair(several, vectors.place, vectors.F, particles, ends, spacing);
      // Only of pairs that nearly coincide may the corrections turn the sign.
      const Lanes F = max_of(Lanes{}, -vectors.a.dot(pair.place.d)) / pair.squared;
      const Lanes laplacian = 2.0F * pair.share_of_volumes * F;
      VecLanes<Dim> terms;
      for (int d = 0; d < Dim; ++d) {
        const Lanes transposed = pair.volumes * pair.gradients.column[d].dot(vectors.a);
        terms.at[d] = pair.viscosity * fused(laplacian, pair.difference.at[d], transposed);
      }
      if (noise_viscosity > 0.0) pair.add_noise_force(noise_viscosity, terms);
      sum += terms;
    });
    acceleration[i] += sum.total() / particles.volume[i];
  });
}

#define TAILWATER_INSTANTIATE(Dim)                                                                                    \
  template void effective_viscosity<Dim>(const ViscosityLaw&, std::span<const Vec<Dim>>, std::span<double>);          \
  template void add_newtonian_viscosity<Dim>(                                                                         \
      const Pairs<Dim>&, const Particles<Dim>&, double, const PairVectorField<Dim>&, std::span<const double>, double, \
      std::span<const Vec<Dim>>, std::span<const Mat<Dim>>, std::span<Vec<Dim>>);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
