// Forces between bodies, or of the surroundings on them, that act in one sense only: contacts push and lines pull. Each
// acts along a direction and depends on the speed w at which its ends separate along it, at the end of the step,
//
//   f = max(0, load - damping w).
//
// A contact is the limit of infinite damping: 0 <= f, 0 <= w, and one of them is 0.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "flow/flow.h"
#include "motion/floating_body.h"

namespace tailwater {

/// A degree of freedom of a body.
struct Freedom {
  std::size_t body;
  int entry;  ///< index into a Twist
};

struct OneSidedForce {
  Eigen::VectorXd direction;  ///< of the force, per degree of freedom of all bodies
  double speed;               ///< m/s; along the direction, with the velocities of the start of the step
  double damping = std::numeric_limits<double>::infinity();  ///< N s/m
  double load = 0.0;                                         ///< N
  double force = 0.0;                                        ///< N

  bool is_rigid() const { return damping == std::numeric_limits<double>::infinity(); }
  /// Speed [m/s] after dt with the acceleration A.
  double speed_after(double dt, const Eigen::VectorXd& A) const { return speed + dt * direction.dot(A); }
};

/// The entries of a unit force along `direction` at x of body b, per degree of freedom.
template <int Dim>
Eigen::VectorXd on_body(std::span<const Freedom> freedoms, const std::vector<BodyState<Dim>>& bodies, int b,
                        const Vec<Dim>& x, const Vec<Dim>& direction) {
  Eigen::VectorXd entries = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(freedoms.size()));
  if (b < 0) return entries;
  const Turn<Dim> moment = moment_of<Dim>(x - bodies[b].centre, direction);
  for (std::size_t w = 0; w < freedoms.size(); ++w) {
    const auto [body, entry] = freedoms[w];
    if (static_cast<int>(body) != b) continue;
    entries[static_cast<Eigen::Index>(w)] = entry < Dim ? direction[entry] : moment[entry - Dim];
  }
  return entries;
}

/// Computes the forces and returns the acceleration `wanted` corrected by them; `inertia` is the force per
/// acceleration. Sets `sum` to the total on each degree of freedom.
Eigen::VectorXd find_one_sided(std::vector<OneSidedForce>& forces, const Eigen::MatrixXd& inertia, double dt,
                               double spacing, const Eigen::VectorXd& wanted, Eigen::VectorXd& sum);

}  // namespace tailwater
