#include "linear/orthomin.h"

#include <cmath>
#include <utility>

#include "linear/dot.h"

namespace tailwater {
namespace {

/// Iterations within which the residual must halve. A cycle of multigrid removes most of the residual, so slower
/// progress means that the stored directions do not suit this system.
constexpr int patience = 10;

/// Number of stored directions. With two, systems whose first directions hardly reduce the residual stagnate.
constexpr std::size_t max_kept = 5;

struct Direction {
  std::vector<double> step;   ///< ghosts stand behind the rows
  std::vector<double> image;  ///< A step
  double square = 0.0;        ///< square of the image's norm
};

/// The stored directions, in no order.
using Directions = std::vector<Direction>;

/// Subtracts from the direction its parts along the stored ones, so that its image is orthogonal to theirs.
void make_orthogonal(Direction& direction, const Directions& kept, const Communicator& ranks) {
  std::vector<double> shares;
  for (const Direction& other : kept) shares.push_back(dot(direction.image, other.image));
  ranks.sum_of_each(shares);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const Direction& other = kept[k];
    const double share = shares[k] / other.square;
    for (std::size_t i = 0; i < direction.image.size(); ++i) {
      direction.step[i] -= share * other.step[i];
      direction.image[i] -= share * other.image[i];
    }
  }
}

/// The step length along the direction. Also sets the square of the direction.
double best_length(Direction& direction, std::span<const double> residual, const Communicator& ranks) {
  double square = 0.0;
  double along = 0.0;
  for (std::size_t i = 0; i < residual.size(); ++i) {
    square += direction.image[i] * direction.image[i];
    along += direction.image[i] * residual[i];
  }
  ranks.sum_each(square, along);
  direction.square = square;
  return along / square;
}

/// Moves x along the direction. Returns the norm of the new residual.
double go(const Direction& direction, double length, Iterate& iterate, const Communicator& ranks) {
  double left = 0.0;
  for (std::size_t i = 0; i < iterate.x.size(); ++i) {
    iterate.x[i] += length * direction.step[i];
    iterate.residual[i] -= length * direction.image[i];
    left += iterate.residual[i] * iterate.residual[i];
  }
  return std::sqrt(ranks.sum(left));
}

/// Whether the last iterations have not halved the residual.
bool is_stuck(const std::vector<double>& history) {
  const std::size_t last = history.size() - 1;
  return last >= patience && history[last] > 0.5 * history[last - patience];
}

}  // namespace

MethodOutcome Orthomin::improve(const LinearSystem& system, const Goal& goal, Iterate& iterate) {
  const Communicator& ranks = system.ranks();
  const auto new_direction = [&] {
    return Direction{.step = std::vector<double>(system.size_with_ghosts()),
                     .image = std::vector<double>(system.size())};
  };
  Directions kept;
  Direction direction = new_direction();
  MethodOutcome outcome{.reason = "Orthomin was still on its way"};
  double residual = std::sqrt(ranks.sum(dot(iterate.residual, iterate.residual)));
  outcome.history.push_back(residual);
  while (residual > goal.residual && outcome.iterations < goal.iterations) {
    multigrid_.get().apply(iterate.residual, std::span(direction.step).first(system.size()));
    system.multiply(direction.step, direction.image);
    make_orthogonal(direction, kept, ranks);
    const double length = best_length(direction, iterate.residual, ranks);
    const bool is_lost = !(direction.square > 0.0) || !std::isfinite(length);
    if (is_lost) return outcome.break_down("Orthomin found no direction");
    residual = go(direction, length, iterate, ranks);
    outcome.history.push_back(residual);
    ++outcome.iterations;
    if (residual <= goal.residual) break;
    if (is_stuck(outcome.history)) return outcome.break_down("Orthomin got stuck");
    if (kept.size() < max_kept) kept.push_back(new_direction());
    std::swap(direction, kept[(outcome.iterations - 1) % max_kept]);
  }
  outcome.residual = residual;
  if (residual <= goal.residual) outcome.end = MethodOutcome::End::converged;
  return outcome;
}

}  // namespace tailwater
