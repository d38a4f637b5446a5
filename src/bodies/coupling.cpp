#include "bodies/coupling.h"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "air/pocket_pressure.h"
#include "base/error.h"
#include "bodies/contacts.h"
#include "bodies/moorings.h"
#include "flow/pressure_equation.h"
#include "parts/script_loads.h"
#include "pressure/full_water.h"
#include "pressure/solve_rows.h"
#include "pressure/stages.h"
#include "pressure/tension.h"
#include "walls/wall_model.h"

namespace tailwater {
namespace {

/// Pressure and motion agree when the residual force is below this multiple of the solver's tolerance, because the
/// solver's own error is of that size. The rest is carried over to the next step.
constexpr double agreement_over_tolerance = 10.0;

/// Passes until the inertia is measured again. From then on each pass doubles the residual that may be carried over,
/// and the pass with the smallest residual is used in the end. This happens when a body presses on a thin film of
/// water: the film reacts or not as it tears, and no motion agrees with it better.
constexpr int passes_with_old_inertia = 6;

/// Passes of a rough solve. One pass is enough where water under tension resists like other water. Where tension was
/// limited in much of the water in the last step, the estimated inertia is too small. A single pass would then
/// accelerate the body so much that all water seems to be under tension.
constexpr int max_rough_passes = 3;

/// Acceleration for the measurement of inertia, over that of gravity; in m/s^2 without gravity.
constexpr double probing_share = 0.1;

/// Largest net area, as a fraction of the surface that faces air, that counts as an error of pairs and pieces.
constexpr double max_wrong = 0.25;

/// Least resistance of a degree of freedom, over its mass or mean moment of inertia.
constexpr double min_share_of_mass = 0.5;

}  // namespace

template <int Dim>
BodyCoupling<Dim>::BodyCoupling(Flow<Dim>& flow, FloatingBodies<Dim>& bodies, const PosedEquation& equation,
                                WallDrive<Dim>& drive)
    : flow_(flow),
      bodies_(bodies),
      enclosed_air_(air_of(flow)),
      fullness_(equation.fullness),
      dt_(equation.dt),
      drive_(drive),
      forces_(flow, bodies, flow.state.time),
      gaps_(flow, bodies.hulls(), flow.state.time) {
  for (std::size_t b = 0; b < bodies.bodies.size(); ++b) {
    if (bodies.is_lost[b]) continue;
    for (const int entry : bodies.bodies[b].free) freedoms_.push_back({b, entry});
  }
  scale_.resize(static_cast<Eigen::Index>(freedoms_.size()));
  for (std::size_t w = 0; w < freedoms_.size(); ++w) {
    scale_[static_cast<Eigen::Index>(w)] = bodies.bodies[freedoms_[w].body].scale()[freedoms_[w].entry];
  }
  push_ = Eigen::VectorXd::Zero(scale_.size());
  air_ = Eigen::MatrixXd::Zero(scale_.size(), scale_.size());
  std::vector<BodyState<Dim>> before = flow.state.motion.bodies.each;
  const std::vector<Twist<Dim>> frictions = forces_.of_friction();
  for (std::size_t b = 0; b < before.size(); ++b) {
    before[b].velocity = bodies.start_velocity[b];
    loads_.push_back(bodies.bodies[b].load(before[b], flow.setup.gravity) + frictions[b] +
                     before[b].carried_over / dt_);
    damping_.push_back(bodies.bodies[b].damping(before[b]));
  }
  flow.template part<ScriptLoads<Dim>>().add_to_bodies(loads_);
  one_sided_ = find_contacts<Dim>(flow, bodies.contact, before, dt_, freedoms_);
  std::ranges::move(find_moorings<Dim>(bodies.moorings, before, freedoms_), std::back_inserter(one_sided_));
}

template <int Dim>
void BodyCoupling<Dim>::begin() {
  bodies_.stagnant = gaps_.find_stagnant();
  bodies_.has_stagnant_water = flow_.setup.ranks.any(!bodies_.stagnant.empty());
  gaps_.measure(bodies_.stagnant);
  gaps_.hold_water(flow_, bodies_.stagnant);
  bodies_.sealed = gaps_.find_sealed(flow_.state.particles.pressure);
  let_through_films(bodies_.sealed, flow_);
  allowed_tension_ = allowed_tension(flow_);
  add_air_stiffness();
  bodies_.find_errors_of_pairs(flow_, gaps_);
  for (std::size_t b = 0; b < loads_.size(); ++b) loads_[b] -= bodies_.error_of_pairs[b];
}

/// Subtracts the net force and moment of the air on bodies that open air does not reach. A uniform pressure of the air
/// around such a body exerts no net force. The sums over pairs and pieces of its surface leave a small error at edges
/// and corners. Each pocket takes the fraction of this error that corresponds to its fraction of the body's surface.
template <int Dim>
void BodyCoupling<Dim>::remove_net_air_force() {
  const std::vector<double> all_air(enclosed_air_.state.pockets.size(), 1.0);
  const std::vector<double> everywhere(flow_.state.particles.size(), 1.0);
  const std::vector<Twist<Dim>> net = forces_of(everywhere, all_air);
  std::vector<PocketWall<Dim>>& pieces = enclosed_air_.step.walls;
  const std::vector<PocketWall<Dim>> surface = pieces;
  for (std::size_t b = 0; b < net.size(); ++b) {
    std::vector<double> area(all_air.size(), 0.0);
    double all = 0.0;
    for (const PocketWall<Dim>& piece : surface) {
      if (bodies_.body_of_wall[piece.wall] != static_cast<int>(b)) continue;
      for (const PocketShare& share : piece.shares) {
        area[share.pocket] += share.share * piece.area.norm();
        all += share.share * piece.area.norm();
      }
    }
    if (net[b].template head<Dim>().norm() >= max_wrong * all) continue;  // open air reaches it as well
    PocketWall<Dim> correction{.wall = bodies_.bodies[b].walls.front(),
                               .x = flow_.state.motion.bodies.each[b].centre_at(flow_.state.time),
                               .area = -net[b].template head<Dim>(),
                               .shares = {},
                               .couple = -net[b].template tail<turns<Dim>>()};
    for (std::size_t k = 0; k < area.size(); ++k) correction.shares.push_back({static_cast<int>(k), area[k] / all});
    pieces.push_back(std::move(correction));
  }
}

/// Adds the stiffness of the air to the inertia. G is the force of 1 Pa in each pocket on each degree of freedom. An
/// acceleration increases a pocket's volume by dt^2/2 times the transpose of G. The gas therefore adds dt^2/2 G S G^T
/// to the inertia, with its stiffness S.
template <int Dim>
void BodyCoupling<Dim>::add_air_stiffness() {
  const auto pockets = static_cast<Eigen::Index>(enclosed_air_.state.pockets.size());
  if (pockets == 0) return;
  remove_net_air_force();
  Eigen::MatrixXd G(scale_.size(), pockets);
  for (Eigen::Index k = 0; k < pockets; ++k) {
    std::vector<double> unit(static_cast<std::size_t>(pockets), 0.0);
    unit[static_cast<std::size_t>(k)] = 1.0;
    const AirResponse<Dim>& response = enclosed_air_.watch.response(enclosed_air_.state.pockets[k].number);
    G.col(k) = on_freedoms(forces_of(response.pressure, unit));
  }
  const bool is_known = !flow_.state.motion.bodies.inertia.empty();
  const Eigen::MatrixXd resisting = is_known ? Eigen::MatrixXd(inertia()) : Eigen::MatrixXd(scale_.asDiagonal());
  const auto factors = resisting.fullPivLu();
  for (Eigen::Index k = 0; k < pockets; ++k) {
    const Eigen::VectorXd force = G.col(k);
    const Eigen::VectorXd answer = factors.solve(force);
    enclosed_air_.step.mobility.push_back(std::max(0.0, dt_ * force.dot(answer)));
  }
  const Eigen::MatrixXd of_pockets = G.lazyProduct(stiffness_of_air(enclosed_air_, dt_));
  air_ = 0.5 * dt_ * dt_ * of_pockets.lazyProduct(G.transpose());
}

template <int Dim>
Eigen::VectorXd BodyCoupling<Dim>::on_freedoms(const std::vector<Twist<Dim>>& forces) const {
  Eigen::VectorXd entries(scale_.size());
  for (std::size_t w = 0; w < freedoms_.size(); ++w) {
    entries[static_cast<Eigen::Index>(w)] = forces[freedoms_[w].body][freedoms_[w].entry];
  }
  return entries;
}

/// Forces of a pressure field that is up to date and contains that of the pockets; `air` is the pressure of each
/// pocket.
template <int Dim>
std::vector<Twist<Dim>> BodyCoupling<Dim>::forces_of(std::vector<double> pressure,
                                                     const std::vector<double>& air) const {
  if (!air.empty()) subtract_seen_air<Dim>(flow_, enclosed_air_, air, pressure);
  std::vector<Twist<Dim>> forces = forces_.of_pressure(pressure);
  const std::vector<Twist<Dim>> in_gaps = forces_.of_gaps(pressure, gaps_);
  for (std::size_t b = 0; b < forces.size(); ++b) forces[b] += in_gaps[b];
  if (air.empty()) return forces;
  const std::vector<Twist<Dim>> of_air = forces_.of_air(air);
  for (std::size_t b = 0; b < forces.size(); ++b) forces[b] += of_air[b];
  return forces;
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
  bodies_.steer(flow_, dt_);
  const WallDrive<Dim> drive = drive_walls(flow_, flow_.state.wall_velocity, dt_);
  for (std::size_t row = 0; row < drive.velocity.size(); ++row) {
    if (bodies_.body_of_wall[flow_.walls.particles.wall[row]] < 0) continue;  // prescribed, perhaps to the step's end
    drive_.velocity[row] = drive.velocity[row];
    drive_.acceleration[row] = drive.acceleration[row];
  }
  flow_.wall_model().set_sources(flow_.wall_scene(), flow_.wall_force(drive_.acceleration), flow_.equation->rows);
}

template <int Dim>
SolveReport BodyCoupling<Dim>::solve_once(double tolerance) {
  return solve_rows(flow_, flow_.state.particles.pressure, tolerance);
}

template <int Dim>
Eigen::VectorXd BodyCoupling<Dim>::residual() {
  // The forces depend on the final wall pressures; later solves start from the solved pressure, which is restored
  // below.
  const std::vector<double> solved = flow_.state.particles.pressure;
  shift_minimum_to_zero<Dim>(flow_, fullness_, {}, flow_.state.particles.pressure);
  finish_pressure(flow_, drive_, allowed_tension_);
  std::vector<double> air;
  if (!enclosed_air_.state.pockets.empty()) {
    air = find_air_pressures(flow_, enclosed_air_, dt_);
    add_air_of<Dim>(enclosed_air_, air, flow_.state.particles.pressure);
  }
  const std::vector<Twist<Dim>> pressures = forces_of(flow_.state.particles.pressure, air);
  last_forces_ = pressures;
  flow_.state.particles.pressure = solved;
  Eigen::VectorXd g(scale_.size());
  Eigen::VectorXd forces(scale_.size());
  for (std::size_t w = 0; w < freedoms_.size(); ++w) {
    const auto [b, entry] = freedoms_[w];
    const FloatingBody<Dim>& body = bodies_.bodies[b];
    const BodyState<Dim>& state = flow_.state.motion.bodies.each[b];
    const auto k = static_cast<Eigen::Index>(w);
    forces[k] = std::max({std::abs(loads_[b][entry]), std::abs(pressures[b][entry]), std::abs(push_[k])});
    // Dampers act with the velocity at the end of the step.
    g[k] = body.force_of(state, state.acceleration)[entry] + dt_ * damping_[b][entry] * state.acceleration[entry] -
           pressures[b][entry] - loads_[b][entry];
  }
  largest_force_ = size(forces);
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
    const double mass = bodies_.bodies[freedoms_[w].body].mass;
    const double step = probing * std::sqrt(mass / scale_[k]);  // divided by the radius of inertia for a rotation
    Eigen::VectorXd other = A;
    other[k] += step;
    accelerate(other);
    report.iterations += solve_once(tolerance).iterations;
    inertia().col(k) = (residual() - g) / step - air_.col(k);
    inertia()(k, k) = std::max(inertia()(k, k), min_share_of_mass * scale_[k]);
    flow_.state.particles.pressure = pressure;
  }
  accelerate(A);
}

