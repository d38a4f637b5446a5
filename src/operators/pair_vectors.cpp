#include "operators/pair_vectors.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "base/eigen.h"
#include "base/for_each.h"
#include "neighbours/halo.h"
#include "operators/support_operators.h"

namespace tailwater {
namespace {

/// Least eigenvalue of a first moment in divisions, over its largest: that of half a support.
constexpr double min_share = 0.5;

/// T = lambda_min M^-1: T M is isotropic, and T is I across a surface, where lambda is least. Eigenvalues of M below
/// half of its largest one are raised to that value, so T is between 1/2 and 1 for any set.
template <int Dim>
Mat<Dim> equalising_correction(const Mat<Dim>& moment) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Dim, Dim>> eigen;
  eigen.computeDirect(to_eigen(moment));  // reads the lower triangle
  const double largest = eigen.eigenvalues()[Dim - 1];
  if (!(largest > 0.0)) return Mat<Dim>::Identity();
  const double least = std::max(eigen.eigenvalues()[0], min_share * largest);
  const auto vectors = from_eigen<Dim, Dim>(eigen.eigenvectors());
  const auto scale = Vec<Dim>::NullaryExpr([&](int d) { return least / std::max(eigen.eigenvalues()[d], least); });
  return vectors * scale.asDiagonal() * vectors.transpose();
}

/// Data that the mean of first moments reads from a neighbour.
template <int Dim>
struct alignas(Dim == 2 ? 16 : 32) InteriorMoment {
  float interior;
  std::array<float, symmetric_size<Dim>> first_moment;  ///< M, packed
};

/// M of a particle, over that of a continuum with the same supports, which is I away from borders.
template <int Dim>
Packed<Dim> relative_moment(const CorrectionInput<Dim>& input, std::size_t i) {
  if (input.support == nullptr || !input.support->is_near_border(i) || input.kind[i] != ParticleKind::fluid) {
    return input.first_moment[i];
  }
  const Mat<Dim> inverse = unpacked<Dim>(input.support->first_moment[i]).inverse();
  const Mat<Dim> product = inverse * unpacked<Dim>(input.first_moment[i]);
  return packed<Dim>(0.5 * (product + product.transpose()));
}

/// Computes B_i of owned particles, and the mean of `interior`.
template <int Dim>
void find_moment_corrections(const Pairs<Dim>& pairs, const CorrectionInput<Dim>& input, CorrectionReach reach,
                             std::span<Packed<Dim>> correction, std::span<double> mean_interior) {
  std::vector<InteriorMoment<Dim>> moments(input.interior.size());
  for_each(moments.size(), [&](std::size_t i) {
    moments[i].interior = static_cast<float>(input.interior[i]);
    const Packed<Dim> moment = relative_moment(input, i);
    for (int n = 0; n < symmetric_size<Dim>; ++n) moments[i].first_moment[n] = static_cast<float>(moment[n]);
  });
  using Moment = InteriorMoment<Dim>;
  static_assert(offsetof(Moment, interior) == 0);
  constexpr std::size_t first_moment = offsetof(Moment, first_moment) / sizeof(float);
  const auto inverse_square = static_cast<float>(1.0 / (input.radius * input.radius));
  for_each(pairs.owned(), [&](std::size_t i) {
    const double share = input.interior[i];
    Mat<Dim> at_surface = Mat<Dim>::Identity();
    if (reach == CorrectionReach::surface && share < 1.0) {
      at_surface = equalising_correction<Dim>(unpacked<Dim>(input.first_moment[i]));
    }
    const double kept = share * (input.support != nullptr ? input.support->kept_correction[i] : 1.0);
    correction[i] = (1.0 - kept) * packed<Dim>(at_surface);
    if (share == 0.0) return;
    // Weights 1 - (r/R)^2, times the volume where volumes differ: a continuous mean over all neighbours in the support.
    std::array<Lanes, symmetric_size<Dim>> sums{};
    Lanes weight_sums{};
    Lanes interiors{};
    Lanes kernel_sums{};
    for_each_pair(pairs, i, [&](const auto& batch) {
      const PlaceLanes<Dim> place = batch.place();
      const Lanes squared = place.d.dot(place.d);
      const auto other = batch.j.numbers(moments.data());
      const Lanes other_interior = other[0];
      const Lanes weight = batch.weight_in_means(place) * batch.range.only(other_interior) *
                           (1.0F - batch.squared_over_spacing(squared) * inverse_square);
      for (int n = 0; n < symmetric_size<Dim>; ++n) sums[n] += weight * other[first_moment + n];
      weight_sums += weight;
      const Lanes W = batch.kernel_of_fluid(place);
      interiors += W * other_interior;
      kernel_sums += W;
    });
    const double kernel_sum = sum_of(kernel_sums);
    mean_interior[i] = kernel_sum > 0.0 ? sum_of(interiors) / kernel_sum : 0.0;
    const double own = pairs.is_graded() ? share * input.volume[i] * pairs.inverse_cell : share;
    Packed<Dim> sum = own * relative_moment(input, i);
    for (int n = 0; n < symmetric_size<Dim>; ++n) sum[n] += sum_of(sums[n]);
    const double weights = own + sum_of(weight_sums);
    const Mat<Dim> mean = unpacked<Dim>(sum / weights);
    correction[i] += kept * packed<Dim>(mean.inverse());
  });
}

/// The linear equation for l, row by row.
template <int Dim>
struct ClosingEquation {
  std::span<float> F;           ///< 1/m^(Dim+2); of each pair of a row with an equation, stored for the sweeps
  std::vector<double> weights;  ///< 1/m^2; sum_j w_j F_ij; 0: no equation
  std::vector<double> share;    ///< fraction of l that is applied; the divisor is `weights` over it
  std::vector<Vec<Dim>> open;   ///< 1/m; b = -sum_j w_j a_ij with l = 0
  std::vector<Vec<Dim>> rhs;    ///< 1/m

