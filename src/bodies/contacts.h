// Where a body touches a wall that rests, the wall pushes it with the least force that keeps it from going on into the
// wall, without friction and without throwing it back.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// A degree of freedom of a body.
struct Freedom {
  std::size_t body;
  int entry;  ///< of a Twist
};

/// A point of a body near a wall. Its speed away from the wall is allowed to be no less than -gap/dt.
struct Contact {
  Eigen::VectorXd direction;  ///< of the point away from the wall, per degree of freedom
  double speed;               ///< m/s; away from the wall at the start of the step, and gap/dt
  double force = 0.0;         ///< of the wall

  /// Its speed after dt with the acceleration A, and gap/dt: not below 0.
  double speed_after(double dt, const Eigen::VectorXd& A) const { return speed + dt * direction.dot(A); }
};

template <int Dim>
std::vector<Contact> find_contacts(const Flow<Dim>& flow, const StepStart<Dim>& start, double dt,
                                   std::span<const Freedom> freedoms);

/// The acceleration nearest to `wanted` with which no contact closes further, where `inertia` is the force per
/// acceleration; finds the contacts' forces for it, and in `push` their sums on each degree of freedom.
Eigen::VectorXd admitted(std::vector<Contact>& contacts, const Eigen::MatrixXd& inertia, double dt,
                         const Eigen::VectorXd& wanted, Eigen::VectorXd& push);

}  // namespace tailwater
