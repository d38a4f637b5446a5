// The gas of all pockets in one step: the growth of each pocket as a function of the pressures, and the pressures that
// satisfy the gas law.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "air/pockets.h"

namespace tailwater {

class GasStep {
 public:
  /// The growth of the pockets depends linearly on the pressures. `answers` [m^Dim/s per Pa] is the growth of each
  /// (row) through water by the pressure of each; `mobility` is that through floating bodies by the own pressure, empty
  /// without bodies. All are kept by reference.
  GasStep(const GasLaw& law, const std::vector<AirPocket>& pockets, const std::vector<double>& openings,
          const std::vector<double>& mobility, const Eigen::MatrixXd& answers, double dt);

  /// The flow [m^Dim/s] without pressure in the pockets, that at the start of the step, and that by walls.
  void set_flow(const std::vector<double>& now, const std::vector<double>& before, const std::vector<double>& walls);

  /// The pressures [Pa] that satisfy the equations of gas and water. Pockets grow with the mean of the water's
  /// velocities at both ends of the step. The mean of the gas's pressures at both ends therefore does as much work on
  /// the water as the gas loses. The stiffer the gas, the nearer the pressure is to that at the end.
  std::vector<double> solve() const;

  /// The decrease [Pa] of the pressures (rows) per m^Dim that walls leave to the pockets (columns) in the step.
  Eigen::MatrixXd stiffness() const;

 private:
  double pressure_after(Eigen::Index k, double volume) const;
  double slope_after(Eigen::Index k, double volume) const;
  Eigen::VectorXd blend() const;
  Eigen::VectorXd volume_after(const Eigen::VectorXd& pressure) const;

  const GasLaw& law_;
  const std::vector<AirPocket>& pockets_;
  const std::vector<double>& openings_;
  const std::vector<double>& mobility_;
  double dt_;
  Eigen::MatrixXd answers_;
  Eigen::VectorXd constant_;
};

}  // namespace tailwater
