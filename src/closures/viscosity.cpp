#include "closures/viscosity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/for_each.h"
#include "closures/fluid_pairs.h"
#include "closures/wall_law.h"
#include "operators/laplacian_consistent.h"
#include "operators/laplacian_morris.h"
#include "operators/laplacian_shao_lo.h"

namespace tailwater {
namespace {

/// Acceleration of a pair by the noise in its velocity `difference` u_j - u_i, over the viscosity [1/(m s)].
/// `gradients` is the sum of both particles' velocity gradients.
template <int Dim>
inline Vec<Dim> noise_force(const Pairs<Dim>& pairs, std::size_t k, double volume_j, double spacing,
                            const Vec<Dim>& difference, const Mat<Dim>& gradients, bool are_in_layer) {
  const Vec<Dim> d = pairs.d[k];  // r_i - r_j
  const Vec<Dim> explained = -0.5 * (gradients * d);
  Vec<Dim> noise = difference - explained;
  if (are_in_layer) {
    noise -= noise.dot(explained) / std::max(explained.squaredNorm(), std::numeric_limits<double>::min()) * explained;
  }
  // No branch, because the sign is unpredictable. The divisor's lower bound prevents 0/0.
  const double work = std::min(0.0, noise.dot(difference));
  noise -= work / std::max(difference.squaredNorm(), std::numeric_limits<double>::min()) * difference;
  return morris_laplacian_weight(volume_j, pairs.F[k], d.squaredNorm(), spacing) * noise;
}

/// Whether both particles belong to a boundary layer, whose shear the noise viscosity leaves alone.
template <int Dim>
inline bool are_in_layer(const Particles<Dim>& particles, std::size_t i, std::int32_t j) {
  return particles.layer_viscosity[i] > 0.0 && particles.layer_viscosity[j] > 0.0;
}

}  // namespace

double ViscosityLaw::side_wall_rate(double speed) const {
  if (channel_width == 0.0) return 0.0;
  const double laminar = 12.0 * molecular / (channel_width * channel_width);
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
                             std::span<const Vec<Dim>> pair_vectors, std::span<const double> viscosity,
                             double noise_viscosity, std::span<const Vec<Dim>> velocity,
                             std::span<const Mat<Dim>> gradient, std::span<Vec<Dim>> acceleration) {
  for_each(pairs.owned(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    acceleration[i] += sum_over_fluid(pairs, particles, i, [&](std::int32_t j, std::size_t k) -> Vec<Dim> {
      const Vec<Dim> difference = velocity[j] - velocity[i];
      const Mat<Dim> gradients = gradient[i] + gradient[j];
      const Vec<Dim> a = pair_vectors[k];
      const double squared = pairs.d[k].squaredNorm();
      // Only of pairs that nearly coincide may the corrections turn the sign.
      const double F = std::max(0.0, -a.dot(pairs.d[k])) / squared;
      const double laplacian = morris_laplacian_weight(particles.volume[j], F, squared, spacing);
      const Vec<Dim> force = 0.5 * (viscosity[i] + viscosity[j]) *
                             (laplacian * difference + particles.volume[j] * (gradients.transpose() * a));
      if (noise_viscosity == 0.0) return force;
      return force + noise_viscosity * noise_force<Dim>(pairs, k, particles.volume[j], spacing, difference, gradients,
                                                        are_in_layer(particles, i, j));
    });
  });
}

template <int Dim>
void add_shao_lo_viscosity(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double eta_squared,
                           std::span<const double> density, std::span<const double> viscosity,
                           std::span<const Vec<Dim>> velocity, std::span<Vec<Dim>> acceleration) {
  for_each(pairs.owned(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    acceleration[i] += sum_over_fluid(pairs, particles, i, [&](std::int32_t j, std::size_t k) -> Vec<Dim> {
      const double weight = shao_lo_laplacian_weight(particles.volume[j], density[i], density[j], pairs.r(k),
                                                     pairs.slope(k), eta_squared);
      return weight * 0.5 * (viscosity[i] + viscosity[j]) * (velocity[j] - velocity[i]);
    });
  });
}

template <int Dim>
void add_side_wall_friction(const Particles<Dim>& particles, const ViscosityLaw& law,
                            std::span<const Vec<Dim>> velocity, std::span<Vec<Dim>> acceleration) {
  if (law.channel_width == 0.0) return;
  for_each(particles.owned, [&](std::size_t i) {
    if (particles.is_fluid(i)) acceleration[i] -= law.side_wall_rate(velocity[i].norm()) * velocity[i];
  });
}

template <int Dim>
void add_noise_viscosity(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double spacing, double viscosity,
                         std::span<const Vec<Dim>> velocity, std::span<const Mat<Dim>> gradient,
                         std::span<Vec<Dim>> acceleration) {
  for_each(pairs.owned(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    acceleration[i] += viscosity * sum_over_fluid(pairs, particles, i, [&](std::int32_t j, std::size_t k) -> Vec<Dim> {
                         return noise_force<Dim>(pairs, k, particles.volume[j], spacing, velocity[j] - velocity[i],
                                                 gradient[i] + gradient[j], are_in_layer(particles, i, j));
                       });
  });
}

template <int Dim>
void add_consistent_viscosity(const Pairs<Dim>& pairs, const Particles<Dim>& particles,
                              std::span<const Renormalisation<Dim>> tensors, std::span<const std::uint8_t> takes_part,
                              double spacing, std::span<const double> viscosity, std::span<const Vec<Dim>> velocity,
                              std::span<Vec<Dim>> acceleration) {
  for_each(pairs.owned(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    if (tensors[i].laplacian_is_sound()) {
      acceleration[i] += viscosity[i] * consistent_laplacian<Dim, Vec<Dim>>(pairs, i, tensors[i], particles.volume,
                                                                            takes_part, velocity, Vec<Dim>::Zero());
      return;
    }
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      if (!takes_part[j]) continue;
      sum += fallback_laplacian_weight(tensors[i], particles.volume[j], pairs.r(k), pairs.W[k], spacing) *
             (velocity[j] - velocity[i]);
    }
    acceleration[i] += viscosity[i] * sum;
  });
}

