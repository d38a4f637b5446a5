#include "pressure/floating_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/for_each.h"
#include "pressure/operators.h"
#include "pressure/solve_rows.h"
#include "pressure/verbs.h"
#include "walls/wall_contact.h"

namespace tailwater {
namespace {

/// Pressure and motion agree when the forces do to so many times the solver's tolerance, which leaves that much of them
/// undecided. The rest is carried over.
constexpr double agreement_over_tolerance = 10.0;

/// Passes until the inertia is measured again. From then on each pass doubles what is left to be carried over: a film
/// of water that a body presses on a wall pushes back or not as it tears, and no motion agrees with it better.
constexpr int passes_with_old_inertia = 6;

/// More are needed only where many points of a body touch at once.
constexpr int contact_sweeps = 100;

/// The acceleration that measures inertia, over that of gravity; m/s^2 where there is none.
constexpr double probing_share = 0.1;

/// Forces on each body, and their moments about its centre, which add up.
template <int Dim>
class ForceSums {
 public:
  /// With the centres where they are at `time`.
  ForceSums(const Flow<Dim>& flow, double time) : flow_(flow), sums_(size * flow.setup.bodies.size(), 0.0) {
    for (const BodyState<Dim>& body : flow.state.motion.bodies.each) centres_.push_back(body.centre_at(time));
  }

  /// A force at `x` on the body that the wall is of; nothing if it is of none.
  void add(int wall, const Vec<Dim>& x, const Vec<Dim>& force) {
    const int body = flow_.setup.body_of_wall[wall];
    if (body < 0) return;
    Eigen::Map<Twist<Dim>> sum(sums_.data() + static_cast<std::size_t>(body) * size);
    sum.template head<Dim>() += force;
    sum.template tail<turns<Dim>>() += moment_of<Dim>(x - centres_[body], force);
  }

  /// Of all ranks. Collective.
  std::vector<Twist<Dim>> gather() {
    flow_.setup.ranks.sum_of_each(sums_);
    std::vector<Twist<Dim>> forces;
    for (std::size_t b = 0; b < centres_.size(); ++b) {
      forces.push_back(Eigen::Map<const Twist<Dim>>(sums_.data() + b * size));
    }
    return forces;
  }

 private:
  static constexpr int size = Dim + turns<Dim>;
  const Flow<Dim>& flow_;
  std::vector<Vec<Dim>> centres_;
  std::vector<double> sums_;
};

/// Sum over the owned wall particles of bodies of what `force(i)` does to the body of each.
template <int Dim, class Force>
std::vector<Twist<Dim>> sum_on_bodies(const Flow<Dim>& flow, double time, Force&& force) {
  ForceSums<Dim> sums(flow, time);
  const Particles<Dim>& particles = flow.state.particles;
  const WallParticles<Dim>& table = flow.walls.particles;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: all add to the same few sums
    if (particles.is_fluid(i)) continue;
    const auto row = particles.wall_row[i];
    const int wall = table.wall[row];
    if (flow.setup.body_of_wall[wall] >= 0) sums.add(wall, table.position[row], force(i));
  }
  return sums.gather();
}

}  // namespace

template <int Dim>
std::vector<Twist<Dim>> forces_on_bodies(const Flow<Dim>& flow, const std::vector<double>& pressure, double time) {
  const Particles<Dim>& particles = flow.state.particles;
  return sum_on_bodies(flow, time, [&](std::size_t i) {
    return Vec<Dim>(-particles.volume[i] * push_of_wall_particle(flow, i, pressure));
  });
}

template <int Dim>
void steer_bodies(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  for (std::size_t b = 0; b < start.body_velocity.size(); ++b) {
    BodyState<Dim>& body = flow.state.motion.bodies.each[b];
    body.velocity = start.body_velocity[b] + dt * body.acceleration;
  }
}

template <int Dim>
void owe_to_bodies(Flow<Dim>& flow, const std::vector<Twist<Dim>>& forces, double dt) {
  for (std::size_t b = 0; b < forces.size(); ++b) flow.state.motion.bodies.each[b].owed += dt * forces[b];
}

