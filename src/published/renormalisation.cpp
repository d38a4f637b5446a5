#include "published/renormalisation.h"

#include <Eigen/LU>
#include <cmath>

#include "base/eigen.h"
#include "base/for_each.h"

namespace tailwater {
namespace {

/// Relative size below which a pivot of the B2 system counts as zero.
constexpr double singular_pivot = 1e-9;

template <int Dim>
struct PairMoments {
  using Third = SmallMatrix<Dim, symmetric_size<Dim>>;
  using Fourth = Mat<symmetric_size<Dim>>;

  Mat<Dim> A = Mat<Dim>::Zero();
  Third C = Third::Zero();
  Third D = Third::Zero();
  Fourth E = Fourth::Zero();

  void add(const Vec<Dim>& e, double r, double wW) {
    const Packed<Dim> ee = packed_dyad<Dim>(e);
    A += wW * e * e.transpose();
    C += (wW / r) * e * ee.transpose();
    D += (wW * r) * e * ee.transpose();
    E += wW * ee * ee.transpose();
  }
};

template <int Dim>
Renormalisation<Dim> renormalisation_of(const PairMoments<Dim>& moments) {
  Renormalisation<Dim> result;
  result.trace_A = moments.A.trace();
  result.min_eigenvalue_A = min_eigenvalue<Dim>(moments.A);
  if (result.min_eigenvalue_A < 1e-9) return result;
  result.B1 = moments.A.inverse();

  // sum over a <= b of m_ab B2_ab M_ab,cd = I_cd, M = E - C . B1 . D, is the transposed system for m * B2.
  const typename PairMoments<Dim>::Fourth M = moments.E - moments.C.transpose() * result.B1 * moments.D;
  constexpr int size = symmetric_size<Dim>;
  const Eigen::FullPivLU<Eigen::Matrix<double, size, size>> factors(to_eigen(M).transpose());
  if (factors.maxPivot() == 0.0 ||
      std::abs(factors.matrixLU().diagonal()[symmetric_size<Dim> - 1]) < singular_pivot * factors.maxPivot()) {
    return result;
  }
  const Packed<Dim> weighted_B2 = from_eigen<size, 1>(factors.solve(to_eigen(packed_identity<Dim>())));
  result.B2 = weighted_B2.cwiseQuotient(packed_multiplicity<Dim>());
  result.drift = result.B1 * (moments.C * weighted_B2);
  result.b2_sum = result.B2.cwiseAbs().sum();
  result.has_inverse = true;
  return result;
}

}  // namespace

template <int Dim>
void compute_renormalisation(const Pairs<Dim>& pairs, std::span<const double> volume,
                             std::span<const std::uint8_t> takes_part, std::span<Renormalisation<Dim>> result) {
  for_each(pairs.owned(), [&](std::size_t i) {
    PairMoments<Dim> moments;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      if (!takes_part[j] || pairs.value(i, k) == 0.0) continue;
      moments.add(pairs.e(i, k), pairs.r(i, k), volume[j] * pairs.value(i, k));
    }
    result[i] = renormalisation_of(moments);
  });
}

TAILWATER_IN_2D_AND_3D(compute_renormalisation);

}  // namespace tailwater
