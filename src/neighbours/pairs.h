// The interacting pairs: compact neighbour rows, and for each pair the values every operator needs. Operators see the
// kernel only through these values.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "kernel/kernel.h"

namespace tailwater {

/// Row i holds the neighbours of owned particle i within the support: entries row_begin[i] .. row_begin[i + 1] of the
/// arrays below.
template <int Dim>
struct Pairs {
  std::vector<std::size_t> row_begin;  ///< owned + 1 entries
  std::vector<std::int32_t> j;         ///< neighbour, owned or ghost
  std::vector<Vec<Dim>> d;             ///< m; r_ij = r_i - r_j, from j to i, never 0
  std::vector<double> W;               ///< 1/m^Dim; kernel
  std::vector<double> F;               ///< 1/m^(Dim+2); -(dW/dr)/r, never negative, so grad_i W_ij = -F d

  double r(std::size_t k) const { return d[k].norm(); }            ///< m; |r_ij|
  Vec<Dim> e(std::size_t k) const { return d[k] / r(k); }          ///< unit vector along r_ij
  double slope(std::size_t k) const { return -F[k] * r(k); }       ///< 1/m^(Dim+1); dW/dr
  Vec<Dim> gradient(std::size_t k) const { return -F[k] * d[k]; }  ///< 1/m^(Dim+1); grad_i W_ij

  std::size_t begin(std::size_t i) const { return row_begin[i]; }
  std::size_t end(std::size_t i) const { return row_begin[i + 1]; }
  std::size_t owned() const { return row_begin.empty() ? 0 : row_begin.size() - 1; }
};

/// Particles that may come within the support of owned particle i while the list is valid: j[row_begin[i]] ..
/// j[row_begin[i + 1]].
struct NeighbourList {
  std::vector<std::size_t> row_begin{0};  ///< owned + 1 entries
  std::vector<std::int32_t> j;            ///< owned or ghost, ascending in each row
};

/// Makes pairs of the list's entries that are within the support at the given positions, in the list's order. Two
/// particles at one place get r = `least_distance` and an arbitrary direction, opposite for the two (by their `id`s),
/// so that they can separate.
template <int Dim>
void evaluate_pairs(const Kernel<Dim>& kernel, std::span<const Vec<Dim>> position, std::span<const std::int64_t> id,
                    double least_distance, const NeighbourList& list, Pairs<Dim>& pairs);

/// Keeps the pairs k of row i for which keep(i, k) is true, in their order.
template <int Dim, class Keep>
void keep_pairs(Pairs<Dim>& pairs, Keep&& keep) {
  std::size_t n = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < pairs.owned(); ++i) {  // in order: rows are put one behind the other
    const std::size_t end = pairs.end(i);
    for (std::size_t k = begin; k < end; ++k) {
      if (!keep(i, k)) continue;
      pairs.j[n] = pairs.j[k];
      pairs.d[n] = pairs.d[k];
      pairs.W[n] = pairs.W[k];
      pairs.F[n] = pairs.F[k];
      ++n;
    }
    begin = end;
    pairs.row_begin[i + 1] = n;
  }
  pairs.j.resize(n);
  pairs.d.resize(n);
  pairs.W.resize(n);
  pairs.F.resize(n);
}

}  // namespace tailwater