template <int Dim>
void owe_to_bodies_for_put_back(Flow<Dim>& flow, double dt) {
  if (flow.setup.bodies.empty()) return;
  ForceSums<Dim> sums(flow, flow.state.time + dt);
  const Particles<Dim>& particles = flow.state.particles;
  const Boundary<Dim>& boundary = flow.walls.boundary;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: all add to the same few sums
    const Vec<Dim>& force = flow.wall_forces.pressure[i];
    if (!particles.is_fluid(i) || force.isZero(0.0)) continue;
    const NearestWall<Dim> nearest = boundary.nearest(particles.position[i], search_distance * flow.setup.spacing);
    if (nearest.face >= 0) sums.add(boundary.faces[nearest.face].wall, nearest.point, force);
  }
  owe_to_bodies(flow, sums.gather(), dt);
}

template <int Dim>
BodyCoupling<Dim>::BodyCoupling(Flow<Dim>& flow, const StepStart<Dim>& start, double dt, WallDrive<Dim>& drive)
    : flow_(flow), start_(start), dt_(dt), drive_(drive) {
  const std::vector<FloatingBody<Dim>>& bodies = flow.setup.bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (const int entry : bodies[b].free) ways_.push_back({b, entry});
  }
  scale_.resize(static_cast<Eigen::Index>(ways_.size()));
  for (std::size_t w = 0; w < ways_.size(); ++w) {
    scale_[static_cast<Eigen::Index>(w)] = bodies[ways_[w].body].scale()[ways_[w].entry];
  }
  push_ = Eigen::VectorXd::Zero(scale_.size());
  find_contacts();
}

template <int Dim>
void BodyCoupling<Dim>::find_contacts() {
  const ContactSurfaces<Dim>& surfaces = flow_.setup.contact;
  for (std::size_t b = 0; b < surfaces.points.size(); ++b) {
    BodyState<Dim> body = flow_.state.motion.bodies.each[b];
    body.velocity = start_.body_velocity[b];
    for (const Vec<Dim>& point : surfaces.points[b]) {
      const Vec<Dim> x = body.placement(point);
      const NearestWall<Dim> wall = surfaces.resting.nearest(x, flow_.setup.spacing);
      if (wall.face < 0) continue;
      const double distance = std::abs(wall.signed_distance);
      const Vec<Dim> away = distance > corner_tolerance * flow_.setup.spacing
                                ? Vec<Dim>((x - wall.point) / wall.signed_distance)
                                : surfaces.resting.faces[wall.face].normal;
      Contact contact{Eigen::VectorXd::Zero(scale_.size()),
                      away.dot(body.velocity_at(x)) + std::max(0.0, wall.signed_distance) / dt_};
      const Turn<Dim> arm = moment_of<Dim>(x - body.centre, away);
      for (std::size_t w = 0; w < ways_.size(); ++w) {
        const auto [other, entry] = ways_[w];
        if (other != b) continue;
        contact.way[static_cast<Eigen::Index>(w)] = entry < Dim ? away[entry] : arm[entry - Dim];
      }
      contacts_.push_back(std::move(contact));
    }
  }
}

// A sweep gives each contact in turn the force that it needs (projected Gauss-Seidel).
template <int Dim>
Eigen::VectorXd BodyCoupling<Dim>::admitted(const Eigen::VectorXd& wanted) {
  push_.setZero();
  Eigen::VectorXd A = wanted;
  const auto factors = inertia().fullPivLu();
  for (int sweep = 0; sweep < contact_sweeps; ++sweep) {
    bool is_changed = false;
    for (Contact& contact : contacts_) {
      if (sweep == 0) contact.force = 0.0;
      const double speed = contact.speed + dt_ * contact.way.dot(A);
      if (speed >= 0.0 && contact.force == 0.0) continue;
      const Eigen::VectorXd answer = factors.solve(contact.way);
      const double mobility = dt_ * contact.way.dot(answer);
      if (mobility <= 0.0) continue;  // it cannot move that way
      const double change = std::max(-speed / mobility, -contact.force);
      contact.force += change;
      A += change * answer;
      push_ += change * contact.way;
      is_changed = true;
    }
    if (!is_changed) break;
  }
  return A;
}

template <int Dim>
Eigen::VectorXd BodyCoupling<Dim>::acceleration() const {
  Eigen::VectorXd A(scale_.size());
  for (std::size_t w = 0; w < ways_.size(); ++w) {
    const auto [body, entry] = ways_[w];
    A[static_cast<Eigen::Index>(w)] = flow_.state.motion.bodies.each[body].acceleration[entry];
  }
  return A;
}

