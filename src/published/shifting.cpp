#include "published/shifting.h"

#include "base/for_each.h"
#include "published/gradient_consistent.h"

namespace tailwater {
namespace {

/// R_i.
template <int Dim>
Vec<Dim> direction(const Pairs<Dim>& pairs, std::size_t i) {
  double sum = 0.0;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) sum += pairs.r(i, k);
  const double mean_distance = sum / static_cast<double>(pairs.end(i) - pairs.begin(i));
  Vec<Dim> direction = Vec<Dim>::Zero();
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const double ratio = mean_distance / pairs.r(i, k);
    direction += ratio * ratio * ratio * pairs.e(i, k);
  }
  return direction;
}

}  // namespace

template <int Dim>
std::size_t find_published_shifts(const ShiftingLaw& law, double dt, const Pairs<Dim>& pairs,
                                  const Particles<Dim>& particles, const Surroundings<Dim>& surroundings,
                                  std::span<Vec<Dim>> shifts) {
  return count_each(pairs.owned(), [&](std::size_t i) {
    shifts[i].setZero();
    if (!particles.is_fluid(i) || pairs.begin(i) == pairs.end(i) || surroundings.interior[i] == 0.0) return false;
    shifts[i] = law.strength * particles.velocity[i].norm() * dt * direction(pairs, i);
    return bound_shift<Dim>(shifts[i], surroundings.interior[i], law.cap);
  });
}

template <int Dim>
void carry_fields_along(const Pairs<Dim>& pairs, const Tensors<Dim>& tensors, const Surroundings<Dim>& surroundings,
                        std::span<const Vec<Dim>> shifts, Particles<Dim>& particles) {
  std::vector<Vec<Dim>> velocity_change(particles.owned, Vec<Dim>::Zero());
  std::vector<double> pressure_change(particles.owned, 0.0);
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i) || surroundings.interior[i] < 1.0 || !tensors[i].gradient_is_sound()) return;
    const Mat<Dim>& B1 = tensors[i].B1;
    velocity_change[i] = consistent_gradient<Dim>(pairs, i, B1, particles.volume, surroundings.takes_part,
                                                  std::span<const Vec<Dim>>(particles.velocity)) *
                         shifts[i];
    pressure_change[i] = consistent_gradient<Dim>(pairs, i, B1, particles.volume, surroundings.takes_part,
                                                  std::span<const double>(particles.pressure))
                             .dot(shifts[i]);
  });
  for_each(particles.owned, [&](std::size_t i) {
    particles.velocity[i] += velocity_change[i];
    particles.pressure[i] += pressure_change[i];
  });
}

TAILWATER_IN_2D_AND_3D(find_published_shifts);
TAILWATER_IN_2D_AND_3D(carry_fields_along);

}  // namespace tailwater