  ClosingEquation(std::size_t count, std::span<float> room)
      : F(room), weights(count, 0.0), share(count), open(count), rhs(count) {}
};

/// Writes the equation for l. With b = -sum_j w_j a_ij of a_ij = -F (B_i + B_j)/2 d_ij, the right-hand side b/2 closes
/// half of the faces. The right-hand side b - sum_j w_j F_ij d_ij gives the force of the kernel's gradients.
template <int Dim>
ClosingEquation<Dim> pose_closing_equation(const Pairs<Dim>& pairs, const CorrectionInput<Dim>& input,
                                           CorrectionReach reach, const PairVectorField<Dim>& unclosed,
                                           std::span<float> room) {
  const bool to_surface = reach == CorrectionReach::surface;
  ClosingEquation<Dim> equation(pairs.owned(), room);
  for_each(pairs.owned(), [&](std::size_t i) {
    const double share = input.interior[i];
    equation.open[i].setZero();
    if (to_surface ? input.kind[i] != ParticleKind::fluid : share == 0.0) return;
    const bool is_near_surface = to_surface && share < 1.0;
    VecLanes<Dim> sums{};
    VecLanes<Dim> kernel_sums{};
    Lanes weights{};
    const SupportTerms<Dim>* const support =
        input.support != nullptr && input.support->is_near_border(i) ? input.support : nullptr;
    for_each_pair(pairs, i, [&](const auto& batch) {
      const PairVectorLanes<Dim> pair = unclosed(batch);
      const Lanes volume_j = pair.place.volume();
      const Lanes weight = volume_j * batch.store(pair.F, equation.F.data() + pairs.begin(i));
      if (support == nullptr) {
        sums -= volume_j * pair.a;
      } else {
        sums -= volume_j * mean_inverse_reference(batch, *support) * pair.a;
      }
      if (is_near_surface) kernel_sums += weight * pair.place.d;
      weights += weight;
    });
    Vec<Dim> open = sum_of(sums);
    if (support != nullptr) open -= support->faces[i];
    equation.weights[i] = sum_of(weights);
    equation.open[i] = open;
    equation.share[i] = to_surface ? 1.0 : share;
    equation.rhs[i] = 0.5 * open;
    if (is_near_surface) equation.rhs[i] = share * equation.rhs[i] + (1.0 - share) * (open - sum_of(kernel_sums));
  });
  return equation;
}

/// sum_j w_j F_ij l_j [1/m], from w_j l_j.
template <int Dim>
Vec<Dim> sum_over_neighbours(const Pairs<Dim>& pairs, const ClosingEquation<Dim>& equation,
                             std::span<const Float4> weighted_l, std::size_t i) {
  VecLanes<Dim> sums{};
  for_each_pair(pairs, i,
                [&](const auto& batch) { sums += batch.range.load(equation.F.data()) * batch.of(weighted_l); });
  return sum_of(sums);
}

/// Stores places and corrections of all particles, with l = 0.
template <int Dim>
void begin(const Pairs<Dim>& pairs, PairVectorField<Dim>& pair_vectors, auto&& correction) {
  pair_vectors.ends.resize(pairs.position.size());
  for_each(pairs.position.size(), [&](std::size_t i) {
    PairVectorEnd<Dim>& end = pair_vectors.ends[i];
    end = {pairs.place[i].at, pairs.place[i].signed_volume, {}, {}};
    const Packed<Dim> packed = correction(i);
    for (int n = 0; n < symmetric_size<Dim>; ++n) end.correction[n] = static_cast<float>(packed[n]);
  });
}

}  // namespace