template <int Dim>
void BodyCoupling<Dim>::accelerate(const Eigen::VectorXd& A) {
  for (std::size_t w = 0; w < ways_.size(); ++w) {
    const auto [body, entry] = ways_[w];
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
  const std::vector<Twist<Dim>> pressures = forces_on_bodies(flow_, flow_.state.particles.pressure, time);
  flow_.state.particles.pressure = solved;
  const std::vector<Twist<Dim>> frictions =
      sum_on_bodies(flow_, time, [&](std::size_t i) { return flow_.wall_forces.friction[i]; });
  Eigen::VectorXd g(scale_.size());
  Eigen::VectorXd loads(scale_.size());
  for (std::size_t w = 0; w < ways_.size(); ++w) {
    const auto [b, entry] = ways_[w];
    const FloatingBody<Dim>& body = flow_.setup.bodies[b];
    const BodyState<Dim>& state = flow_.state.motion.bodies.each[b];
    BodyState<Dim> before = state;  // the loads are those at the start of the step
    before.velocity = start_.body_velocity[b];
    const Twist<Dim> load = body.load(before, flow_.setup.gravity) + frictions[b] + state.owed / dt_;
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
  numbers.resize(ways_.size() * ways_.size());
  return {numbers.data(), scale_.size(), scale_.size()};
}

template <int Dim>
void BodyCoupling<Dim>::measure_inertia(const Eigen::VectorXd& g, double tolerance, SolveReport& report) {
  const std::vector<double> pressure = flow_.state.particles.pressure;
  const Eigen::VectorXd A = acceleration();
  const double gravity = flow_.setup.gravity.norm();
  const double probing = gravity > 0.0 ? probing_share * gravity : probing_share;
  for (std::size_t w = 0; w < ways_.size(); ++w) {
    const auto k = static_cast<Eigen::Index>(w);
    const double mass = flow_.setup.bodies[ways_[w].body].mass;
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
  accelerate(admitted(before - inertia().fullPivLu().solve(g + pushed)));
  const Eigen::VectorXd change = acceleration() - before;
  const SolveReport solved = solve_once(tolerance);
  report.iterations += solved.iterations;
  report.restarts += solved.restarts;
  report.residual = solved.residual;
  const Eigen::VectorXd after = residual();
  // Broyden's update, in ways that are measured alike by their masses.
  const Eigen::VectorXd weighted = change.cwiseProduct(scale_);
  const Eigen::VectorXd missed = (after + push_) - (g + pushed) - inertia() * change;
  if (const double square = change.dot(weighted); square > 0.0) inertia() += missed * weighted.transpose() / square;
  g = after;
}

template <int Dim>
SolveReport BodyCoupling<Dim>::solve_roughly(double tolerance) {
  SolveReport report = solve_once(tolerance);
  if (ways_.empty()) return report;
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
  if (ways_.empty()) return report;
  Eigen::VectorXd g = residual();
  const double slack = tolerance * flow_.setup.spacing / dt_;
  const auto is_settled = [&](double share) {
    return size(g) <= share * forces_ && std::ranges::all_of(contacts_, [&](const Contact& contact) {
             return contact.speed + dt_ * contact.way.dot(acceleration()) >= -slack;
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
  if (ways_.empty()) return;
  const Eigen::VectorXd g = residual();
  std::vector<BodyState<Dim>>& bodies = flow_.state.motion.bodies.each;
  for (BodyState<Dim>& body : bodies) body.owed.setZero();
  for (std::size_t w = 0; w < ways_.size(); ++w) {
    bodies[ways_[w].body].owed[ways_[w].entry] = -dt_ * g[static_cast<Eigen::Index>(w)];
  }
}

#define TAILWATER_INSTANTIATE(Dim)                                                                              \
  template std::vector<Twist<Dim>> forces_on_bodies<Dim>(const Flow<Dim>&, const std::vector<double>&, double); \
  template void steer_bodies<Dim>(Flow<Dim>&, const StepStart<Dim>&, double);                                   \
  template void owe_to_bodies<Dim>(Flow<Dim>&, const std::vector<Twist<Dim>>&, double);                         \
  template void owe_to_bodies_for_put_back<Dim>(Flow<Dim>&, double);                                            \
  template class BodyCoupling<Dim>;
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
