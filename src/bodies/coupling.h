// Bodies that float. The pressure depends on how they are accelerated, since the water beside them goes with them, and
// their acceleration on the pressure:
//
//   M A = F(p) + loads,    p = p(A)
//
// Both are solved for together in every step. p(A) is the pressure equation with the walls' acceleration in the rows of
// their particles; F(p) is the reaction of the water's pair forces, so that water and bodies keep their momentum
// together. Taking F at the last A instead would blow up for every body lighter than the water that goes with it. The
// iteration is Newton's, with the derivative of M A - F(p(A)), which is mass and added mass, measured once and then
// kept up to date by Broyden's (1965) updates, from step to step: some two solves in a step. Beside pockets of air the
// pressures of these are found in each pass, with the motion of that pass; what the gas adds to the derivative is
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
  /// Of an equation that stands in the flow's rows. Changes nothing.
  BodyCoupling(Flow<Dim>& flow, FloatingBodies<Dim>& bodies, const PosedEquation& equation, WallDrive<Dim>& drive);

  /// Makes the water in narrow gaps stagnant, and tells the pockets of air how bodies give way to them. Call first.
  void begin();
  /// Solves the pressure equation to `tolerance`, and corrects the motion once. `drive` follows.
  SolveReport solve_roughly(double tolerance) override;
  SolveReport solve(double tolerance) override;
  /// What the pressure has not moved yet is carried over to the next step, so that no momentum is lost.
  void finish() override;

 private:
  /// A motion, what was found with it, and how far they agree.
  struct Iterate {
    Eigen::VectorXd A, push;
    std::vector<double> pressure;
    double missing = std::numeric_limits<double>::infinity();  ///< size of the residual
    double largest_force = 0.0;
  };

  Eigen::VectorXd acceleration() const;
  void accelerate(const Eigen::VectorXd& A);
  SolveReport solve_once(double tolerance);
  /// Takes one step of Newton's method from the residual `g`, and updates it.
  void correct(Eigen::VectorXd& g, double tolerance, SolveReport& report);
  /// M A - F(p) - loads - push of contacts and lines, and the size of the forces in it.
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
  double fullness_;  ///< that of the equation (pressure/full_water.h)
  double dt_;
  WallDrive<Dim>& drive_;
  ForcesOnBodies<Dim> forces_;
  NarrowGaps<Dim> gaps_;
  std::vector<Freedom> freedoms_;
  Eigen::VectorXd scale_;                ///< mass or moment of inertia of each degree of freedom
  std::vector<Twist<Dim>> loads_;        ///< on each body: all but pressure, contacts and lines; the same in all passes
  std::vector<Twist<Dim>> last_forces_;  ///< of the pressure on each body, in the last residual
  std::vector<OneSidedForce> one_sided_;  ///< contacts and lines
  std::vector<double> allowed_tension_;   ///< Pa; of all particles (pressure/tension.h)
  Eigen::VectorXd push_;                  ///< their sum, on each degree of freedom
  Eigen::MatrixXd air_;                   ///< force per acceleration that the air of pockets adds to the inertia
  double largest_force_ = 0.0;            ///< size of the largest force in the last residual
};

}  // namespace tailwater
