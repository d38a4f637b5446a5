#include "bodies/floating_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/box.h"
#include "base/finding.h"
#include "bodies/coupling.h"
#include "bodies/forces.h"
#include "case/rheology.h"
#include "flow/pressure_equation.h"
#include "geometry/outer_patches.h"
#include "io/messages.h"

namespace tailwater {
namespace {

/// The friction on a body is that of its velocity at the start of a step. In a liquid whose viscous forces would limit
/// an explicit step, that friction could grow from step to step.
template <int Dim>
void require_thin_liquids(const CaseSpec& spec, const Setup<Dim>& setup) {
  if (!setup.has_implicit_viscosity) return;
  const std::vector<std::uint8_t>& is_thin = setup.liquids.is_thin;
  const LiquidTable* thick = setup.liquids.are_several() ? nullptr : liquid_of(spec);
  for (std::size_t k = 0; k < is_thin.size(); ++k) {
    if (is_thin[k] == 0) thick = &spec.liquids[k];
  }
  if (thick == nullptr) return;
  throw CaseError(
      "body-in-thick-liquid",
      {"{} floats beside {}, which is too viscous: the friction of such a liquid on a moving body is not computed",
       CaseLabel("body", spec.bodies[0].name), CaseLabel("liquid", thick->name)},
      {"draw the body as a wall, or give the liquid less viscosity"});
}

template <int Dim>
void carry_over(Flow<Dim>& flow, const std::vector<Twist<Dim>>& forces, double dt) {
  for (std::size_t b = 0; b < forces.size(); ++b) flow.state.motion.bodies.each[b].carried_over += dt * forces[b];
}

}  // namespace

template <int Dim>
FloatingBodies<Dim>::FloatingBodies(const CaseSpec& spec, const Setup<Dim>& setup, const Boundary<Dim>& boundary)
    : bodies(make_bodies<Dim>(spec)),
      moorings(make_moorings<Dim>(spec)),
      body_of_wall(bodies_of_walls(bodies, boundary.walls.size())),
      contact(make_contact_surfaces(boundary, bodies, setup.scale.spacing)),
      is_lost(bodies.size(), false),
      is_told_(bodies.size(), false),
      is_told_of_end_(bodies.size(), false) {
  std::vector<WallPatch<Dim>> of_bodies = make_wall_patches(boundary, setup.finest_spacing() * setup.scale.spacing);
  std::erase_if(of_bodies, [&](const auto& patch) { return body_of_wall[boundary.faces[patch.face].wall] < 0; });
  patches = outer_patches(spec, boundary, of_bodies);
}

template <int Dim>
std::size_t FloatingBodies<Dim>::freedom_count() const {
  std::size_t count = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) count += is_lost[b] ? 0 : bodies[b].free.size();
  return count;
}

template <int Dim>
bool FloatingBodies<Dim>::is_below_all_walls(const Flow<Dim>& flow, std::size_t b) const {
  const Vec<Dim>& gravity = flow.setup.gravity;
  const FloatingBody<Dim>& body = bodies[b];
  if (gravity.isZero(0.0)) return false;
  for (int axis = 0; axis < Dim; ++axis) {
    if (gravity[axis] != 0.0 && std::ranges::find(body.free, axis) == body.free.end()) return false;
  }
  const bool is_moored = std::ranges::any_of(moorings, [&](const Mooring<Dim>& mooring) {
    return mooring.body == static_cast<int>(b) || mooring.to_body == static_cast<int>(b);
  });
  if (is_moored || !body.springs.isZero(0.0)) return false;
  const Vec<Dim> down = gravity.normalized();
  const BodyState<Dim>& state = flow.state.motion.bodies.each[b];
  double highest = std::numeric_limits<double>::infinity();  // depth of the highest point of the body
  for (const Vec<Dim>& point : contact.points[b]) highest = std::min(highest, down.dot(state.placement(point)));
  bool has_walls = false;
  for (const WallFace<Dim>& face : flow.walls.boundary.faces) {
    if (body_of_wall[face.wall] >= 0) continue;
    has_walls = true;
    for (const Vec<Dim>& corner : face.corners) {
      if (down.dot(corner) >= highest) return false;
    }
  }
  return has_walls;
}

