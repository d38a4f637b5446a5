#include "motion/wall_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/for_each.h"
#include "case/named_numbers.h"
#include "geometry/from_spec.h"
#include "geometry/rotation.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

/// Half of the interval [s] that represents an instant. Positions of metres then give velocities accurate to 1e-9 m/s,
/// and no path of a wall changes within it.
constexpr double instant = 1e-6;

template <int Dim>
AffineMap<Dim> mean_velocity_between(const AffineMap<Dim>& before, const AffineMap<Dim>& after, double duration) {
  return {(after.linear - before.linear) / duration, (after.constant - before.constant) / duration};
}

/// Against gravity; without it along the last axis.
template <int Dim>
Vec<Dim> upward(const CaseSpec& spec) {
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  return gravity.norm() > 0.0 ? Vec<Dim>(-gravity.normalized()) : Vec<Dim>(Vec<Dim>::Unit(Dim - 1));
}

}  // namespace

template <int Dim>
WallFace<Dim> moved(const AffineMap<Dim>& motion, WallFace<Dim> face) {
  for (Vec<Dim>& corner : face.corners) corner = motion(corner);
  face.normal = motion.linear * face.normal;
  return face;
}

template <int Dim>
WrittenMotion<Dim>::WrittenMotion(const CaseSpec& spec, const WallTable& table, const CaseLabel& owner)
    : rotation_(table.rotation, named_numbers(spec)) {
  if (!table.displacement.empty()) {
    require_dimension<Dim>(table.displacement.size(), owner.with_key("displacement"));
  }
  for (const Varying& component : table.displacement) displacement_.emplace_back(component, named_numbers(spec));
}

template <int Dim>
Placement<Dim> WrittenMotion<Dim>::at(double time) const {
  Placement<Dim> placement;
  placement.angle = rotation_.at(time);
  for (std::size_t axis = 0; axis < displacement_.size(); ++axis) {
    placement.displacement[axis] = displacement_[axis].at(time);
  }
  return placement;
}

template <int Dim>
MotionOfFile<Dim>::MotionOfFile(const TimeSeries& series) {
  const auto spline = [&](std::size_t column) {
    const std::vector<double>& values = series.columns[column];
    return values.empty() ? std::nullopt : std::optional<Spline>(std::in_place, series.time, values);
  };
  for (int axis = 0; axis < Dim; ++axis) displacement_[axis] = spline(static_cast<std::size_t>(axis));
  angle_ = spline(3);
}

template <int Dim>
Placement<Dim> MotionOfFile<Dim>::at(double time) const {
  Placement<Dim> placement;
  for (int axis = 0; axis < Dim; ++axis) {
    if (displacement_[axis]) placement.displacement[axis] = displacement_[axis]->at(time);
  }
  if (angle_) placement.angle = angle_->at(time);
  return placement;
}

template <int Dim>
MotionOfGate<Dim>::MotionOfGate(const CaseSpec& spec, const GateTable& gate)
    : direction_(upward<Dim>(spec)),
      law_(gate, std::abs(direction_.dot(to_vec<Dim>(gate.to, CaseLabel("gate", gate.name), "to") -
                                         to_vec<Dim>(gate.from, CaseLabel("gate", gate.name), "from")))) {}

// A plate that turns about its foot is displaced by the stroke where it crosses the still water's level.
template <int Dim>
Placement<Dim> MotionOfMaker<Dim>::at(double time, const MakerState& state) const {
  const double stroke = plate_.stroke(time, state);
  if (!plate_.turns) return {stroke * plate_.forward, 0.0};
  // From `up` to `forward`; counter-clockwise is positive in 2D, and about the axis up x forward in 3D.
  double sense = 1.0;
  if constexpr (Dim == 2) sense = plate_.up[0] * plate_.forward[1] - plate_.up[1] * plate_.forward[0];
  return {Vec<Dim>::Zero(), sense * std::atan(stroke / plate_.depth)};
}

template <int Dim>
WallPath<Dim>::WallPath(const CaseSpec& spec, const WallTable& table, const CaseLabel& owner)
    : motion_(make_motion(spec, table, owner)),
      pivot_(table.pivot.empty() ? Vec<Dim>(Vec<Dim>::Zero()) : to_vec<Dim>(table.pivot, owner, "pivot")) {
  if constexpr (Dim == 3) {
    const Vec<3> axis = table.axis.empty() ? Vec<3>(Vec<3>::Zero()) : to_vec<3>(table.axis, owner, "axis");
    if (axis.norm() > 0.0) axis_ = axis.normalized();
  }
  if (const auto* maker = std::get_if<MotionOfMaker<Dim>>(&motion_)) {
    pivot_ = maker->plate().foot;
    if constexpr (Dim == 3) axis_ = maker->plate().along;
  }
}