template <int Dim>
void BodyCoupling<Dim>::correct(Eigen::VectorXd& g, double tolerance, SolveReport& report) {
  if (flow_.state.motion.bodies.inertia.empty()) measure_inertia(g, tolerance, report);
  const Eigen::VectorXd before = acceleration();
  const Eigen::VectorXd pushed = push_;
  accelerate(find_one_sided(one_sided_, inertia() + air_, dt_, flow_.setup.scale.spacing,
                            before - (inertia() + air_).fullPivLu().solve(Eigen::VectorXd(g + pushed)), push_));
  const Eigen::VectorXd change = acceleration() - before;
  const SolveReport solved = solve_once(tolerance);
  report.iterations += solved.iterations;
  report.restarts += solved.restarts;
  report.residual = solved.residual;
  const Eigen::VectorXd after = residual();
  // Broyden's update, with degrees of freedom scaled by their masses. A change that appears to need less force than the
  // mass alone indicates water that tears, not added mass, and is not used.
  const Eigen::VectorXd weighted = change.cwiseProduct(scale_);
  const Eigen::VectorXd answer = (after + push_) - (g + pushed) - air_ * change;
  const double square = change.dot(weighted);
  if (square > 0.0 && change.dot(answer) >= min_share_of_mass * square) {
    inertia() += (answer - inertia() * change) * weighted.transpose() / square;
  }
  g = after;
}

