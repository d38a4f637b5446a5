#include "linear/triangular_sweeps.h"

#include <algorithm>

namespace tailwater {

void RowParts::follow(const LinearSystem& system) {
  if (pattern_number == system.pattern_number()) return;
  pattern_number = system.pattern_number();
  behind_begin.resize(system.size());
  ghosts_begin.resize(system.size());
  const LinearSystem::Part row = system.whole();
  for (std::size_t i = 0; i < system.size(); ++i) {
    const auto first_from = [&](std::size_t unknown) {
      const auto is_below = [unknown](std::int32_t j) { return static_cast<std::size_t>(j) < unknown; };
      const auto* first = std::partition_point(row.column + row.begin[i], row.column + row.end[i], is_below);
      return static_cast<std::uint32_t>(first - row.column);
    };
    behind_begin[i] = first_from(i);
    ghosts_begin[i] = first_from(system.size());
  }
}

void TriangularSweeps::forward(double omega, std::span<const double> b, std::span<double> x) const {
  for (std::size_t i = 0; i < b.size(); ++i) x[i] = omega * (b[i] + system_.scale(i) * before_.sum(i, x.data()));
}

void TriangularSweeps::backward(double omega, std::span<const double> b, std::span<double> x) const {
  for (std::size_t i = b.size(); i-- > 0;) x[i] = omega * (b[i] + system_.scale(i) * behind_.sum_back(i, x.data()));
}

void TriangularSweeps::times_lower(double omega, std::span<const double> b, std::span<double> x) const {
  for (std::size_t i = 0; i < b.size(); ++i) x[i] = b[i] / omega - system_.scale(i) * before_.sum(i, b.data());
}

void TriangularSweeps::eisenstat(double omega, std::span<const double> b, std::span<double> x) {
  backward(omega, b, x);
  const double share = 2.0 / omega - 1.0;
  const bool has_ghosts = system_.has_ghosts();
  if (has_ghosts) {
    with_ghosts_.assign(x.begin(), x.end());
    system_.exchange(with_ghosts_);
  }
  scratch_.resize(b.size());
  for (std::size_t i = 0; i < b.size(); ++i) {
    double sum = before_.sum(i, scratch_.data());
    if (has_ghosts) sum -= ghosts_.sum(i, with_ghosts_.data());
    scratch_[i] = omega * (b[i] - share * x[i] + system_.scale(i) * sum);
    x[i] += scratch_[i];
  }
}

}  // namespace tailwater
