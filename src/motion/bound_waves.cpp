#include "motion/bound_waves.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "base/assert.h"

namespace tailwater {
namespace {

/// Change of one of two equal frequencies, whose difference has the limit of close ones.
constexpr double min_difference = 1e-4;

/// The horizontal velocity of the sum (`sign` 1) or difference (-1) of two waves at the still water's level, in phase
/// with the sum or difference of their angles: the solution of second_order.h for two waves that travel. The wave
/// number of a difference is that of `one` less that of `other`.
double pair_velocity(const TravellingWave& one, const TravellingWave& other, double sign, double gravity,
                     double depth) {
  const double k = one.wave_number;
  const double l = sign * other.wave_number;
  const double omega = one.omega;
  const double nu = sign * other.omega;
  const double s = omega * omega / gravity;
  const double r = nu * nu / gravity;
  const double q = k + l;
  const double forcing = (omega + nu) * (k * l - s * r) + 0.5 * omega * (l * l - r * r) + 0.5 * nu * (k * k - s * s);
  const double stiffness = gravity * q * std::tanh(q * depth) - (omega + nu) * (omega + nu);
  return -q * forcing / stiffness * gravity * gravity / (omega * nu) * one.amplitude * other.amplitude;
}

/// The largest eigenvalues of a symmetric matrix, and the parts of their eigenvectors.
template <class Values, class Part>
void keep_largest(const Eigen::MatrixXd& matrix, Values& values, Part&& part) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(matrix.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, std::ranges::greater(), [&](Eigen::Index n) { return std::abs(eigen.eigenvalues()[n]); });
  for (std::size_t r = 0; r < std::min(values.size(), order.size()); ++r) {
    values[r] = eigen.eigenvalues()[order[r]];
    for (Eigen::Index n = 0; n < matrix.rows(); ++n) part(n)[r] = eigen.eigenvectors()(n, order[r]);
  }
}

}  // namespace

// The shape cosh (k + l) z of a sum is cosh kz cosh lz + sinh kz sinh lz. In deep water the like form of a difference
// would be the small rest of large terms. So its shape cosh qz/cosh qh is written as (exp -q(h - z) + exp -q(h + z))/(1
// + exp -2qh) with q > 0, and the sums over pairs run through the waves in the order of their wave numbers.
BoundWaves::BoundWaves(std::span<const TravellingWave> waves, double gravity, double depth)
    : depth_(depth), parts_(waves.size()) {
  const auto size = static_cast<Eigen::Index>(waves.size());
  Eigen::MatrixXd sums(size, size);
  Eigen::MatrixXd differences(size, size);
  const auto tail = [&](double k) { return 1.0 + std::exp(-2.0 * k * depth); };
  for (Eigen::Index n = 0; n < size; ++n) {
    const TravellingWave& one = waves[static_cast<std::size_t>(n)];
    wave_number_.push_back(one.wave_number);
    for (Eigen::Index m = 0; m <= n; ++m) {
      TravellingWave other = waves[static_cast<std::size_t>(m)];
      // cosh kh cosh lh/cosh (k + l)h
      const double shapes =
          0.5 * tail(one.wave_number) * tail(other.wave_number) / tail(one.wave_number + other.wave_number);
      // The product of two real parts is half of the real part of the product and of that with the conjugate.
      sums(n, m) = sums(m, n) = 0.5 * shapes * pair_velocity(one, other, 1.0, gravity, depth);
      if (m == n) {
        other.omega *= 1.0 - min_difference;
        other.wave_number = tailwater::wave_number(other.omega, gravity, depth);
      }
      differences(n, m) = differences(m, n) =
          0.5 * pair_velocity(one, other, -1.0, gravity, depth) / tail(one.wave_number - other.wave_number);
    }
  }
  keep_largest(sums, sums_, [&](Eigen::Index n) -> Terms& { return parts_[static_cast<std::size_t>(n)].of_sums; });
  keep_largest(differences, differences_,
               [&](Eigen::Index n) -> Terms& { return parts_[static_cast<std::size_t>(n)].of_differences; });
}

BoundFlow::BoundFlow(const BoundWaves& waves, double height)
    : waves_(waves), below_surface_(waves.depth_ - height), above_bed_image_(waves.depth_ + height) {}

void BoundFlow::add(double cos_theta, double sin_theta, const DepthShape& shape) {
  // Copies, which the compiler keeps apart from the sums: the loops below then run in lanes.
  const BoundWaves::Parts parts = waves_.parts_[next_];
  const std::array shapes{shape.cosh * cos_theta, shape.cosh * sin_theta, shape.sinh * cos_theta,
                          shape.sinh * sin_theta};
  double decay = 1.0;
  double image_decay = 1.0;
  if (next_ > 0) {
    const double step = waves_.wave_number_[next_] - waves_.wave_number_[next_ - 1];
    decay = std::exp(-step * below_surface_);
    image_decay = std::exp(-step * above_bed_image_);
  }
  ++next_;
  for (std::size_t r = 0; r < BoundWaves::terms; ++r) {
    cosh_.real[r] += parts.of_sums[r] * shapes[0];
    cosh_.imag[r] += parts.of_sums[r] * shapes[1];
    sinh_.real[r] += parts.of_sums[r] * shapes[2];
    sinh_.imag[r] += parts.of_sums[r] * shapes[3];
  }
  // exp(i theta) times the conjugate sum of the waves before.
  const auto couple = [&](ComplexTerms& before, double factor, ComplexTerms& pairs) {
    for (std::size_t r = 0; r < BoundWaves::terms; ++r) {
      const double real = parts.of_differences[r] * cos_theta;
      const double imag = parts.of_differences[r] * sin_theta;
      const double a = before.real[r] * factor;
      const double b = before.imag[r] * factor;
      pairs.real[r] += real * a + imag * b;
      pairs.imag[r] += imag * a - real * b;
      before.real[r] = a + real;
      before.imag[r] = b + imag;
    }
  };
  couple(from_surface_, decay, differences_);
  couple(from_image_, image_decay, image_differences_);
}

std::array<double, 2> BoundFlow::velocity() const {
  TAILWATER_ASSERT(next_ == waves_.parts_.size(), "every wave of a field has its bound waves");
  double along = 0.0;
  double upward = 0.0;
  for (std::size_t r = 0; r < BoundWaves::terms; ++r) {
    const double a = cosh_.real[r], b = cosh_.imag[r], c = sinh_.real[r], d = sinh_.imag[r];
    along += waves_.sums_[r] * (a * a - b * b + c * c - d * d);
    upward -= 2.0 * waves_.sums_[r] * (a * d + b * c);
    along += 2.0 * waves_.differences_[r] * (differences_.real[r] + image_differences_.real[r]);
    upward -= 2.0 * waves_.differences_[r] * (differences_.imag[r] - image_differences_.imag[r]);
  }
  return {along, upward};
}

}  // namespace tailwater
