#include "linear/bicgstab.h"

#include <cmath>

#include "linear/dot.h"

namespace tailwater {
namespace {

/// Factor of growth of the residual above which the method is considered to have failed.
constexpr double explosion = 1e5;

/// BiCGStab for the change y of the preconditioned system (D + L)^-1 A (D + U)^-1 y = (D + L)^-1 (b - A x).
class Recurrence {
 public:
  Recurrence(const LinearSystem& system, const RowParts& parts, std::span<const double> residual_of_x)
      : ranks_(system.ranks()),
        sweeps_(system, parts),
        first_(residual_of_x.size()),
        image_(residual_of_x.size()),
        image_of_residual_(residual_of_x.size()),
        y_(residual_of_x.size(), 0.0) {
    sweeps_.forward(ssor_factor, residual_of_x, first_);
    residual_ = first_;
    direction_ = first_;
    double square = dot(residual_of_x, residual_of_x);
    rho_ = dot(first_, first_);
    ranks_.sum_each(square, rho_);
    start_ = norm_ = std::sqrt(rho_);
    true_norm_ = std::sqrt(square);
    ratio_ = true_norm_ / start_;
  }

  /// |b - A x|: exact at the start and where the tolerance is met; in between estimated from the preconditioned
  /// residual.
  double residual() const { return true_norm_; }
  bool exploded() const { return !(norm_ <= explosion * start_); }

  /// One iteration up to the new y and its residual.
  void step() {
    sweeps_.eisenstat(ssor_factor, direction_, image_);
    const double alpha = rho_ / ranks_.sum(dot(first_, image_));
    for (std::size_t i = 0; i < y_.size(); ++i) residual_[i] -= alpha * image_[i];
    sweeps_.eisenstat(ssor_factor, residual_, image_of_residual_);
    double along = dot(image_of_residual_, residual_);
    double across = dot(image_of_residual_, image_of_residual_);
    ranks_.sum_each(along, across);
    const double omega = across > 0.0 ? along / across : 0.0;  // 0 only where the residual is 0
    double rho = 0.0;
    double square = 0.0;
    for (std::size_t i = 0; i < y_.size(); ++i) {
      y_[i] += alpha * direction_[i] + omega * residual_[i];
      residual_[i] -= omega * image_of_residual_[i];
      rho += first_[i] * residual_[i];
      square += residual_[i] * residual_[i];
    }
    ranks_.sum_each(rho, square);
    norm_ = std::sqrt(square);
    beta_ = rho / rho_ * alpha / omega;
    omega_ = omega;
    rho_ = rho;
  }

  /// Computes |b - A x| of the new y: exactly where the estimate meets the goal.
  void measure(double goal) {
    true_norm_ = ratio_ * norm_;
    if (true_norm_ > goal || norm_ == 0.0) return;
    sweeps_.times_lower(ssor_factor, residual_, image_of_residual_);
    true_norm_ = std::sqrt(ranks_.sum(dot(image_of_residual_, image_of_residual_)));
    ratio_ = true_norm_ / norm_;
  }

  bool can_turn() const { return std::isfinite(beta_) && rho_ != 0.0; }

  /// Computes the next direction.
  void turn() {
    const double beta = beta_;
    const double omega = omega_;
    for (std::size_t i = 0; i < y_.size(); ++i) {
      direction_[i] = residual_[i] + beta * (direction_[i] - omega * image_[i]);
    }
  }

  /// x + (D + U)^-1 y.
  void add_to(std::span<double> x) {
    sweeps_.backward(ssor_factor, y_, image_);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += image_[i];
  }

 private:
  Communicator ranks_;
  TriangularSweeps sweeps_;
  std::vector<double> first_;              ///< residual at the start
  std::vector<double> residual_;           ///< r
  std::vector<double> direction_;          ///< p
  std::vector<double> image_;              ///< v, image of p
  std::vector<double> image_of_residual_;  ///< t
  std::vector<double> y_;
  double rho_ = 0.0;
  double beta_ = 0.0;
  double omega_ = 0.0;
  double start_ = 0.0;      ///< norm of the preconditioned residual at the start
  double norm_ = 0.0;       ///< present norm of the preconditioned residual
  double true_norm_ = 0.0;  ///< norm of b - A x
  double ratio_ = 0.0;      ///< ratio of the two norms, when both were last computed
};

}  // namespace

MethodOutcome Bicgstab::improve(const LinearSystem& system, const Goal& goal, Iterate& iterate) {
  Recurrence recurrence(system, parts_, iterate.residual);
  MethodOutcome outcome{.reason = "BiCGStab was still on its way"};
  outcome.history.push_back(recurrence.residual());
  while (recurrence.residual() > goal.residual && outcome.iterations < goal.iterations) {
    recurrence.step();
    ++outcome.iterations;
    if (recurrence.exploded()) return outcome.break_down("the residual of BiCGStab exploded");
    recurrence.measure(goal.residual);
    outcome.history.push_back(recurrence.residual());
    if (recurrence.residual() <= goal.residual) break;
    if (!recurrence.can_turn()) return outcome.break_down("BiCGStab divided by 0");
    recurrence.turn();
  }
  recurrence.add_to(iterate.x);
  outcome.residual = recurrence.residual();
  if (recurrence.residual() <= goal.residual) outcome.end = MethodOutcome::End::converged;
  return outcome;
}

}  // namespace tailwater