#define TAILWATER_INSTANTIATE(Dim)                                                                                    \
  template void effective_viscosity<Dim>(const ViscosityLaw&, std::span<const Vec<Dim>>, std::span<double>);          \
  template void add_newtonian_viscosity<Dim>(                                                                         \
      const Pairs<Dim>&, const Particles<Dim>&, double, std::span<const Vec<Dim>>, std::span<const double>, double,   \
      std::span<const Vec<Dim>>, std::span<const Mat<Dim>>, std::span<Vec<Dim>>);                                     \
  template void add_shao_lo_viscosity<Dim>(const Pairs<Dim>&, const Particles<Dim>&, double, std::span<const double>, \
                                           std::span<const double>, std::span<const Vec<Dim>>, std::span<Vec<Dim>>);  \
  template void add_noise_viscosity<Dim>(const Pairs<Dim>&, const Particles<Dim>&, double, double,                    \
                                         std::span<const Vec<Dim>>, std::span<const Mat<Dim>>, std::span<Vec<Dim>>);  \
  template void add_side_wall_friction<Dim>(const Particles<Dim>&, const ViscosityLaw&, std::span<const Vec<Dim>>,    \
                                            std::span<Vec<Dim>>);                                                     \
  template void add_consistent_viscosity<Dim>(                                                                        \
      const Pairs<Dim>&, const Particles<Dim>&, std::span<const Renormalisation<Dim>>, std::span<const std::uint8_t>, \
      double, std::span<const double>, std::span<const Vec<Dim>>, std::span<Vec<Dim>>);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
