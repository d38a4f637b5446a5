#include "motion/regular_wave.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "motion/wave_theory.h"

namespace tailwater {
namespace {

/// Harmonics of the series. 24 represent waves of half of the breaking height down to kh = 0.3 within 1e-4 of the
/// height.
constexpr int harmonics = 24;

/// Heights from 0 to the target, each from the solutions for the two before it.
constexpr int height_steps = 12;

constexpr int newton_steps = 30;

/// [omega H]; a series with a larger residual is too short for its wave, which is about to break.
constexpr double largest_residual = 0.02;

/// Relative change of the unknowns at which Newton's method has converged.
constexpr double newton_tolerance = 1e-12;

/// Unknowns in units of depth and gravity: where they stand in the vector.
struct Places {
  static constexpr int wave_number = 0;
  static constexpr int mean_speed = 1;  ///< of the water below the troughs, against the wave, as seen from the wave
  static constexpr int discharge = 2;   ///< as seen from the wave
  static constexpr int bernoulli = 3;
  static constexpr int celerity = 4;
  static constexpr int levels = 5;                       ///< heights of the surface above the bed, from crest to trough
  static constexpr int series = levels + harmonics + 1;  ///< of the stream function
  static constexpr int count = series + harmonics;
};

/// A request in units of depth and gravity.
struct Problem {
  double height, period, transport;
};

/// The stream function and the velocity relative to the wave at a point.
struct RelativeFlow {
  double stream_function, u, w;
};

RelativeFlow flow_at(const Eigen::VectorXd& unknowns, double phase, double level) {
  const double k = unknowns[Places::wave_number];
  const double speed = unknowns[Places::mean_speed];
  RelativeFlow flow{-speed * level, -speed, 0.0};
  for (int j = 1; j <= harmonics; ++j) {
    const double b = unknowns[Places::series + j - 1];
    const DepthShape shape(j * k, level, 1.0);
    flow.stream_function += b * shape.sinh * std::cos(j * phase);
    flow.u += j * k * b * shape.cosh * std::cos(j * phase);
    flow.w += j * k * b * shape.sinh * std::sin(j * phase);
  }
  return flow;
}

Eigen::VectorXd residuals(const Eigen::VectorXd& unknowns, const Problem& problem) {
  Eigen::VectorXd left(Places::count);
  double mean = 0.0;
  for (int m = 0; m <= harmonics; ++m) {
    const double level = unknowns[Places::levels + m];
    const RelativeFlow flow = flow_at(unknowns, m * std::numbers::pi / harmonics, level);
    left[m] = flow.stream_function + unknowns[Places::discharge];
    left[harmonics + 1 + m] = 0.5 * (flow.u * flow.u + flow.w * flow.w) + level - unknowns[Places::bernoulli];
    mean += (m == 0 || m == harmonics ? 0.5 : 1.0) * level / harmonics;
  }
  const int next = 2 * (harmonics + 1);
  left[next] = mean - 1.0;
  left[next + 1] = unknowns[Places::levels] - unknowns[Places::levels + harmonics] - problem.height;
  left[next + 2] = unknowns[Places::wave_number] * unknowns[Places::celerity] * problem.period - 2.0 * std::numbers::pi;
  left[next + 3] = unknowns[Places::celerity] - unknowns[Places::discharge] - problem.transport;
  return left;
}

Eigen::MatrixXd jacobian(const Eigen::VectorXd& unknowns, const Problem& problem) {
  constexpr double step = 1e-6;
  Eigen::MatrixXd slopes(Places::count, Places::count);
  Eigen::VectorXd moved = unknowns;
  for (int j = 0; j < Places::count; ++j) {
    moved[j] = unknowns[j] + step;
    const Eigen::VectorXd above = residuals(moved, problem);
    moved[j] = unknowns[j] - step;
    slopes.col(j) = (above - residuals(moved, problem)) / (2.0 * step);
    moved[j] = unknowns[j];
  }
  return slopes;
}

/// Whether unknowns are near enough to a wave that hyperbolic functions of them do not overflow.
bool is_sensible(const Eigen::VectorXd& unknowns, const Problem& problem, double linear_wave_number) {
  const double k = unknowns[Places::wave_number] / linear_wave_number;
  return unknowns.allFinite() && k > 0.2 && k < 3.0 &&
         (unknowns.segment(Places::levels, harmonics + 1).array() - 1.0).abs().maxCoeff() < 2.0 * problem.height;
}

/// Newton's method; false if it does not converge.
bool converge(Eigen::VectorXd& unknowns, const Problem& problem) {
  const double linear = wave_number(2.0 * std::numbers::pi / problem.period, 1.0, 1.0);
  for (int iteration = 0; iteration < newton_steps; ++iteration) {
    const Eigen::VectorXd change = jacobian(unknowns, problem).partialPivLu().solve(residuals(unknowns, problem));
    unknowns -= change;
    if (!is_sensible(unknowns, problem, linear)) return false;
    if (change.norm() <= newton_tolerance * unknowns.norm()) return true;
  }
  return false;
}

/// The wave of linear theory.
Eigen::VectorXd linear_wave(const Problem& problem) {
  const double k = wave_number(2.0 * std::numbers::pi / problem.period, 1.0, 1.0);
  const double c = 2.0 * std::numbers::pi / (k * problem.period);
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(Places::count);
  unknowns[Places::wave_number] = k;
  unknowns[Places::mean_speed] = unknowns[Places::discharge] = unknowns[Places::celerity] = c;
  unknowns[Places::bernoulli] = 1.0 + 0.5 * c * c;
  for (int m = 0; m <= harmonics; ++m) {
    unknowns[Places::levels + m] = 1.0 + 0.5 * problem.height * std::cos(m * std::numbers::pi / harmonics);
  }
  // Bernoulli to first order: c u = eta on the surface.
  unknowns[Places::series] = 0.5 * problem.height / (k * c);
  return unknowns;
}

}  // namespace

std::optional<RegularWave> RegularWave::solve(const RegularWaveRequest& request) {
  const double speed_unit = std::sqrt(request.gravity * request.depth);
  const double h = request.depth;
  if (request.height > breaking_height(2.0 * std::numbers::pi / request.period, request.gravity, h))
    return std::nullopt;
  Problem problem{0.0, request.period * speed_unit / h, request.transport / speed_unit};
  Eigen::VectorXd unknowns, before;
  for (int step = 1; step <= height_steps; ++step) {
    problem.height = step * request.height / (h * height_steps);
    Eigen::VectorXd guess = step == 1   ? linear_wave(problem)
                            : step == 2 ? unknowns
                                        : Eigen::VectorXd(2.0 * unknowns - before);
    if (!converge(guess, problem)) return std::nullopt;
    before = unknowns;
    unknowns = guess;
  }
  RegularWave wave;
  wave.depth_ = h;
  wave.gravity_ = request.gravity;
  wave.wave_number_ = unknowns[Places::wave_number] / h;
  wave.celerity_ = unknowns[Places::celerity] * speed_unit;
  wave.mean_velocity_ = (unknowns[Places::celerity] - unknowns[Places::mean_speed]) * speed_unit;
  wave.bernoulli_ = unknowns[Places::bernoulli] * request.gravity * h;
  for (int j = 0; j <= harmonics; ++j) {
    double sum = 0.0;
    for (int m = 0; m <= harmonics; ++m) {
      const double share = m == 0 || m == harmonics ? 0.5 : 1.0;
      sum += share * (unknowns[Places::levels + m] - 1.0) * std::cos(j * m * std::numbers::pi / harmonics);
    }
    wave.elevations_.push_back((j == 0 || j == harmonics ? 1.0 : 2.0) / harmonics * sum * h);
    if (j > 0) {
      const double b = unknowns[Places::series + j - 1];
      wave.velocities_.push_back(j * unknowns[Places::wave_number] * b * speed_unit);
    }
  }
  if (wave.residual() > largest_residual * request.height * 2.0 * std::numbers::pi / request.period)
    return std::nullopt;
  return wave;
}

double RegularWave::elevation(double phase) const {
  double sum = 0.0;
  for (std::size_t j = 0; j < elevations_.size(); ++j) sum += elevations_[j] * std::cos(static_cast<double>(j) * phase);
  return sum;
}

Eigen::Vector2d RegularWave::velocity(double phase, double height) const {
  Eigen::Vector2d sum(mean_velocity_, 0.0);
  for (std::size_t j = 1; j <= velocities_.size(); ++j) {
    const double n = static_cast<double>(j);
    const DepthShape shape(n * wave_number_, height, depth_);
    sum += velocities_[j - 1] * Eigen::Vector2d(shape.cosh * std::cos(n * phase), shape.sinh * std::sin(n * phase));
  }
  return sum;
}

double RegularWave::residual() const {
  double sum = 0.0;
  for (int m = 0; m < harmonics; ++m) {
    const double phase = (m + 0.5) * std::numbers::pi / harmonics;
    const double level = depth_ + elevation(phase);
    const Eigen::Vector2d relative = velocity(phase, level) - Eigen::Vector2d(celerity_, 0.0);
    const double error = (0.5 * relative.squaredNorm() + gravity_ * level - bernoulli_) / celerity_;
    sum += error * error / harmonics;
  }
  return std::sqrt(sum);
}

}  // namespace tailwater
