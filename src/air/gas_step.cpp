#include "air/gas_step.h"

#include <Eigen/LU>

#include <algorithm>

#include "air/vent.h"

namespace tailwater {
namespace {

/// Newton's method on a convex law. It may at most halve a volume in a step.
constexpr int max_newton_steps = 50;
constexpr double gas_tolerance = 1e-10;  // relative to the atmosphere

/// Weight of the end of a step: of the velocity with which pockets grow, and of the pressure with which a slow
/// pulsation keeps its energy.
constexpr double half = 0.5;

}  // namespace

GasStep::GasStep(const GasLaw& law, const std::vector<AirPocket>& pockets, const std::vector<double>& openings,
                 const std::vector<double>& mobility, const Eigen::MatrixXd& answers, double dt)
    : law_(law), pockets_(pockets), openings_(openings), mobility_(mobility), dt_(dt), answers_(half * dt * answers) {}

void GasStep::set_flow(const std::vector<double>& now, const std::vector<double>& before,
                       const std::vector<double>& walls) {
  const auto count = static_cast<Eigen::Index>(now.size());
  constant_.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    constant_[k] = dt_ * (half * (now[k] + before[k]) + walls[k]);
  }
}

std::vector<double> GasStep::solve() const {
  const Eigen::Index count = constant_.size();
  const Eigen::VectorXd theta = blend();
  Eigen::VectorXd start(count);
  for (Eigen::Index k = 0; k < count; ++k) start[k] = law_.pressure(pockets_[k].gas, pockets_[k].volume);
  Eigen::VectorXd pressure = start;
  for (int step = 0; step < max_newton_steps; ++step) {
    const Eigen::VectorXd volume = volume_after(pressure);
    Eigen::VectorXd missing(count);
    Eigen::MatrixXd slope = Eigen::MatrixXd::Identity(count, count);
    for (Eigen::Index k = 0; k < count; ++k) {
      missing[k] = pressure[k] - (1.0 - theta[k]) * start[k] - theta[k] * pressure_after(k, volume[k]);
      slope.row(k) -= theta[k] * slope_after(k, volume[k]) * answers_.row(k);
    }
    if (missing.cwiseAbs().maxCoeff() <= gas_tolerance * law_.atmosphere) break;
    Eigen::VectorXd change = -slope.partialPivLu().solve(missing);
    while ((volume_after(pressure + change).array() < 0.5 * volume.array()).any()) change *= 0.5;
    pressure += change;
  }
  return {pressure.data(), pressure.data() + count};
}

Eigen::MatrixXd GasStep::stiffness() const {
  const Eigen::VectorXd theta = blend();
  Eigen::MatrixXd rise = Eigen::MatrixXd::Zero(theta.size(), theta.size());
  for (Eigen::Index k = 0; k < theta.size(); ++k) rise(k, k) = -theta[k] * slope_after(k, pockets_[k].volume);
  return (Eigen::MatrixXd::Identity(theta.size(), theta.size()) + rise * answers_).partialPivLu().solve(rise);
}

/// Pa; pressure of the gas at the end of the step, if its volume then is this.
double GasStep::pressure_after(Eigen::Index k, double volume) const {
  return law_.pressure(gas_after_venting(law_, pockets_[k].gas, volume, openings_[k], dt_), volume);
}

double GasStep::slope_after(Eigen::Index k, double volume) const {
  if (openings_[k] == 0.0) return law_.slope(pockets_[k].gas, volume);
  const double little = 1e-6 * volume;
  return (pressure_after(k, volume + little) - pressure_after(k, volume - little)) / (2.0 * little);
}

/// Weight of the pressure at the end of the step: 1/2 + s/(8 + 2s), with s the square of a pulsation's frequency times
/// dt. This damps resolved pulsations by some s^1.5 per period.
Eigen::VectorXd GasStep::blend() const {
  Eigen::VectorXd theta(answers_.rows());
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    const double answer = std::max(0.0, answers_(k, k)) / half + (mobility_.empty() ? 0.0 : dt_ * mobility_[k]);
    const double square = -law_.slope(pockets_[k].gas, pockets_[k].volume) * answer;
    theta[k] = half + half * square / (4.0 + square);
  }
  return theta;
}

/// A pocket that the water would close within the step keeps a tenth of its volume.
Eigen::VectorXd GasStep::volume_after(const Eigen::VectorXd& pressure) const {
  Eigen::VectorXd volume = constant_ + answers_ * pressure;
  for (Eigen::Index k = 0; k < volume.size(); ++k) {
    volume[k] = std::max(pockets_[k].volume + volume[k], 0.1 * pockets_[k].volume);
  }
  return volume;
}

}  // namespace tailwater
