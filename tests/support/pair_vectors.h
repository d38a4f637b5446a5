// Pair vectors of a set of particles, as `locate` finds them for a flow.
#pragma once

#include <vector>

#include "operators/concentration.h"
#include "operators/pair_vectors.h"
#include "support/particle_set.h"

namespace tailwater {

template <int Dim>
std::vector<Vec<Dim>> kernel_gradients(const ParticleSet<Dim>& set) {
  std::vector<Vec<Dim>> vectors;
  find_kernel_gradients(set.pairs(), vectors);
  return vectors;
}

/// With faces closed by `sweeps`. `interior` has an entry per particle, ghosts included.
template <int Dim>
std::vector<Vec<Dim>> corrected_pair_vectors(const ParticleSet<Dim>& set, const std::vector<double>& interior,
                                             int sweeps = closing_sweeps) {
  const Pairs<Dim>& pairs = set.pairs();
  const Halo<Dim>& halo = set.neighbourhood.halo();
  std::vector<Mat<Dim>> moment(set.size());
  for (std::size_t i = 0; i < pairs.owned(); ++i) {
    moment[i] = kernel_sums<Dim>(pairs, i, set.particles.volume, 0.0).first_moment;
  }
  halo.exchange(moment);
  std::vector<Vec<Dim>> vectors;
  std::vector<Vec<Dim>> open_faces;
  find_corrected_pair_vectors<Dim>(pairs, halo, kernel_radius(set.neighbourhood.kernel()), set.particles.volume,
                                   interior, moment, vectors, open_faces, sweeps);
  return vectors;
}

}  // namespace tailwater