template <int Dim>
SolveReport BodyCoupling<Dim>::solve_roughly(double tolerance) {
  SolveReport report = solve_once(tolerance);
  const std::vector<double> known = flow_.state.motion.bodies.inertia;
  Eigen::VectorXd g = residual();
  int passes = 0;
  do {
    correct(g, tolerance, report);
  } while (++passes < max_rough_passes && size(g) > agreement_over_tolerance * tolerance * largest_force_);
  // The response of water whose tension is not limited yet must not change the inertia.
  if (!known.empty()) flow_.state.motion.bodies.inertia = known;
  return report;
}

template <int Dim>
SolveReport BodyCoupling<Dim>::solve(double tolerance) {
  SolveReport report = solve_once(tolerance);
  Eigen::VectorXd g = residual();
  const double slack = tolerance * flow_.setup.scale.spacing / dt_;
  const auto is_settled = [&](double share) {
    return size(g) <= share * largest_force_ && std::ranges::all_of(one_sided_, [&](const OneSidedForce& one) {
             return !one.is_rigid() || one.speed_after(dt_, acceleration()) >= -slack;
           });
  };
  Iterate best;
  int passes = 0;
  for (double share = agreement_over_tolerance * tolerance; !is_settled(share); ++passes) {
    if (passes == passes_with_old_inertia) measure_inertia(g, tolerance, report);
    if (passes >= passes_with_old_inertia) share *= 2.0;
    if (share > 1.0) {
      if (best.missing > best.largest_force) fail(passes);
      go_back_to(best);
      break;
    }
    correct(g, tolerance, report);
    if (size(g) < best.missing) {
      best = {acceleration(), push_, flow_.state.particles.pressure, size(g), largest_force_};
    }
  }
  return report;
}

