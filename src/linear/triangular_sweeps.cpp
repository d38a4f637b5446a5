#include "linear/triangular_sweeps.h"

namespace tailwater {

void TriangularSweeps::forward(double omega, std::span<const double> b, std::span<double> x) const {
  const LinearSystem::Part before = system_.before();
  for (std::size_t i = 0; i < b.size(); ++i) x[i] = omega * (b[i] + system_.scale(i) * before.sum(i, x.data()));
}

void TriangularSweeps::backward(double omega, std::span<const double> b, std::span<double> x) const {
  const LinearSystem::Part behind = system_.behind();
  for (std::size_t i = b.size(); i-- > 0;) x[i] = omega * (b[i] + system_.scale(i) * behind.sum_back(i, x.data()));
}

void TriangularSweeps::times_lower(double omega, std::span<const double> b, std::span<double> x) const {
  const LinearSystem::Part before = system_.before();
  for (std::size_t i = 0; i < b.size(); ++i) x[i] = b[i] / omega - system_.scale(i) * before.sum(i, b.data());
}

void TriangularSweeps::eisenstat(double omega, std::span<const double> b, std::span<double> x) {
  backward(omega, b, x);
  const double share = 2.0 / omega - 1.0;
  const LinearSystem::Part before = system_.before();
  const LinearSystem::Part ghosts = system_.ghosts();
  const bool has_ghosts = system_.has_ghosts();
  if (has_ghosts) {
    with_ghosts_.assign(x.begin(), x.end());
    system_.exchange(with_ghosts_);
  }
  scratch_.resize(b.size());
  for (std::size_t i = 0; i < b.size(); ++i) {
    double sum = before.sum(i, scratch_.data());
    if (has_ghosts) sum -= ghosts.sum(i, with_ghosts_.data());
    scratch_[i] = omega * (b[i] - share * x[i] + system_.scale(i) * sum);
    x[i] += scratch_[i];
  }
}

}  // namespace tailwater
