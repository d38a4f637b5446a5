#include "operators/pair_vectors.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <utility>

#include "base/for_each.h"
#include "neighbours/pair_lanes.h"

namespace tailwater {
namespace {

/// Least eigenvalue of a first moment that is divided by, over its largest: that of half a support.
constexpr double least_share = 0.5;

/// T = lambda_min M^-1: T M has no direction, and T is I across a surface, where lambda is least. Eigenvalues of M
/// below half of its largest count as that, so T is between 1/2 and 1 for any set.
template <int Dim>
Mat<Dim> equalising_correction(const Mat<Dim>& moment) {
  Eigen::SelfAdjointEigenSolver<Mat<Dim>> eigen;
  eigen.computeDirect(moment);  // reads the lower triangle
  const double largest = eigen.eigenvalues()[Dim - 1];
  if (!(largest > 0.0)) return Mat<Dim>::Identity();
  const double least = std::max(eigen.eigenvalues()[0], least_share * largest);
  const Vec<Dim> scale = least * eigen.eigenvalues().cwiseMax(least).cwiseInverse();
  const Mat<Dim> correction = eigen.eigenvectors() * scale.asDiagonal() * eigen.eigenvectors().transpose();
  return correction.template selfadjointView<Eigen::Lower>();  // symmetric to the last bit
}

/// B_i of owned particles.
template <int Dim>
void find_moment_corrections(const Pairs<Dim>& pairs, const CorrectionInput<Dim>& input, CorrectionReach reach,
                             std::span<Mat<Dim>> correction) {
  const double inverse_square = 1.0 / (input.radius * input.radius);
  for_each(pairs.owned(), [&](std::size_t i) {
    const double share = input.interior[i];
    Mat<Dim> at_surface = Mat<Dim>::Identity();
    if (reach == CorrectionReach::surface && share < 1.0) {
      at_surface = equalising_correction<Dim>(input.first_moment[i]);
    }
    correction[i] = (1.0 - share) * at_surface;
    if (share == 0.0) return;
    // Weights 1 - (r/R)^2: a mean over as many neighbours as there are, and continuous.
    MatLanes<Dim> sums{};
    Lanes weight_sums{};
    for_each_lanes(pairs.begin(i), pairs.end(i), [&](auto range) {
      const LaneIndices j = range.neighbours(pairs.j.data());
      const VecLanes<Dim> d = differences<Dim>(pairs, range, j, i);
      const Lanes weight = range.only(j(input.interior.data())) * (1.0 - d.dot(d) * inverse_square);
      const MatLanes<Dim> moment = j.symmetric(input.first_moment.data());
      for (int b = 0; b < Dim; ++b) {
        for (int a = b; a < Dim; ++a) sums.column[b].at[a] += weight * moment.column[b].at[a];
      }
      weight_sums += weight;
    });
    const Mat<Dim> sum = share * input.first_moment[i] + sum_of_lower(sums);
    const double weights = share + sum_of(weight_sums);
    const Mat<Dim> mean = sum / weights;
    correction[i] += share * mean.inverse();
  });
}

/// The equation for l, row by row.
template <int Dim>
struct ClosingEquation {
  std::vector<double> divisor;  ///< 1/m^2; sum_j w_j F_ij, over interior_i with the reach `inside`; 0: no equation
  std::vector<Vec<Dim>> rhs;    ///< 1/m
};

/// (B_i + B_j)/2 d_ij of several pairs; B is symmetric.
template <int Dim>
inline VecLanes<Dim> corrected_difference(std::span<const Mat<Dim>> correction, std::size_t i, const LaneIndices& j,
                                          const VecLanes<Dim>& d) {
  MatLanes<Dim> sum = j.symmetric(correction.data());
  for (int b = 0; b < Dim; ++b) {
    for (int a = 0; a < Dim; ++a) sum.column[b].at[a] += correction[i](a, b);
  }
  VecLanes<Dim> corrected = sum.times(d);
  for (int a = 0; a < Dim; ++a) corrected.at[a] *= 0.5;
  return corrected;
}

/// Poses the equation for l. With b = -sum_j w_j a_ij of a_ij = -F (B_i + B_j)/2 d_ij, half of the faces are closed by
/// the right-hand side b/2, and the force of the kernel's gradients is found by b - sum_j w_j F_ij d_ij.
template <int Dim>
ClosingEquation<Dim> pose_closing_equation(const Pairs<Dim>& pairs, const CorrectionInput<Dim>& input,
                                           CorrectionReach reach, std::span<const Mat<Dim>> correction) {
  const bool to_surface = reach == CorrectionReach::surface;
  ClosingEquation<Dim> equation;
  equation.divisor.resize(pairs.owned());
  equation.rhs.resize(pairs.owned());
  for_each(pairs.owned(), [&](std::size_t i) {
    const double share = input.interior[i];
    equation.divisor[i] = 0.0;
    if (to_surface ? input.kind[i] != ParticleKind::fluid : share == 0.0) return;
    VecLanes<Dim> sums{};
    VecLanes<Dim> kernel_sums{};
    Lanes weights{};
    for_each_lanes(pairs.begin(i), pairs.end(i), [&](auto range) {
      const LaneIndices j = range.neighbours(pairs.j.data());
      const Lanes weight = range.only(j(input.volume.data())) * range.load(pairs.F.data());
      const VecLanes<Dim> d = differences<Dim>(pairs, range, j, i);
      const VecLanes<Dim> corrected = corrected_difference<Dim>(correction, i, j, d);
      for (int a = 0; a < Dim; ++a) sums.at[a] += weight * corrected.at[a];
      for (int a = 0; to_surface && a < Dim; ++a) kernel_sums.at[a] += weight * d.at[a];
      weights += weight;
    });
    const Vec<Dim> open = sum_of(sums);
    equation.divisor[i] = sum_of(weights);
    equation.rhs[i] = 0.5 * open;
    if (to_surface) {
      equation.rhs[i] = share * equation.rhs[i] + (1.0 - share) * (open - sum_of(kernel_sums));
    } else {
      equation.divisor[i] /= share;
    }
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
    VecLanes<Dim> sums{};
    for_each_lanes(pairs.begin(i), pairs.end(i), [&](auto range) {
      const LaneIndices j = range.neighbours(pairs.j.data());
      const Lanes weight = range.only(j(volume.data())) * range.load(pairs.F.data());
      const VecLanes<Dim> l_j = j(l.data());
      for (int a = 0; a < Dim; ++a) sums.at[a] += weight * l_j.at[a];
    });
    next[i] = (equation.rhs[i] + sum_of(sums)) / equation.divisor[i];
  });
}

/// Sets a_ij = -F [ (B_i + B_j)/2 d_ij - (l_i - l_j) ], and their sums.
template <int Dim>
void close_faces(const Pairs<Dim>& pairs, const CorrectionInput<Dim>& input, std::span<const Mat<Dim>> correction,
                 std::span<const Vec<Dim>> l, std::span<Vec<Dim>> pair_vectors, std::span<Vec<Dim>> open_faces) {
  for_each(pairs.owned(), [&](std::size_t i) {
    VecLanes<Dim> open{};
    for_each_lanes(pairs.begin(i), pairs.end(i), [&](auto range) {
      const LaneIndices j = range.neighbours(pairs.j.data());
      const Lanes F = range.load(pairs.F.data());
      const Lanes volume_j = range.only(j(input.volume.data()));
      const VecLanes<Dim> d = differences<Dim>(pairs, range, j, i);
      const VecLanes<Dim> corrected = corrected_difference<Dim>(correction, i, j, d);
      VecLanes<Dim> pair_vector = j(l.data());
      for (int a = 0; a < Dim; ++a) {
        pair_vector.at[a] = -F * (corrected.at[a] - (l[i][a] - pair_vector.at[a]));
        open.at[a] += volume_j * pair_vector.at[a];
      }
      range.store(pair_vector, pair_vectors.data());
    });
    open_faces[i] = sum_of(open);
  });
}

}  // namespace

template <int Dim>
void find_kernel_gradients(const Pairs<Dim>& pairs, std::vector<Vec<Dim>>& pair_vectors) {
  pair_vectors.resize(pairs.j.size());
  for_each(pairs.owned(), [&](std::size_t i) {
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) pair_vectors[k] = pairs.gradient(i, k);
  });
}

