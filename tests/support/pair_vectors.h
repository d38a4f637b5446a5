// Pair vectors of a set of particles, as `locate` finds them for a flow.
#pragma once

#include <optional>
#include <vector>

#include "operators/concentration.h"
#include "operators/pair_vectors.h"
#include "support/particle_set.h"

namespace tailwater {

template <int Dim>
PairVectorField<Dim> kernel_gradients(const ParticleSet<Dim>& set) {
  PairVectorField<Dim> vectors;
  find_kernel_gradients(set.pairs(), vectors);
  return vectors;
}

template <int Dim>
struct CorrectedPairVectors {
  PairVectorField<Dim> vectors;
  std::vector<Vec<Dim>> open_faces;
  std::vector<double> mean_interior;
};

/// After so many sweeps, as many as a run makes if none are given. `interior` has an entry per particle, ghosts
/// included.
template <int Dim>
CorrectedPairVectors<Dim> corrected_pair_vectors_and_faces(const ParticleSet<Dim>& set,
                                                           const std::vector<double>& interior,
                                                           CorrectionReach reach = CorrectionReach::inside,
                                                           std::optional<int> sweeps = {}) {
  const Pairs<Dim>& pairs = set.pairs();
  const Halo<Dim>& halo = set.neighbourhood.halo();
  std::vector<Packed<Dim>> moment(set.size());
  for (std::size_t i = 0; i < pairs.owned(); ++i) {
    moment[i] = packed<Dim>(kernel_sums<Dim>(pairs, i, {0.0, 1.0, 1.0}).first_moment);
  }
  halo.exchange(moment);
  CorrectedPairVectors<Dim> found;
  std::vector<float> room(pairs.j.size());
  const double radius = kernel_radius(set.neighbourhood.kernel());
  found.mean_interior.resize(pairs.owned());
  find_corrected_pair_vectors<Dim>(pairs, halo, {radius, set.particles.volume, set.particles.kind, interior, moment},
                                   reach, sweeps.value_or(closing_sweeps(reach)), room, found.vectors, found.open_faces,
                                   found.mean_interior);
  return found;
}

/// The vectors alone.
template <int Dim>
PairVectorField<Dim> corrected_pair_vectors(const ParticleSet<Dim>& set, const std::vector<double>& interior,
                                            CorrectionReach reach = CorrectionReach::inside,
                                            std::optional<int> sweeps = {}) {
  return corrected_pair_vectors_and_faces<Dim>(set, interior, reach, sweeps).vectors;
}

/// Pair by pair.
template <int Dim>
std::vector<Vec<Dim>> listed(const Pairs<Dim>& pairs, const PairVectorField<Dim>& vectors) {
  std::vector<Vec<Dim>> list(pairs.j.size());
  for (std::size_t i = 0; i < pairs.owned(); ++i) {
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) list[k] = vectors.at(pairs, i, k);
  }
  return list;
}

}  // namespace tailwater
