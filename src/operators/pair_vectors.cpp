#include "operators/pair_vectors.h"

#include <utility>

#include "base/for_each.h"

namespace tailwater {
namespace {

/// B_i of owned particles.
template <int Dim>
void find_moment_corrections(const Pairs<Dim>& pairs, double radius, std::span<const double> interior,
                             std::span<const Mat<Dim>> first_moment, std::span<Mat<Dim>> correction) {
  const double inverse_square = 1.0 / (radius * radius);
  for_each(pairs.owned(), [&](std::size_t i) {
    const double share = interior[i];
    correction[i].setIdentity();
    if (share == 0.0) return;
    // Weights 1 - (r/R)^2: a mean over as many neighbours as there are, and continuous.
    Mat<Dim> sum = share * first_moment[i];
    double weights = share;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      const double weight = interior[j] * (1.0 - pairs.d[k].squaredNorm() * inverse_square);
      sum += weight * first_moment[j];
      weights += weight;
    }
    const Mat<Dim> mean = sum / weights;
    correction[i] = (1.0 - share) * Mat<Dim>::Identity() + share * mean.inverse();
  });
}

/// The equation for l, row by row.
template <int Dim>
struct ClosingEquation {
  std::vector<double> divisor;  ///< 1/m^2; sum_j w_j F_ij / interior_i, 0 where there is no equation
  std::vector<Vec<Dim>> rhs;    ///< 1/m; -1/2 sum_j w_j a_ij
};

/// Sets a_ij = -F (B_i + B_j)/2 d_ij of every pair, and poses the equation that closes half of the faces they leave
/// open.
template <int Dim>
ClosingEquation<Dim> find_corrected_gradients(const Pairs<Dim>& pairs, std::span<const double> volume,
                                              std::span<const double> interior, std::span<const Mat<Dim>> correction,
                                              std::span<Vec<Dim>> pair_vectors) {
  ClosingEquation<Dim> equation;
  equation.divisor.resize(pairs.owned());
  equation.rhs.resize(pairs.owned());
  for_each(pairs.owned(), [&](std::size_t i) {
    const Mat<Dim> own = 0.5 * correction[i];
    Vec<Dim> open = Vec<Dim>::Zero();
    double diagonal = 0.0;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      const Vec<Dim> a = -pairs.F[k] * ((own + 0.5 * correction[j]) * pairs.d[k]);
      pair_vectors[k] = a;
      open += volume[j] * a;
      diagonal += volume[j] * pairs.F[k];
    }
    equation.divisor[i] = interior[i] == 0.0 ? 0.0 : diagonal / interior[i];
    equation.rhs[i] = -0.5 * open;
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
      const auto j = pairs.j[k];
      sum += (volume[j] * pairs.F[k]) * l[j];
    }
    next[i] = sum / equation.divisor[i];
  });
}

/// a_ij <- a_ij + F (l_i - l_j), and their sums.
template <int Dim>
void close_faces(const Pairs<Dim>& pairs, std::span<const double> volume, std::span<const Vec<Dim>> l,
                 std::span<Vec<Dim>> pair_vectors, std::span<Vec<Dim>> open_faces) {
  for_each(pairs.owned(), [&](std::size_t i) {
    const Vec<Dim> own = l[i];
    Vec<Dim> open = Vec<Dim>::Zero();
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      const Vec<Dim> a = pair_vectors[k] + pairs.F[k] * (own - l[j]);
      pair_vectors[k] = a;
      open += volume[j] * a;
    }
    open_faces[i] = open;
  });
}

}  // namespace

template <int Dim>
void find_kernel_gradients(const Pairs<Dim>& pairs, std::vector<Vec<Dim>>& pair_vectors) {
  pair_vectors.resize(pairs.j.size());
  for_each(pair_vectors.size(), [&](std::size_t k) { pair_vectors[k] = pairs.gradient(k); });
}

template <int Dim>
void find_corrected_pair_vectors(const Pairs<Dim>& pairs, const Halo<Dim>& halo, double radius,
                                 std::span<const double> volume, std::span<const double> interior,
                                 std::span<const Mat<Dim>> first_moment, std::vector<Vec<Dim>>& pair_vectors,
                                 std::vector<Vec<Dim>>& open_faces, int sweeps) {
  std::vector<Mat<Dim>> correction(volume.size());
  find_moment_corrections<Dim>(pairs, radius, interior, first_moment, correction);
  halo.exchange(correction);
  pair_vectors.resize(pairs.j.size());
  const ClosingEquation<Dim> equation =
      find_corrected_gradients<Dim>(pairs, volume, interior, correction, pair_vectors);

  // The first sweep starts from 0, where the sum is 0.
  std::vector<Vec<Dim>> l(volume.size(), Vec<Dim>::Zero());
  if (sweeps > 0) {
    for_each(pairs.owned(), [&](std::size_t i) {
      if (equation.divisor[i] != 0.0) l[i] = equation.rhs[i] / equation.divisor[i];
    });
    halo.exchange(l);
  }
  std::vector<Vec<Dim>> next(volume.size());
  for (int n = 1; n < sweeps; ++n) {
    sweep<Dim>(pairs, volume, equation, l, next);
    halo.exchange(next);
    std::swap(l, next);
  }
  open_faces.resize(pairs.owned());
  close_faces<Dim>(pairs, volume, l, pair_vectors, open_faces);
}

#define TAILWATER_INSTANTIATE(Dim)                                                                                     \
  template void find_kernel_gradients<Dim>(const Pairs<Dim>&, std::vector<Vec<Dim>>&);                                 \
  template void find_corrected_pair_vectors<Dim>(const Pairs<Dim>&, const Halo<Dim>&, double, std::span<const double>, \
                                                 std::span<const double>, std::span<const Mat<Dim>>,                   \
                                                 std::vector<Vec<Dim>>&, std::vector<Vec<Dim>>&, int);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