template <int Dim>
void find_corrected_pair_vectors(const Pairs<Dim>& pairs, const Halo<Dim>& halo, const CorrectionInput<Dim>& input,
                                 CorrectionReach reach, int sweeps, std::vector<Vec<Dim>>& pair_vectors,
                                 std::vector<Vec<Dim>>& open_faces) {
  const std::size_t size = input.volume.size();
  std::vector<Mat<Dim>> correction(size);
  find_moment_corrections<Dim>(pairs, input, reach, correction);
  halo.exchange(correction);
  pair_vectors.resize(pairs.j.size());
  const ClosingEquation<Dim> equation = pose_closing_equation<Dim>(pairs, input, reach, correction);

  // The first sweep starts from 0, where the sum is 0.
  std::vector<Vec<Dim>> l(size, Vec<Dim>::Zero());
  if (sweeps > 0) {
    for_each(pairs.owned(), [&](std::size_t i) {
      if (equation.divisor[i] != 0.0) l[i] = equation.rhs[i] / equation.divisor[i];
    });
    halo.exchange(l);
  }
  std::vector<Vec<Dim>> next(size);
  for (int n = 1; n < sweeps; ++n) {
    sweep<Dim>(pairs, input.volume, equation, l, next);
    halo.exchange(next);
    std::swap(l, next);
  }
  open_faces.resize(pairs.owned());
  close_faces<Dim>(pairs, input, correction, l, pair_vectors, open_faces);
}

#define TAILWATER_INSTANTIATE(Dim)                                                                                 \
  template void find_kernel_gradients<Dim>(const Pairs<Dim>&, std::vector<Vec<Dim>>&);                             \
  template void find_corrected_pair_vectors<Dim>(const Pairs<Dim>&, const Halo<Dim>&, const CorrectionInput<Dim>&, \
                                                 CorrectionReach, int, std::vector<Vec<Dim>>&,                     \
                                                 std::vector<Vec<Dim>>&);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
