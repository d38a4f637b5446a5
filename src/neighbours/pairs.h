// Interacting pairs as compact neighbour rows. Apart from the neighbour's index, and a weight where needed, nothing is
// stored per pair: the places of neighbours, from which the rest is computed, stay in the cache, and an array with an
// entry per pair would not.
//
// Loops over pairs compute in single precision (base/lanes.h). A position in single precision would be too coarse: in a
// long channel its rounding error is a noticeable fraction of dx. Places are therefore integers modulo 2^32, in units
// so small that differences between neighbours are exact to 2^-28 of the support, in a domain of any size.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/room.h"
#include "base/vec.h"
#include "kernel/kernel.h"

namespace tailwater {

/// Which pairs the rows of wall particles hold: only those with fluid (for dummies), or all.
enum class WallRows { fluid_only, all };

/// Place and volume of a particle: the data of a neighbour that loops over pairs read.
template <int Dim>
struct alignas(16) Place {
  std::array<std::uint32_t, Dim> at{};  ///< in units of Pairs::unit, modulo 2^32
  float signed_volume = 0.0F;           ///< m^Dim; negative for wall particles
};

/// Row i holds the neighbours of owned particle i within the support: entries row_begin[i] .. row_begin[i + 1] of the
/// arrays below.
template <int Dim>
struct Pairs {
  std::vector<std::size_t> row_begin;   ///< owned + 1 entries
  UnwrittenArray<std::int32_t> j;       ///< neighbour: in each row those below i, those above it, then ghosts
  UnwrittenArray<float> weight;         ///< of each pair in kernel and gradient, from 0 to 1; empty: 1 for all pairs
  std::vector<std::uint8_t> sees_wall;  ///< of row i; 0: none of its neighbours is a wall particle
  std::vector<Place<Dim>> place;        ///< of all particles when the pairs were found; unique among neighbours
  std::array<float, Dim> unit{};        ///< m; of places
  std::vector<Vec<Dim>> position;       ///< m; of all particles when the pairs were found
  std::vector<std::int64_t> id;         ///< of all particles
  /// Local particle spacing, and therefore radius of the support, relative to that of the case; of all particles. A
  /// pair uses the mean of both particles. Empty: 1 for all particles.
  std::vector<float> relative_spacing;
  std::vector<std::uint8_t> has_one_spacing;  ///< of row i, where particles have several; 1: all of it has that of i
  float inverse_cell = 1.0F;                  ///< 1/m^Dim; inverse volume of a particle with the spacing of the case
  double min_distance = 0.0;                  ///< m; two particles nearer than this count as this far apart
  float min_distance_squared = 0.0F;          ///< m^2; square of the least distance
  Kernel<Dim> kernel = make_kernel<Dim>(KernelName::wendland_c2, 1.0);
  Kernel<Dim, float> kernel_in_lanes = in_single_precision(kernel);

  /// r_ij = r_i - r_j [m] of entry k of row i, from j to i, never 0. Two particles at one place get an arbitrary
  /// direction, opposite for the two (by their ids), so that they can separate.
  Vec<Dim> d(std::size_t i, std::size_t k) const {
    const Vec<Dim> r_ij = position[i] - position[j[k]];
    if (r_ij.squaredNorm() > min_distance * min_distance) return r_ij;
    return (id[j[k]] > id[i] ? min_distance : -min_distance) * Vec<Dim>::UnitX();
  }
  double r(std::size_t i, std::size_t k) const { return d(i, k).norm(); }          ///< m; |r_ij|
  Vec<Dim> e(std::size_t i, std::size_t k) const { return d(i, k).normalized(); }  ///< unit vector along r_ij
  /// Whether particles have several spacings.
  bool is_graded() const { return !relative_spacing.empty(); }
  double relative_spacing_of(std::size_t i) const { return is_graded() ? relative_spacing[i] : 1.0; }
  /// Weight of particle i in kernel means at its place, relative to a particle with the spacing of the case.
  double weight_in_means_of(std::size_t i) const {
    const double volume = std::abs(place[i].signed_volume) * static_cast<double>(inverse_cell);
    return volume / power<Dim>(relative_spacing_of(i));
  }
  /// 1/m^Dim; W_ij times the weight of the pair. F, slope and gradient contain the weight too.
  double value(std::size_t i, std::size_t k) const {
    const double of_pair = weight.empty() ? 1.0 : weight[k];
    if (!is_graded()) return of_pair * kernel_value(kernel, r(i, k));
    const double relative = 0.5 * (relative_spacing[i] + relative_spacing[j[k]]);
    return of_pair * kernel_value(kernel, r(i, k) / relative) / power<Dim>(relative);
  }
  /// 1/m^(Dim+2); F = -(dW/dr)/r as computed in lanes, never negative, so that grad_i W_ij = -F d. To call F and the
  /// functions below, include pair_lanes.h.
  float F(std::size_t i, std::size_t k) const;  // NOLINT(readability-identifier-naming): as in formulas
  double slope(std::size_t i, std::size_t k) const { return -F(i, k) * r(i, k); }       ///< 1/m^(Dim+1); dW/dr
  Vec<Dim> gradient(std::size_t i, std::size_t k) const { return -F(i, k) * d(i, k); }  ///< 1/m^(Dim+1); grad_i W_ij

  std::size_t begin(std::size_t i) const { return row_begin[i]; }
  std::size_t end(std::size_t i) const { return row_begin[i + 1]; }
  std::size_t owned() const { return row_begin.empty() ? 0 : row_begin.size() - 1; }
};

/// Multiplies the pairs k of row i by weigh(i, k), from 0 to 1, and removes those of weight 0. Rows for which
/// may_change(i) is false keep weight 1. No weights are stored if may_change is false for all rows.
template <int Dim, class MayChange, class Weigh>
void weigh_pairs(Pairs<Dim>& pairs, MayChange&& may_change, Weigh&& weigh) {
  std::size_t i = 0;
  while (i < pairs.owned() && !may_change(i)) ++i;
  if (i == pairs.owned()) return;
  pairs.weight.assign(pairs.j.size(), 1.0F);
  std::size_t n = pairs.begin(i);
  std::size_t begin = n;
  for (; i < pairs.owned(); ++i) {  // in order: the rows are stored without gaps
    const std::size_t end = pairs.end(i);
    const bool changes = may_change(i);
    if (changes) pairs.sees_wall[i] = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const float weight = changes ? weigh(i, k) : 1.0F;
      if (weight == 0.0F) continue;
      if (pairs.place[pairs.j[k]].signed_volume < 0.0F) pairs.sees_wall[i] = 1;
      pairs.j[n] = pairs.j[k];
      pairs.weight[n] = weight;
      ++n;
    }
    begin = end;
    pairs.row_begin[i + 1] = n;
  }
  pairs.j.resize(n);
  pairs.weight.resize(n);
}

}  // namespace tailwater
