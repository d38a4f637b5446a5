#include "operators/pair_vectors.h"

#include <utility>

#include "base/for_each.h"

namespace tailwater {
namespace {

/// B_i of owned particles.
template <int Dim>
void find_moment_corrections(const Pairs<Dim>& pairs, double radius, std::span<const double> interior,
                             std::span<const Mat<Dim>> first_moment, std::span<Mat<Dim>> correction) {
  for_each(pairs.owned(), [&](std::size_t i) {
    const double share = interior[i];
    correction[i].setIdentity();
    if (share == 0.0) return;
    // Weights 1 - (r/R)^2: a mean over as many neighbours as there are, and continuous.
    Mat<Dim> sum = share * first_moment[i];
    double weights = share;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      const double q = pairs.r[k] / radius;
      const double weight = interior[j] * (1.0 - q * q);
      sum += weight * first_moment[j];
      weights += weight;
    }
    const Mat<Dim> mean = sum / weights;
    correction[i] = (1.0 - share) * Mat<Dim>::Identity() + share * mean.inverse();
  });
}

/// dW (B_i + B_j)/2 e_ij of every pair.
template <int Dim>
void find_corrected_gradients(const Pairs<Dim>& pairs, std::span<const Mat<Dim>> correction,
                              std::span<Vec<Dim>> pair_vectors) {
  for_each(pairs.owned(), [&](std::size_t i) {
    const Mat<Dim> own = correction[i];
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      pair_vectors[k] = (0.5 * pairs.dW[k]) * ((own + correction[pairs.j[k]]) * pairs.e[k]);
    }
  });
}

/// k_ij w_j of a pair [1/m^2].
template <int Dim>
double graph_weight(const Pairs<Dim>& pairs, std::size_t k, std::span<const double> volume) {
  return -volume[pairs.j[k]] * pairs.dW[k] / pairs.r[k];
}

/// The equation for l, row by row.
template <int Dim>
struct ClosingEquation {
  std::vector<double> divisor;  ///< 1/m^2; sum_j w_j k_ij / interior_i, 0 where there is no equation
  std::vector<Vec<Dim>> rhs;    ///< 1/m; -1/2 sum_j w_j a_ij
};

template <int Dim>
ClosingEquation<Dim> pose_closing(const Pairs<Dim>& pairs, std::span<const double> volume,
                                  std::span<const double> interior, std::span<const Vec<Dim>> pair_vectors) {
  ClosingEquation<Dim> equation;
  equation.divisor.assign(pairs.owned(), 0.0);
  equation.rhs.assign(pairs.owned(), Vec<Dim>::Zero());
  for_each(pairs.owned(), [&](std::size_t i) {
    if (interior[i] == 0.0) return;
    double diagonal = 0.0;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) diagonal += graph_weight(pairs, k, volume);
    equation.divisor[i] = diagonal / interior[i];
    equation.rhs[i] = -0.5 * open_faces(pairs, i, volume, pair_vectors);
  });
  return equation;
}

/// One sweep of Jacobi: `next` of owned particles from l [m].
template <int Dim>
void sweep(const Pairs<Dim>& pairs, std::span<const double> volume, const ClosingEquation<Dim>& equation,
           std::span<const Vec<Dim>> l, std::span<Vec<Dim>> next) {
  for_each(pairs.owned(), [&](std::size_t i) {
    next[i].setZero();
    if (equation.divisor[i] == 0.0) return;
    Vec<Dim> sum = equation.rhs[i];
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      sum += graph_weight(pairs, k, volume) * l[pairs.j[k]];
    }
    next[i] = sum / equation.divisor[i];
  });
}

/// a_ij <- a_ij - dW/r (l_i - l_j).
template <int Dim>
void close_faces(const Pairs<Dim>& pairs, std::span<const Vec<Dim>> l, std::span<Vec<Dim>> pair_vectors) {
  for_each(pairs.owned(), [&](std::size_t i) {
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      pair_vectors[k] -= (pairs.dW[k] / pairs.r[k]) * (l[i] - l[pairs.j[k]]);
    }
  });
}

}  // namespace

template <int Dim>
void find_kernel_gradients(const Pairs<Dim>& pairs, std::vector<Vec<Dim>>& pair_vectors) {
  pair_vectors.resize(pairs.j.size());
  for_each(pair_vectors.size(), [&](std::size_t k) { pair_vectors[k] = pairs.dW[k] * pairs.e[k]; });
}

template <int Dim>
void find_corrected_pair_vectors(const Pairs<Dim>& pairs, const Halo<Dim>& halo, double radius,
                                 std::span<const double> volume, std::span<const double> interior,
                                 std::span<const Mat<Dim>> first_moment, std::vector<Vec<Dim>>& pair_vectors,
                                 int sweeps) {
  std::vector<Mat<Dim>> correction(volume.size());
  find_moment_corrections<Dim>(pairs, radius, interior, first_moment, correction);
  halo.exchange(correction);
  pair_vectors.resize(pairs.j.size());
  find_corrected_gradients<Dim>(pairs, correction, pair_vectors);

  const ClosingEquation<Dim> equation = pose_closing<Dim>(pairs, volume, interior, pair_vectors);
  std::vector<Vec<Dim>> l(volume.size(), Vec<Dim>::Zero());
  std::vector<Vec<Dim>> next = l;
  for (int n = 0; n < sweeps; ++n) {
    sweep<Dim>(pairs, volume, equation, l, next);
    halo.exchange(next);
    std::swap(l, next);
  }
  close_faces<Dim>(pairs, l, pair_vectors);
}

#define TAILWATER_INSTANTIATE(Dim)                                                                                     \
  template void find_kernel_gradients<Dim>(const Pairs<Dim>&, std::vector<Vec<Dim>>&);                                 \
  template void find_corrected_pair_vectors<Dim>(const Pairs<Dim>&, const Halo<Dim>&, double, std::span<const double>, \
                                                 std::span<const double>, std::span<const Mat<Dim>>,                   \
                                                 std::vector<Vec<Dim>>&, int);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
