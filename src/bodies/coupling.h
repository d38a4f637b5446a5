// Coupling of floating bodies and pressure. The pressure depends on the acceleration of the bodies, which accelerate
// the water beside them, and this acceleration depends on the pressure:
//
//   M A = F(p) + loads,    p = p(A)
//
// Every step solves for both together. p(A) is the solution of the pressure equation with the walls' acceleration in
// the rows of their particles. F(p) is the reaction to the pair forces on the water, so that water and bodies conserve
// momentum together. With F at the last A instead, every body lighter than its added mass would be unstable.
//
// The iteration is Newton's method. The derivative of M A - F(p(A)) is mass plus added mass. It is measured once and
// then updated by Broyden's (1965) method from step to step, with about two solves per step. Beside pockets of air,
// each pass computes their pressures for the motion of that pass; the contribution of the gas to the derivative is
// known.
#pragma once

#include <Eigen/Core>

#include <limits>
#include <vector>

#include "air/enclosed_air.h"
#include "bodies/forces.h"
#include "bodies/one_sided_force.h"
#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// The bodies and the pressure of one step.
template <int Dim>
class BodyCoupling final : public CoupledUnknowns {
 public:
  /// Couples the bodies to the equation in the flow's rows. Changes nothing.
  BodyCoupling(Flow<Dim>& flow, FloatingBodies<Dim>& bodies, const PosedEquation& equation, WallDrive<Dim>& drive);

  /// Makes the water in narrow gaps stagnant, and computes the compliance of the bodies for the pockets of air. Call
  /// first.
  void begin();
  /// Solves the pressure equation to `tolerance`, and corrects the motion at least once. `drive` follows the bodies.
  SolveReport solve_roughly(double tolerance) override;
  SolveReport solve(double tolerance) override;
  /// Carries impulses that have not moved the bodies yet over to the next step, so that momentum is conserved.
  void finish() override;

 private:
  /// A motion, the pressure computed with it, and their residual.
  struct Iterate {
    Eigen::VectorXd A, push;
    std::vector<double> pressure;
    double missing = std::numeric_limits<double>::infinity();  ///< size of the residual
    double largest_force = 0.0;
  };

  Eigen::VectorXd acceleration() const;
  void accelerate(const Eigen::VectorXd& A);
  SolveReport solve_once(double tolerance);
  /// Performs one step of Newton's method from the residual `g`, and updates `g`.
  void correct(Eigen::VectorXd& g, double tolerance, SolveReport& report);
  /// M A - F(p) - loads - forces of contacts and lines. Also sets the size of the largest force.
  Eigen::VectorXd residual();
  void go_back_to(const Iterate& iterate);
  [[noreturn]] void fail(int passes) const;
  double size(const Eigen::VectorXd& force) const;
  void measure_inertia(const Eigen::VectorXd& g, double tolerance, SolveReport& report);
  Eigen::Map<Eigen::MatrixXd> inertia();
  Eigen::VectorXd on_freedoms(const std::vector<Twist<Dim>>& forces) const;
  std::vector<Twist<Dim>> forces_of(std::vector<double> pressure, const std::vector<double>& air) const;
  void report_forces(const std::vector<Twist<Dim>>& forces);
  void add_air_stiffness();
  void remove_net_air_force();

  Flow<Dim>& flow_;
  FloatingBodies<Dim>& bodies_;
  EnclosedAir<Dim>& enclosed_air_;
  double fullness_;  ///< fullness of the equation (pressure/full_water.h)
  double dt_;
  WallDrive<Dim>& drive_;
  ForcesOnBodies<Dim> forces_;
  NarrowGaps<Dim> gaps_;
  std::vector<Freedom> freedoms_;
  Eigen::VectorXd scale_;                ///< mass or moment of inertia of each degree of freedom
  std::vector<Twist<Dim>> loads_;        ///< on each body, without pressure, contacts and lines; the same in all passes
  std::vector<Twist<Dim>> damping_;      ///< force of the dampers of each body over its velocity at the end of the step
  std::vector<Twist<Dim>> last_forces_;  ///< of the pressure on each body, in the last residual
  std::vector<OneSidedForce> one_sided_;  ///< contacts and lines
  std::vector<double> allowed_tension_;   ///< Pa; of all particles (pressure/tension.h)
  Eigen::VectorXd push_;                  ///< sum of `one_sided_` on each degree of freedom
  Eigen::MatrixXd air_;                   ///< force per acceleration that the air of pockets adds to the inertia
  double largest_force_ = 0.0;            ///< size of the largest force in the last residual
};

}  // namespace tailwater
