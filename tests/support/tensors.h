// Consistent operators on a whole particle set: everybody takes part.
#pragma once

#include <vector>

#include "published/gradient_consistent.h"
#include "published/laplacian_consistent.h"
#include "published/renormalisation.h"
#include "support/particle_set.h"

namespace tailwater {

template <int Dim>
struct ConsistentOperators {
  explicit ConsistentOperators(const ParticleSet<Dim>& particle_set)
      : set(particle_set), takes_part(particle_set.size(), 1), tensors(particle_set.pairs().owned()) {
    compute_renormalisation<Dim>(set.pairs(), set.particles.volume, takes_part, tensors);
  }

  Vec<Dim> gradient(std::size_t i, const std::vector<double>& field) const {
    return consistent_gradient<Dim>(set.pairs(), i, tensors[i].B1, set.particles.volume, takes_part,
                                    std::span<const double>(field));
  }
  Mat<Dim> gradient(std::size_t i, const std::vector<Vec<Dim>>& field) const {
    return consistent_gradient<Dim>(set.pairs(), i, tensors[i].B1, set.particles.volume, takes_part,
                                    std::span<const Vec<Dim>>(field));
  }
  double laplacian(std::size_t i, const std::vector<double>& field) const {
    return consistent_laplacian<Dim, double>(set.pairs(), i, tensors[i], set.particles.volume, takes_part, field, 0.0);
  }
  Vec<Dim> laplacian(std::size_t i, const std::vector<Vec<Dim>>& field) const {
    return consistent_laplacian<Dim, Vec<Dim>>(set.pairs(), i, tensors[i], set.particles.volume, takes_part, field,
                                               Vec<Dim>::Zero());
  }
  double laplacian_weight(std::size_t i, std::size_t k) const {
    const Pairs<Dim>& pairs = set.pairs();
    return consistent_laplacian_weight<Dim>(tensors[i], set.particles.volume[pairs.j[k]], pairs.e(i, k), pairs.r(i, k),
                                            pairs.value(i, k));
  }

  const ParticleSet<Dim>& set;
  std::vector<std::uint8_t> takes_part;
  std::vector<Renormalisation<Dim>> tensors;
};

}  // namespace tailwater