template <int Dim>
void FloatingBodies<Dim>::steer(Flow<Dim>& flow, double dt) const {
  for (std::size_t b = 0; b < start_velocity.size(); ++b) {
    BodyState<Dim>& body = flow.state.motion.bodies.each[b];
    body.velocity = start_velocity[b] + dt * body.acceleration;
  }
}

template <int Dim>
StepLimits FloatingBodies<Dim>::step_limits(const Flow<Dim>& /*flow*/) const {
  StepLimits limits;
  for (const Mooring<Dim>& mooring : moorings) {
    if (const double frequency = frequency_of<Dim>(mooring, bodies); frequency > 0.0) {
      limits.step = std::min(limits.step, longest_step_of_springs / frequency);
    }
  }
  for (const FloatingBody<Dim>& body : bodies) {
    const Twist<Dim> mass = body.scale();
    for (const int entry : body.free) {
      if (body.springs[entry] == 0.0) continue;
      limits.step = std::min(limits.step, longest_step_of_springs * std::sqrt(mass[entry] / body.springs[entry]));
    }
  }
  return limits;
}

/// The pairs of the water have the pressure less the balanced one, so the force of the balanced pressure on a body must
/// not be that of pairs either. Beside other walls and out of the water there is no balanced pressure around a body.
template <int Dim>
void FloatingBodies<Dim>::find_errors_of_pairs(const Flow<Dim>& flow, const NarrowGaps<Dim>& gaps) {
  const std::vector<std::optional<Twist<Dim>>> errors =
      ForcesOnBodies<Dim>(flow, *this, flow.state.time).errors_of_pairs();
  clearance.assign(errors.size(), 0.0);
  error_of_pairs.assign(errors.size(), Twist<Dim>::Zero());
  for (std::size_t b = 0; b < errors.size(); ++b) {
    if (!errors[b]) continue;
    clearance[b] = std::clamp(gaps.narrowest(static_cast<int>(b)) - (widest_gap - 1.0), 0.0, 1.0);
    error_of_pairs[b] = *errors[b];
  }
}

/// The lowest point of a body without clearance. With clearance the place is higher, without limit as that grows to 1.
template <int Dim>
double FloatingBodies<Dim>::lowest_unbalanced(const Flow<Dim>& flow, const Vec<Dim>& down) const {
  double lowest = std::numeric_limits<double>::lowest();
  const Boundary<Dim>& boundary = flow.walls.boundary;
  for (const WallPatch<Dim>& patch : patches) {
    const auto body = static_cast<std::size_t>(body_of_wall[boundary.faces[patch.face].wall]);
    if (body >= clearance.size() || clearance[body] == 1.0) continue;
    const double rise = flow.setup.scale.spacing * clearance[body] / (1.0 - clearance[body]);
    lowest = std::max(lowest, down.dot(patch.centre(boundary)) - rise);
  }
  return lowest;
}

template <int Dim>
void FloatingBodies<Dim>::claim(const Flow<Dim>& /*flow*/, std::span<Role> /*role*/) {
  stagnant.clear();  // until the gaps of this step are known
  sealed = {};
}

template <int Dim>
void FloatingBodies<Dim>::begin_step(Flow<Dim>& flow, double dt) {
  BodyStates<Dim>& states = flow.state.motion.bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    is_lost[b] = is_lost[b] || is_below_all_walls(flow, b);
    if (!is_lost[b]) continue;
    BodyState<Dim>& state = states.each[b];
    state.velocity.setZero();
    state.acceleration.setZero();
    state.carried_over.setZero();
  }
  if (states.inertia.size() != freedom_count() * freedom_count()) states.inertia.clear();
  start_velocity.clear();
  for (const BodyState<Dim>& body : flow.state.motion.bodies.each) start_velocity.push_back(body.velocity);
  steer(flow, dt);
}

template <int Dim>
void FloatingBodies<Dim>::write_rows(Flow<Dim>& flow) {
  for (const std::size_t i : stagnant)
    flow.equation->rows.row(i).finish_as_zero();  // no later pass corrects its pressure
  let_correction_through_films(sealed, flow.equation->rows);
}

template <int Dim>
std::unique_ptr<CoupledUnknowns> FloatingBodies<Dim>::couple(Flow<Dim>& flow, const PosedEquation& equation,
                                                             WallDrive<Dim>& drive) {
  if (freedom_count() == 0) return nullptr;
  auto coupling = std::make_unique<BodyCoupling<Dim>>(flow, *this, equation, drive);
  coupling->begin();
  return coupling;
}

