#include "linear/orthomin.h"

#include <cmath>
#include <utility>

#include "linear/dot.h"

namespace tailwater {
namespace {

/// So many iterations must halve the residual. A cycle of multigrid takes most of it, so less means that the
/// directions that are kept do not do for this system.
constexpr int patience = 10;

/// Directions that are kept. With two, systems whose first directions make the residual hardly smaller get stuck.
constexpr std::size_t most_kept = 5;

}  // namespace

/// Takes from the direction what it has of those that are kept, so that its image is orthogonal to theirs.
void Orthomin::make_orthogonal(Direction& direction) const {
  std::vector<double> shares;
  for (const Direction& other : kept_) shares.push_back(dot(direction.image, other.image));
  system_.ranks().sum_of_each(shares);
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    const Direction& other = kept_[k];
    const double share = shares[k] / other.square;
    for (std::size_t i = 0; i < direction.image.size(); ++i) {
      direction.step[i] -= share * other.step[i];
      direction.image[i] -= share * other.image[i];
    }
  }
}

KrylovOutcome Orthomin::solve(std::span<double> residual, double target, int most_iterations, std::span<double> x) {
  const Communicator& ranks = system_.ranks();
  const std::size_t size = x.size();
  kept_.clear();
  const auto new_direction = [&] {
    return Direction{.step = std::vector<double>(system_.size_with_ghosts()), .image = std::vector<double>(size)};
  };
  Direction direction = new_direction();
  KrylovOutcome outcome;
  outcome.residual = std::sqrt(ranks.sum(dot(residual, residual)));
  outcome.history.push_back(outcome.residual);
  while (outcome.residual > target && outcome.iterations < most_iterations) {
    multigrid_.apply(residual, std::span(direction.step).first(size));
    system_.multiply(direction.step, direction.image);
    make_orthogonal(direction);
    double square = 0.0;
    double along = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
      square += direction.image[i] * direction.image[i];
      along += direction.image[i] * residual[i];
    }
    ranks.sum_each(square, along);
    direction.square = square;
    outcome.broke_down = !(square > 0.0) || !std::isfinite(along / square);
    if (outcome.broke_down) break;

    const double length = along / square;
    double left = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
      x[i] += length * direction.step[i];
      residual[i] -= length * direction.image[i];
      left += residual[i] * residual[i];
    }
    outcome.residual = std::sqrt(ranks.sum(left));
    outcome.history.push_back(outcome.residual);
    ++outcome.iterations;
    outcome.broke_down = outcome.residual > target && outcome.iterations >= patience &&
                         outcome.residual > 0.5 * outcome.history[outcome.iterations - patience];
    if (outcome.broke_down || outcome.residual <= target) break;

    if (kept_.size() < most_kept) kept_.push_back(new_direction());
    std::swap(direction, kept_[(outcome.iterations - 1) % most_kept]);
  }
  return outcome;
}

}  // namespace tailwater