template <int Dim>
void BodyCoupling<Dim>::fail(int passes) const {
  throw SolverError(
      "the motion of body '{}' and the pressure of the water do not agree after {} passes; remedy: a finer spacing, a "
      "smaller scheme.courant, or softer moorings",
      bodies_.bodies.front().name, passes);
}

template <int Dim>
void BodyCoupling<Dim>::go_back_to(const Iterate& iterate) {
  push_ = iterate.push;
  accelerate(iterate.A);
  flow_.state.particles.pressure = iterate.pressure;
}

/// Stores the forces on bodies beside walls for probes, which divide the forces of pairs between walls.
template <int Dim>
void BodyCoupling<Dim>::report_forces(const std::vector<Twist<Dim>>& forces) {
  for (std::size_t b = 0; b < forces.size(); ++b) {
    const int beside = gaps_.wall_beside(static_cast<int>(b));
    if (beside < 0) continue;
    const Twist<Dim> force = forces[b] - bodies_.error_of_pairs[b];
    flow_.walls.forces.beside_walls.push_back({.walls = bodies_.bodies[b].walls,
                                               .beside = beside,
                                               .centre = flow_.state.motion.bodies.each[b].centre_at(flow_.state.time),
                                               .force = force.template head<Dim>(),
                                               .moment = force.template tail<turns<Dim>>()});
  }
}

template <int Dim>
void BodyCoupling<Dim>::finish() {
  Particles<Dim>& particles = flow_.state.particles;
  const std::vector<double> pressure = particles.pressure;
  enclosed_air_.subtract_pressure(std::span(particles.pressure).first(particles.owned));
  const Eigen::VectorXd g = residual();
  if (enclosed_air_.state.pockets.empty()) report_forces(last_forces_);
  flow_.state.particles.pressure = pressure;
  std::vector<BodyState<Dim>>& bodies = flow_.state.motion.bodies.each;
  for (BodyState<Dim>& body : bodies) body.carried_over.setZero();
  for (std::size_t w = 0; w < freedoms_.size(); ++w) {
    bodies[freedoms_[w].body].carried_over[freedoms_[w].entry] = -dt_ * g[static_cast<Eigen::Index>(w)];
  }
}

template class BodyCoupling<2>;
template class BodyCoupling<3>;

}  // namespace tailwater
