#include "bodies/coupling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "bodies/forces.h"
#include "bodies/verbs.h"
#include "pressure/solve_rows.h"
#include "pressure/verbs.h"

namespace tailwater {
namespace {

/// Pressure and motion agree when the forces do to so many times the solver's tolerance, which leaves that much of them
/// undecided. The rest is carried over.
constexpr double agreement_over_tolerance = 10.0;

/// Passes until the inertia is measured again. From then on each pass doubles what is left to be carried over: a film
/// of water that a body presses on a wall pushes back or not as it tears, and no motion agrees with it better.
constexpr int passes_with_old_inertia = 6;

/// The acceleration that measures inertia, over that of gravity; m/s^2 where there is none.
constexpr double probing_share = 0.1;

}  // namespace

template <int Dim>
BodyCoupling<Dim>::BodyCoupling(Flow<Dim>& flow, const StepStart<Dim>& start, double dt, WallDrive<Dim>& drive)
    : flow_(flow), start_(start), dt_(dt), drive_(drive) {
  const std::vector<FloatingBody<Dim>>& bodies = flow.setup.bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (const int entry : bodies[b].free) freedoms_.push_back({b, entry});
  }
  scale_.resize(static_cast<Eigen::Index>(freedoms_.size()));
  for (std::size_t w = 0; w < freedoms_.size(); ++w) {
    scale_[static_cast<Eigen::Index>(w)] = bodies[freedoms_[w].body].scale()[freedoms_[w].entry];
  }
  push_ = Eigen::VectorXd::Zero(scale_.size());
  contacts_ = find_contacts<Dim>(flow, start, dt, freedoms_);
}

template <int Dim>
Eigen::VectorXd BodyCoupling<Dim>::acceleration() const {
  Eigen::VectorXd A(scale_.size());
  for (std::size_t w = 0; w < freedoms_.size(); ++w) {
    const auto [body, entry] = freedoms_[w];
    A[static_cast<Eigen::Index>(w)] = flow_.state.motion.bodies.each[body].acceleration[entry];
  }
  return A;
}

template <int Dim>
void BodyCoupling<Dim>::accelerate(const Eigen::VectorXd& A) {
  for (std::size_t w = 0; w < freedoms_.size(); ++w) {
    const auto [body, entry] = freedoms_[w];
    flow_.state.motion.bodies.each[body].acceleration[entry] = A[static_cast<Eigen::Index>(w)];
  }
  steer_bodies(flow_, start_, dt_);
  drive_ = drive_walls(flow_, start_, dt_);
  flow_.setup.wall_model->set_sources(flow_.wall_scene(), flow_.wall_force(drive_.acceleration), flow_.pressure_rows);
}

template <int Dim>
SolveReport BodyCoupling<Dim>::solve_once(double tolerance) {
  return solve_rows(flow_, flow_.state.particles.pressure, tolerance);
}

template <int Dim>
Eigen::VectorXd BodyCoupling<Dim>::residual() {
  // The water feels the pressure that walls have in the end, and later solves begin with the one they had.
  const std::vector<double> solved = flow_.state.particles.pressure;
  finish_pressure(flow_, drive_);
  const double time = flow_.state.time;
  const std::vector<Twist<Dim>> pressures = pressure_on_bodies(flow_, flow_.state.particles.pressure, time);
  flow_.state.particles.pressure = solved;
  const std::vector<Twist<Dim>> frictions = friction_on_bodies(flow_, time);
  Eigen::VectorXd g(scale_.size());
  Eigen::VectorXd loads(scale_.size());
  for (std::size_t w = 0; w < freedoms_.size(); ++w) {
    const auto [b, entry] = freedoms_[w];
    const FloatingBody<Dim>& body = flow_.setup.bodies[b];
    const BodyState<Dim>& state = flow_.state.motion.bodies.each[b];
    BodyState<Dim> before = state;  // the loads are those at the start of the step
    before.velocity = start_.body_velocity[b];
    Twist<Dim> load = body.load(before, flow_.setup.gravity) + frictions[b] + state.carried_over / dt_;
    if (!flow_.loads.on_bodies.empty()) load += flow_.loads.on_bodies[b];
    const auto k = static_cast<Eigen::Index>(w);
    loads[k] = std::max(std::abs(load[entry]), std::abs(pressures[b][entry]));
    g[k] = body.force_of(state, state.acceleration)[entry] - pressures[b][entry] - load[entry];
  }
  forces_ = size(loads);
  return g - push_;
}

template <int Dim>
double BodyCoupling<Dim>::size(const Eigen::VectorXd& force) const {
  return std::sqrt(force.cwiseAbs2().cwiseQuotient(scale_).sum());
}