template <int Dim>
typename WallPath<Dim>::Motion WallPath<Dim>::make_motion(const CaseSpec& spec, const WallTable& table,
                                                          const CaseLabel& owner) {
  if (table.drive.by == Drive::By::gate) return MotionOfGate<Dim>(spec, spec.gates[table.drive.index]);
  if (table.drive.by == Drive::By::wave_maker) return MotionOfMaker<Dim>(spec, spec.wave_makers[table.drive.index]);
  if (!table.series.empty()) return MotionOfFile<Dim>(table.series);
  return WrittenMotion<Dim>(spec, table, owner);
}

template <int Dim>
AffineMap<Dim> WallPath<Dim>::at(double time, const MakerState& maker) const {
  return at(std::visit(
      [&]<class M>(const M& motion) {
        if constexpr (std::is_same_v<M, MotionOfMaker<Dim>>) {
          return motion.at(time, maker);
        } else {
          return motion.at(time);
        }
      },
      motion_));
}

template <int Dim>
AffineMap<Dim> WallPath<Dim>::at(const Placement<Dim>& placement) const {
  AffineMap<Dim> map;
  const double angle = placement.angle;
  if constexpr (Dim == 2) {
    map.linear = rotation_in_plane(angle);
  } else if (angle != 0.0) {
    map.linear = rotation_about(axis_, angle);
  }
  map.constant = pivot_ - map.linear * pivot_;
  map.constant += placement.displacement;
  return map;
}

template <int Dim>
AffineMap<Dim> WallPath<Dim>::mean_velocity(double from, double to) const {
  return mean_velocity_between(at(from), at(to), to - from);
}

template <int Dim>
AffineMap<Dim> WallMotion<Dim>::MovingWall::at(double time, const MotionState<Dim>& state) const {
  if (body >= 0) return state.bodies.each[body].at(time);
  return path.at(time, maker < 0 ? MakerState{} : state.wave_makers[maker]);
}

template <int Dim>
AffineMap<Dim> WallMotion<Dim>::MovingWall::in_period(AffineMap<Dim> placement) const {
  for (int axis = 0; axis < Dim; ++axis) {
    if (period[axis] > 0.0)
      placement.constant[axis] -= period[axis] * std::floor(placement.constant[axis] / period[axis]);
  }
  return placement;
}

template <int Dim>
AffineMap<Dim> WallMotion<Dim>::MovingWall::mean_velocity(double from, double to, const MotionState<Dim>& state) const {
  return mean_velocity_between(at(from, state), at(to, state), to - from);
}

template <int Dim>
MotionState<Dim> initial_motion(const CaseSpec& spec) {
  MotionState<Dim> motion;
  motion.wave_makers.resize(spec.wave_makers.size());
  for (const FloatingBody<Dim>& body : make_bodies<Dim>(spec)) motion.bodies.each.push_back(body.drawn);
  return motion;
}

template <int Dim>
WallMotion<Dim>::WallMotion(const CaseSpec& spec, Boundary<Dim>& boundary, const WallParticles<Dim>& particles) {
  for (std::size_t w = 0; w < spec.walls.size(); ++w) {
    if (!boundary.walls[w].moves()) continue;
    const WallTable& table = spec.walls[w];
    MovingWall& wall = moving_.emplace_back(
        MovingWall{static_cast<int>(w), WallPath<Dim>(spec, table, wall_label(boundary, static_cast<int>(w)))});
    if (table.drive.by == Drive::By::wave_maker) wall.maker = static_cast<int>(table.drive.index);
    if (table.drive.by == Drive::By::body) wall.body = static_cast<int>(table.drive.index);
    for (std::size_t axis = 0; axis < table.displacement.size(); ++axis) {
      const std::vector<double>& range = periodic_range(spec.domain, static_cast<int>(axis));
      const bool is_in_file = !table.series.empty() && !table.series.columns[axis].empty();
      if (range.size() != 2 || !(is_in_file || std::holds_alternative<std::string>(table.displacement[axis]))) continue;
      wall.period[axis] = range[1] - range[0];
      AffineMap<Dim> back;
      back.constant[axis] = -wall.period[axis];
      const std::size_t count = boundary.faces.size();
      for (std::size_t f = 0; f < count; ++f) {
        if (boundary.faces[f].wall != static_cast<int>(w)) continue;
        boundary.faces.push_back(moved(back, boundary.faces[f]));
        boundary.faces.back().is_image = true;
      }
    }
  }
  if (boundary.filed_reach() > 0.0) boundary.file_faces(boundary.filed_reach());
  if (moving_.empty()) return;
  drawn_faces_ = boundary.faces;
  for (std::size_t row = 0; row < particles.size(); ++row) {
    const int wall = particles.wall[row];
    if (!boundary.walls[wall].moves()) continue;
    drawn_particles_.push_back({row, wall, particles.position[row], particles.normal[row], particles.blocked[row],
                                particles.beyond_edges[row]});
  }
}

