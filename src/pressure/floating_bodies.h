// Bodies that float. The pressure depends on how they are accelerated, since the water beside them goes with them, and
// their acceleration on the pressure:
//
//   M A = F(p) + loads,    p = p(A)
//
// Both are solved for together in every step. p(A) is the pressure equation with the walls' acceleration in the rows of
// their particles; F(p) is the reaction of the water's pair forces, so that water and bodies keep their momentum
// together. Taking F at the last A instead would blow up for every body lighter than the water that goes with it. The
// iteration is Newton's, with the derivative of M A - F(p(A)), which is mass and added mass, measured once and then
// kept up to date by Broyden's (1965) updates, from step to step: some two solves in a step.
//
// Where a body touches a wall that rests, the wall pushes it with the least force that keeps it from going on into the
// wall, without friction and without throwing it back.
#pragma once

#include <vector>

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// Forces and moments on each body by a pressure field [Pa] that is up to date on ghosts, at `time` [s], where the
/// walls are. Collective.
template <int Dim>
std::vector<Twist<Dim>> forces_on_bodies(const Flow<Dim>& flow, const std::vector<double>& pressure, double time);

/// Sets out from the acceleration of the last step. Call at the start of a step.
template <int Dim>
void steer_bodies(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// Adds the forces of `field` during dt to what the bodies have yet to answer.
template <int Dim>
void owe_to_bodies(Flow<Dim>& flow, const std::vector<Twist<Dim>>& forces, double dt);

/// What the last guard took from the water in front of bodies in this step of dt. Collective.
template <int Dim>
void owe_to_bodies_for_put_back(Flow<Dim>& flow, double dt);

/// The bodies and the pressure of one step.
template <int Dim>
class BodyCoupling {
 public:
  BodyCoupling(Flow<Dim>& flow, const StepStart<Dim>& start, double dt, WallDrive<Dim>& drive);

  /// Solves the pressure equation to `tolerance`, and corrects the motion once. `drive` follows.
  SolveReport solve_roughly(double tolerance);
  /// The same until pressure and motion agree.
  SolveReport solve(double tolerance);

  /// What the pressure has not moved yet is carried over to the next step, so that no momentum is lost. Call when the
  /// pressure is final.
  void carry_over();

 private:
  Eigen::VectorXd acceleration() const;
  void accelerate(const Eigen::VectorXd& A);
  SolveReport solve_once(double tolerance);
  /// Takes one step of Newton's method from the residual `g`, and updates it.
  void correct(Eigen::VectorXd& g, double tolerance, SolveReport& report);
  /// M A - F(p) - loads - push of the free ways, and the size of the forces in it.
  Eigen::VectorXd residual();
  double size(const Eigen::VectorXd& force) const;
  void find_contacts();
  /// The acceleration nearest to `wanted` that takes no body into a wall; finds the walls' push for it.
  Eigen::VectorXd admitted(const Eigen::VectorXd& wanted);
  void measure_inertia(const Eigen::VectorXd& g, double tolerance, SolveReport& report);
  Eigen::Map<Eigen::MatrixXd> inertia();

  struct Way {
    std::size_t body;
    int entry;  ///< of a Twist
  };

  /// A point of a body near a wall. Its speed away from the wall is allowed to be no less than -gap/dt.
  struct Contact {
    Eigen::VectorXd way;  ///< of the point away from the wall, per free way
    double speed;         ///< m/s; away from the wall at the start of the step, and gap/dt
    double force = 0.0;   ///< of the wall
  };

  Flow<Dim>& flow_;
  const StepStart<Dim>& start_;
  double dt_;
  WallDrive<Dim>& drive_;
  std::vector<Way> ways_;
  Eigen::VectorXd scale_;  ///< mass or moment of inertia of each way
  std::vector<Contact> contacts_;
  Eigen::VectorXd push_;  ///< of the walls, on each way
  double forces_ = 0.0;   ///< size of the largest force in the last residual
};

}  // namespace tailwater