template <int Dim>
Eigen::Map<Eigen::MatrixXd> BodyCoupling<Dim>::inertia() {
  std::vector<double>& numbers = flow_.state.motion.bodies.inertia;
  numbers.resize(freedoms_.size() * freedoms_.size());
  return {numbers.data(), scale_.size(), scale_.size()};
}

template <int Dim>
void BodyCoupling<Dim>::measure_inertia(const Eigen::VectorXd& g, double tolerance, SolveReport& report) {
  const std::vector<double> pressure = flow_.state.particles.pressure;
  const Eigen::VectorXd A = acceleration();
  const double gravity = flow_.setup.gravity.norm();
  const double probing = gravity > 0.0 ? probing_share * gravity : probing_share;
  for (std::size_t w = 0; w < freedoms_.size(); ++w) {
    const auto k = static_cast<Eigen::Index>(w);
    const double mass = flow_.setup.bodies[freedoms_[w].body].mass;
    const double step = probing * std::sqrt(mass / scale_[k]);  // over the radius of inertia, for a turn
    Eigen::VectorXd other = A;
    other[k] += step;
    accelerate(other);
    report.iterations += solve_once(tolerance).iterations;
    inertia().col(k) = (residual() - g) / step;
    flow_.state.particles.pressure = pressure;
  }
  accelerate(A);
}

template <int Dim>
void BodyCoupling<Dim>::correct(Eigen::VectorXd& g, double tolerance, SolveReport& report) {
  if (flow_.state.motion.bodies.inertia.empty()) measure_inertia(g, tolerance, report);
  const Eigen::VectorXd before = acceleration();
  const Eigen::VectorXd pushed = push_;
  accelerate(admitted(contacts_, inertia(), dt_, before - inertia().fullPivLu().solve(g + pushed), push_));
  const Eigen::VectorXd change = acceleration() - before;
  const SolveReport solved = solve_once(tolerance);
  report.iterations += solved.iterations;
  report.restarts += solved.restarts;
  report.residual = solved.residual;
  const Eigen::VectorXd after = residual();
  // Broyden's update, with degrees of freedom measured alike by their masses.
  const Eigen::VectorXd weighted = change.cwiseProduct(scale_);
  const Eigen::VectorXd missed = (after + push_) - (g + pushed) - inertia() * change;
  if (const double square = change.dot(weighted); square > 0.0) inertia() += missed * weighted.transpose() / square;
  g = after;
}

template <int Dim>
SolveReport BodyCoupling<Dim>::solve_roughly(double tolerance) {
  SolveReport report = solve_once(tolerance);
  const std::vector<double> known = flow_.state.motion.bodies.inertia;
  Eigen::VectorXd g = residual();
  correct(g, tolerance, report);
  // What water does that may still pull is nothing to learn from.
  if (!known.empty()) flow_.state.motion.bodies.inertia = known;
  return report;
}

template <int Dim>
SolveReport BodyCoupling<Dim>::solve(double tolerance) {
  SolveReport report = solve_once(tolerance);
  Eigen::VectorXd g = residual();
  const double slack = tolerance * flow_.setup.spacing / dt_;
  const auto is_settled = [&](double share) {
    return size(g) <= share * forces_ && std::ranges::all_of(contacts_, [&](const Contact& contact) {
             return contact.speed_after(dt_, acceleration()) >= -slack;
           });
  };
  int passes = 0;
  for (double share = agreement_over_tolerance * tolerance; !is_settled(share); ++passes) {
    if (passes == passes_with_old_inertia) measure_inertia(g, tolerance, report);
    if (passes >= passes_with_old_inertia) share *= 2.0;
    if (share > 1.0) {
      throw SolverError(
          fmt::format("the motion of body '{}' and the pressure of the water do not agree after {} passes; remedy: a "
                      "finer spacing, a smaller scheme.courant, or softer moorings",
                      flow_.setup.bodies.front().name, passes));
    }
    correct(g, tolerance, report);
  }
  return report;
}

template <int Dim>
void BodyCoupling<Dim>::carry_over() {
  const Eigen::VectorXd g = residual();
  std::vector<BodyState<Dim>>& bodies = flow_.state.motion.bodies.each;
  for (BodyState<Dim>& body : bodies) body.carried_over.setZero();
  for (std::size_t w = 0; w < freedoms_.size(); ++w) {
    bodies[freedoms_[w].body].carried_over[freedoms_[w].entry] = -dt_ * g[static_cast<Eigen::Index>(w)];
  }
}

template class BodyCoupling<2>;
template class BodyCoupling<3>;

}  // namespace tailwater
