#include "linear/swept_bicgstab.h"

#include <cmath>

#include "linear/dot.h"

namespace tailwater {
namespace {

/// A residual so many times that of the start will not come down again.
constexpr double explosion = 1e5;

}  // namespace

KrylovOutcome SweptBicgstab::solve(std::span<const double> residual, double target, int most_iterations,
                                   std::span<double> x) {
  const Communicator& ranks = system_.ranks();
  const std::size_t size = x.size();
  first_.resize(size);
  image_.resize(size);
  image_of_residual_.resize(size);
  sweeps_.forward(ssor_factor, residual, first_);
  residual_ = first_;
  direction_ = first_;
  solution_.assign(size, 0.0);

  double square = dot(residual, residual);
  double rho = dot(first_, first_);
  ranks.sum_each(square, rho);
  const double start = std::sqrt(rho);
  double ratio = std::sqrt(square) / start;  // of residuals before and after preconditioning
  KrylovOutcome outcome;
  outcome.residual = std::sqrt(square);
  outcome.history.push_back(outcome.residual);  // the others are estimated from the preconditioned residual

  while (outcome.residual > target && outcome.iterations < most_iterations) {
    sweeps_.eisenstat(ssor_factor, direction_, image_);
    const double alpha = rho / ranks.sum(dot(first_, image_));
    for (std::size_t i = 0; i < size; ++i) residual_[i] -= alpha * image_[i];
    sweeps_.eisenstat(ssor_factor, residual_, image_of_residual_);
    double along = dot(image_of_residual_, residual_);
    double across = dot(image_of_residual_, image_of_residual_);
    ranks.sum_each(along, across);
    const double length = across > 0.0 ? along / across : 0.0;  // 0 only where nothing is left
    double next_rho = 0.0;
    double next_square = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
      solution_[i] += alpha * direction_[i] + length * residual_[i];
      residual_[i] -= length * image_of_residual_[i];
      next_rho += first_[i] * residual_[i];
      next_square += residual_[i] * residual_[i];
    }
    ranks.sum_each(next_rho, next_square);
    ++outcome.iterations;

    const double norm = std::sqrt(next_square);
    outcome.broke_down = !(norm <= explosion * start);
    if (outcome.broke_down) break;
    outcome.residual = ratio * norm;
    if (outcome.residual <= target && norm > 0.0) {
      sweeps_.times_lower(ssor_factor, residual_, image_of_residual_);
      outcome.residual = std::sqrt(ranks.sum(dot(image_of_residual_, image_of_residual_)));
      ratio = outcome.residual / norm;
    }
    outcome.history.push_back(outcome.residual);
    if (outcome.residual <= target) break;

    const double beta = next_rho / rho * alpha / length;
    outcome.broke_down = !std::isfinite(beta) || next_rho == 0.0;
    if (outcome.broke_down) break;
    rho = next_rho;
    for (std::size_t i = 0; i < size; ++i) {
      direction_[i] = residual_[i] + beta * (direction_[i] - length * image_[i]);
    }
  }
  if (!outcome.broke_down) {
    sweeps_.backward(ssor_factor, solution_, image_);
    for (std::size_t i = 0; i < size; ++i) x[i] += image_[i];
  }
  return outcome;
}

}  // namespace tailwater
