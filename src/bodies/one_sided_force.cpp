#include "bodies/one_sided_force.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace tailwater {
namespace {

/// More sweeps are needed only where many points of a body touch at once.
constexpr int max_sweeps = 300;

/// [dx per step]; a sweep that changes speeds by less is the last.
constexpr double settled_displacement = 1e-12;

/// The force required with all other forces unchanged, where a unit of it adds `mobility` to its speed.
double force_wanted(const OneSidedForce& one, double speed, double mobility) {
  if (one.is_rigid()) return one.force - speed / mobility;
  return (one.load + one.damping * (mobility * one.force - speed)) / (1.0 + one.damping * mobility);
}

}  // namespace

// Each sweep updates the forces in turn (projected Gauss-Seidel).
Eigen::VectorXd find_one_sided(std::vector<OneSidedForce>& forces, const Eigen::MatrixXd& inertia, double dt,
                               double spacing, const Eigen::VectorXd& wanted, Eigen::VectorXd& sum) {
  sum.setZero();
  Eigen::VectorXd A = wanted;
  const auto factors = inertia.fullPivLu();
  std::vector<Eigen::VectorXd> answers;
  for (OneSidedForce& one : forces) {
    one.force = 0.0;
    answers.emplace_back(factors.solve(one.direction));
  }
  double largest = std::numeric_limits<double>::infinity();  // change of a speed in a sweep
  for (int sweep = 0; sweep < max_sweeps && largest > settled_displacement * spacing / dt; ++sweep) {
    largest = 0.0;
    for (std::size_t n = 0; n < forces.size(); ++n) {
      OneSidedForce& one = forces[n];
      const double mobility = std::max(0.0, dt * one.direction.dot(answers[n]));
      if (mobility == 0.0 && one.is_rigid()) continue;  // no motion is possible in this direction
      const double change = std::max(0.0, force_wanted(one, one.speed_after(dt, A), mobility)) - one.force;
      if (change == 0.0) continue;
      one.force += change;
      A += change * answers[n];
      sum += change * one.direction;
      largest = std::max(largest, std::abs(change) * mobility);
    }
  }
  return A;
}

}  // namespace tailwater
