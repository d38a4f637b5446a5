#include "published/smagorinsky.h"

#include <cmath>

#include "base/for_each.h"
#include "closures/fluid_pairs.h"
#include "published/renormalisation.h"

namespace tailwater {

template <int Dim>
void sub_particle_stress(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double c_s, double spacing,
                         std::span<const Vec<Dim>> velocity, std::span<Mat<Dim>> stress) {
  for_each(pairs.owned(), [&](std::size_t i) {
    stress[i].setZero();
    if (!particles.is_fluid(i)) return;
    Mat<Dim> A = Mat<Dim>::Zero();
    Mat<Dim> sum = Mat<Dim>::Zero();
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      if (!particles.is_fluid(j)) continue;
      const double wW = particles.volume[j] * pairs.value(i, k);
      A += wW * pairs.e(i, k) * pairs.e(i, k).transpose();
      sum -= wW / pairs.r(i, k) * (velocity[j] - velocity[i]) * pairs.e(i, k).transpose();
    }
    if (min_eigenvalue<Dim>(A) < min_sound_eigenvalue<Dim>) return;
    const Mat<Dim> gradient = sum * A.inverse();
    const Mat<Dim> S = 0.5 * (gradient + gradient.transpose());
    const double nu_t = c_s * c_s * spacing * spacing * std::sqrt(2.0) * S.norm();
    const double k_sps = std::pow(nu_t / (0.08 * spacing), 2);
    stress[i] = 2.0 * nu_t * S - 2.0 / 3.0 * k_sps * Mat<Dim>::Identity();
  });
}

template <int Dim>
void add_stress_divergence(const Pairs<Dim>& pairs, const Particles<Dim>& particles, std::span<const Mat<Dim>> stress,
                           std::span<Vec<Dim>> acceleration) {
  for_each(pairs.owned(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    acceleration[i] += sum_over_fluid(pairs, particles, i, [&](std::int32_t j, std::size_t k) -> Vec<Dim> {
      return particles.volume[j] * pairs.slope(i, k) * ((stress[i] + stress[j]) * pairs.e(i, k));
    });
  });
}

TAILWATER_IN_2D_AND_3D(sub_particle_stress);
TAILWATER_IN_2D_AND_3D(add_stress_divergence);

}  // namespace tailwater