template <int Dim>
void WallMotion<Dim>::place(double time, const MotionState<Dim>& state, Boundary<Dim>& boundary,
                            WallParticles<Dim>& particles) const {
  for (const MovingWall& moving : moving_) {
    const AffineMap<Dim> motion = moving.in_period(moving.at(time, state));
    for (std::size_t f = 0; f < drawn_faces_.size(); ++f) {
      if (drawn_faces_[f].wall == moving.wall) boundary.faces[f] = moved(motion, drawn_faces_[f]);
    }
    for_each(drawn_particles_.size(), [&](std::size_t n) {
      const DrawnParticle& drawn = drawn_particles_[n];
      if (drawn.wall != moving.wall) return;
      particles.position[drawn.row] = motion(drawn.position);
      particles.normal[drawn.row] = motion.linear * drawn.normal;
      particles.blocked[drawn.row] = motion.linear * drawn.blocked * motion.linear.transpose();
      particles.beyond_edges[drawn.row] = motion.linear * drawn.beyond_edges;
    });
  }
  if (!moving_.empty()) boundary.hang_screens();
}

template <int Dim>
void WallMotion<Dim>::get_mean_velocity(double from, double to, const MotionState<Dim>& state,
                                        std::span<Vec<Dim>> velocity) const {
  for (const MovingWall& moving : moving_) {
    const AffineMap<Dim> map = moving.mean_velocity(from, to, state);
    for_each(drawn_particles_.size(), [&](std::size_t n) {
      const DrawnParticle& drawn = drawn_particles_[n];
      if (drawn.wall == moving.wall) velocity[drawn.row] = map(drawn.position);
    });
  }
}

template <int Dim>
void WallMotion<Dim>::get_velocity(double time, const MotionState<Dim>& state, std::span<Vec<Dim>> velocity) const {
  get_mean_velocity(std::max(0.0, time - instant), time + instant, state, velocity);
}

template <int Dim>
double WallMotion<Dim>::largest_displacement(double from, double to, const MotionState<Dim>& state) const {
  double farthest = 0.0;
  for (const MovingWall& moving : moving_) {
    farthest = std::max(farthest, farthest_corner(moving.wall, moving.at(from, state), moving.at(to, state)));
  }
  return farthest;
}

/// Largest distance [m] by which a corner of the wall moves from one place to the other.
template <int Dim>
double WallMotion<Dim>::farthest_corner(int wall, const AffineMap<Dim>& before, const AffineMap<Dim>& after) const {
  double farthest = 0.0;
  for (const WallFace<Dim>& face : drawn_faces_) {
    if (face.wall != wall) continue;
    for (const Vec<Dim>& corner : face.corners) farthest = std::max(farthest, (after(corner) - before(corner)).norm());
  }
  return farthest;
}

template <int Dim>
void WallMotion<Dim>::steer(std::size_t which, GivenMotion<Dim> given, double time, const MotionState<Dim>& state,
                            double off, const std::string& label) {
  MovingWall& moving = moving_.at(which);
  const double jump = farthest_corner(moving.wall, moving.at(time, state), moving.path.at(given.at(time)));
  if (jump > off) {
    throw InputError(
        "{}: the path of a script begins {:.4g} m from where the wall is at t = {:.4f} s; remedy: one that begins "
        "there",
        label, jump, time);
  }
  moving.path.follow(std::move(given));
}

TAILWATER_IN_2D_AND_3D(moved);
TAILWATER_IN_2D_AND_3D(initial_motion);
template class WrittenMotion<2>;
template class WrittenMotion<3>;
template class MotionOfFile<2>;
template class MotionOfFile<3>;
template class MotionOfGate<2>;
template class MotionOfGate<3>;
template class MotionOfMaker<2>;
template class MotionOfMaker<3>;
template class WallPath<2>;
template class WallPath<3>;
template class WallMotion<2>;
template class WallMotion<3>;

}  // namespace tailwater