template <int Dim>
void find_kernel_gradients(const Pairs<Dim>& pairs, PairVectorField<Dim>& pair_vectors) {
  begin(pairs, pair_vectors, [](std::size_t) { return packed_identity<Dim>(); });
}

template <int Dim>
void find_corrected_pair_vectors(const Pairs<Dim>& pairs, const Halo<Dim>& halo, const CorrectionInput<Dim>& input,
                                 CorrectionReach reach, int sweeps, std::span<float> room,
                                 PairVectorField<Dim>& pair_vectors, std::vector<Vec<Dim>>& open_faces,
                                 std::span<double> mean_interior) {
  const std::size_t size = input.volume.size();
  std::vector<Packed<Dim>> correction(size);
  find_moment_corrections<Dim>(pairs, input, reach, correction, mean_interior);
  halo.exchange(correction);
  begin(pairs, pair_vectors, [&](std::size_t i) { return correction[i]; });
  const ClosingEquation<Dim> equation = pose_closing_equation<Dim>(pairs, input, reach, pair_vectors, room);

  // Jacobi iteration; the first sweep starts from 0, where the sum is 0.
  std::vector<Vec<Dim>> l(size, Vec<Dim>::Zero());
  std::vector<Vec<Dim>> next(size, Vec<Dim>::Zero());
  std::vector<Float4> weighted_l(size);
  for (int n = 0; n < sweeps; ++n) {
    for_each(pairs.owned(), [&](std::size_t i) {
      if (equation.weights[i] == 0.0) return;
      next[i] = equation.rhs[i];
      if (n > 0) next[i] += sum_over_neighbours<Dim>(pairs, equation, weighted_l, i);
      next[i] *= equation.share[i] / equation.weights[i];
    });
    halo.exchange(next);
    std::swap(l, next);
    for_each(size, [&](std::size_t i) {
      for (int a = 0; a < Dim; ++a) weighted_l[i].at[a] = static_cast<float>(input.volume[i] * l[i][a]);
    });
  }
  for_each(size, [&](std::size_t i) {
    for (int a = 0; a < Dim; ++a) pair_vectors.ends[i].l[a] = static_cast<float>(l[i][a]);
  });
  open_faces.resize(pairs.owned());
  for_each(pairs.owned(), [&](std::size_t i) {
    open_faces[i].setZero();
    if (equation.weights[i] == 0.0) return;
    open_faces[i] =
        equation.weights[i] * l[i] - equation.open[i] - sum_over_neighbours<Dim>(pairs, equation, weighted_l, i);
  });
}

TAILWATER_IN_2D_AND_3D(find_kernel_gradients);
TAILWATER_IN_2D_AND_3D(find_corrected_pair_vectors);

}  // namespace tailwater
