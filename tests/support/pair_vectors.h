// Pair vectors of a set of particles, as `locate` finds them for a flow.
#pragma once

#include <utility>
#include <vector>

#include "operators/concentration.h"
#include "operators/pair_vectors.h"
#include "support/particle_set.h"

namespace tailwater {

template <int Dim>
std::vector<Vec<Dim>> kernel_gradients(const ParticleSet<Dim>& set) {
  std::vector<Vec<Dim>> vectors(set.pairs().j.size());
  find_kernel_gradients<Dim>(set.pairs(), vectors);
  return vectors;
}

/// With faces closed by `sweeps`. `interior` has an entry per particle, ghosts included.
template <int Dim>
std::vector<Vec<Dim>> corrected_pair_vectors(const ParticleSet<Dim>& set, const std::vector<double>& interior,
                                             int sweeps = closing_sweeps) {
  const Pairs<Dim>& pairs = set.pairs();
  const std::vector<double>& volume = set.particles.volume;
  std::vector<Mat<Dim>> moment(set.size());
  for (std::size_t i = 0; i < pairs.owned(); ++i) {
    moment[i] = kernel_sums<Dim>(pairs, i, volume, 0.0).first_moment;
  }
  set.neighbourhood.halo().exchange(moment);
  std::vector<Mat<Dim>> correction(set.size());
  find_moment_corrections<Dim>(pairs, kernel_radius(set.neighbourhood.kernel()), interior, moment, correction);
  set.neighbourhood.halo().exchange(correction);
  std::vector<Vec<Dim>> vectors(pairs.j.size());
  find_corrected_gradients<Dim>(pairs, correction, vectors);
  const OpenFaces<Dim> faces = find_open_faces<Dim>(pairs, volume, interior, vectors);
  std::vector<Vec<Dim>> l(set.size(), Vec<Dim>::Zero());
  std::vector<Vec<Dim>> next = l;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    sweep_faces<Dim>(pairs, volume, faces, l, next);
    set.neighbourhood.halo().exchange(next);
    std::swap(l, next);
  }
  close_faces<Dim>(pairs, l, vectors);
  return vectors;
}

}  // namespace tailwater