/// Water that is stagnant rests, and takes no work from walls. To other water it is a wall with a pressure of its own.
template <int Dim>
void FloatingBodies<Dim>::add_work(const Flow<Dim>& flow, const std::vector<double>& on_walls, double dt,
                                   Works& works) const {
  const Particles<Dim>& particles = flow.state.particles;
  for (std::size_t b = 0; b < error_of_pairs.size() && flow.setup.ranks.is_root(); ++b) {
    const Twist<Dim> mean = 0.5 * (start_velocity[b] + flow.state.motion.bodies.each[b].velocity);
    works.walls += dt * error_of_pairs[b].dot(mean);  // of the pairs, which the water does not have
  }
  for (const std::size_t i : stagnant) {
    visit_pair_forces(flow, i, on_walls, [&](std::size_t j, const Vec<Dim>& force) {
      works.walls +=
          dt * force.dot(particles.is_fluid(j) ? particles.velocity[j]
                                               : entry_of<Dim>(flow.state.wall_velocity, particles.wall_row[j]));
    });
  }
}

template <int Dim>
void FloatingBodies<Dim>::project_again(Flow<Dim>& flow, const std::vector<double>& correction, double dt) {
  const double time = flow.state.time + dt;
  carry_over(flow, ForcesOnBodies<Dim>(flow, *this, time).of_pressure(correction), dt);
}

template <int Dim>
void FloatingBodies<Dim>::stay(Flow<Dim>& flow) {
  for (std::size_t b = 0; b < start_velocity.size(); ++b) {
    flow.state.motion.bodies.each[b].velocity = start_velocity[b];
    flow.state.motion.bodies.each[b].carried_over.setZero();
  }
}

template <int Dim>
void FloatingBodies<Dim>::finish_step(Flow<Dim>& flow, const StepStart<Dim>& /*start*/, double dt) {
  const double time = flow.state.time + dt;
  carry_over(flow, ForcesOnBodies<Dim>(flow, *this, time).of_guard(), dt);
  for (BodyState<Dim>& body : flow.state.motion.bodies.each) body.go_on(time);
}

template <int Dim>
bool FloatingBodies<Dim>::is_at_end_of_period(const Flow<Dim>& flow, std::size_t b) const {
  if (std::ranges::none_of(flow.setup.domain, [](const auto& range) { return range.has_value(); })) return false;
  const double support = kernel_radius(flow.setup.scale.kernel);
  Box<Dim> box;
  for (const Vec<Dim>& point : contact.points[b]) box.extend(flow.state.motion.bodies.each[b].placement(point));
  for (int axis = 0; axis < Dim; ++axis) {
    if (!flow.setup.domain[axis]) continue;
    const auto [low, high] = *flow.setup.domain[axis];
    const bool spans = box.sizes()[axis] > high - low - 0.5 * flow.setup.scale.spacing;
    if (!spans && (box.min()[axis] < low + support || box.max()[axis] > high - support)) return true;
  }
  return false;
}

template <int Dim>
void FloatingBodies<Dim>::warn(const Flow<Dim>& flow) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!is_told_of_end_[b] && is_at_end_of_period(flow, b)) {
      is_told_of_end_[b] = true;
      tailwater::warn("body-reached-end-of-period",
                      "body '{}' has come to the end of the period by t = {:.4f} s, and the water beyond the end does "
                      "not see it: its forces are wrong from now on; remedy: use a longer period, or moor the body",
                      bodies[b].name, flow.state.time);
    }
    if (!is_lost[b] || is_told_[b]) continue;
    is_told_[b] = true;
    tailwater::warn(
        "body-left-walls",
        "body '{}' has fallen below all walls by t = {:.4f} s and is no longer computed, because nothing can "
        "bring it back; remedy: close the way out (bodies cannot pass open ends), or moor the body",
        bodies[b].name, flow.state.time);
  }
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_floating_bodies(const CaseSpec& spec, const Setup<Dim>& setup,
                                                const Boundary<Dim>& boundary) {
  if (spec.bodies.empty()) return nullptr;
  require_thin_liquids(spec, setup);
  return std::make_unique<FloatingBodies<Dim>>(spec, setup, boundary);
}

template class FloatingBodies<2>;
template class FloatingBodies<3>;
TAILWATER_IN_2D_AND_3D(make_floating_bodies);

}  // namespace tailwater
