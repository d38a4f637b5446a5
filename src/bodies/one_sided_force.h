// Forces between bodies, or of the surroundings on them, that only push or only pull: contacts and lines. Each acts
// along a direction and answers the speed w of its ends apart from each other along it, at the end of the step,
//
//   f = max(0, load - damping w)
//
// A contact is the limit of infinite damping: 0 <= f, 0 <= w, and one of them is 0.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "flow/flow.h"

namespace tailwater {

/// A degree of freedom of a body.
struct Freedom {
  std::size_t body;
  int entry;  ///< of a Twist
};

struct OneSidedForce {
  Eigen::VectorXd direction;  ///< of the force, per degree of freedom of all bodies
  double speed;               ///< m/s; along the direction, with the velocities of the start of the step
  double damping = std::numeric_limits<double>::infinity();  ///< N s/m
  double load = 0.0;                                         ///< N
  double force = 0.0;                                        ///< N

  bool is_rigid() const { return damping == std::numeric_limits<double>::infinity(); }
  /// After dt with the acceleration A.
  double speed_after(double dt, const Eigen::VectorXd& A) const { return speed + dt * direction.dot(A); }
};

/// What a unit force along `direction` at x of body b is, per degree of freedom.
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

/// The acceleration that `wanted` becomes with these forces, which are found with it; `inertia` is the force per
/// acceleration. Fills `sum`, of the forces on each degree of freedom.
Eigen::VectorXd find_one_sided(std::vector<OneSidedForce>& forces, const Eigen::MatrixXd& inertia, double dt,
                               double spacing, const Eigen::VectorXd& wanted, Eigen::VectorXd& sum);

}  // namespace tailwater
