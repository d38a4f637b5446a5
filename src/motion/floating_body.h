// Rigid bodies that float: their properties, positions and velocities.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "base/vec.h"
#include "case/spec.h"
#include "geometry/rotation.h"
#include "motion/affine_map.h"

namespace tailwater {

/// Axes about which a body can turn: one in 2D.
template <int Dim>
inline constexpr int turns = Dim == 2 ? 1 : 3;

template <int Dim>
using Turn = Vec<turns<Dim>>;

/// Motion or load of a rigid body: first the entries along the axes, then those about the axes. A velocity [m/s,
/// rad/s], an acceleration, or a force with its moment [N, N m].
template <int Dim>
using Twist = Vec<Dim + turns<Dim>>;

template <int Dim>
Twist<Dim> twist_of(const Vec<Dim>& along, const Turn<Dim>& about) {
  Twist<Dim> both;
  both.put(0, along);
  both.put(Dim, about);
  return both;
}

/// arm x force
template <int Dim>
Turn<Dim> moment_of(const Vec<Dim>& arm, const Vec<Dim>& force) {
  if constexpr (Dim == 2) {
    return Turn<2>(arm[0] * force[1] - arm[1] * force[0]);
  } else {
    return arm.cross(force);
  }
}

/// omega x arm
template <int Dim>
Vec<Dim> velocity_about(const Turn<Dim>& omega, const Vec<Dim>& arm) {
  if constexpr (Dim == 2) {
    return {-omega[0] * arm[1], omega[0] * arm[0]};
  } else {
    return omega.cross(arm);
  }
}

/// The rotation by the length of `angle` [rad] about its direction.
template <int Dim>
Mat<Dim> rotation_by(const Turn<Dim>& angle) {
  if constexpr (Dim == 2) {
    return rotation_in_plane(angle[0]);
  } else {
    const double size = angle.norm();
    return size > 0.0 ? rotation_about(angle / size, size) : Mat<3>::Identity();
  }
}

/// The angle [rad] of a rotation, times its axis.
template <int Dim>
Turn<Dim> angle_of(const Mat<Dim>& rotation) {
  if constexpr (Dim == 2) {
    return Turn<2>(std::atan2(rotation(1, 0), rotation(0, 0)));
  } else {
    return rotation_vector_of(rotation);
  }
}

/// A line from a body to a fixed anchor, or to another body.
template <int Dim>
struct Mooring {
  int body;          ///< index into CaseSpec::bodies
  int to_body = -1;  ///< index of the body at the other end; -1: a fixed anchor
  Vec<Dim> at;       ///< m; on the body, as drawn
  Vec<Dim> anchor;   ///< m; the other end, as drawn
  double stiffness;
  double length;  ///< m
  double damping;
};

/// Position and velocity of a body. The velocity is constant from `time` on, until the step ends.
template <int Dim>
struct BodyState {
  double time = 0.0;                   ///< s
  AffineMap<Dim> placement;            ///< from the drawn position to that at `time`
  Vec<Dim> centre = Vec<Dim>::Zero();  ///< m; of mass, at `time`
  Twist<Dim> velocity = Twist<Dim>::Zero();
  Twist<Dim> acceleration = Twist<Dim>::Zero();  ///< in the last step
  Twist<Dim> carried_over = Twist<Dim>::Zero();  ///< N s, N m s; impulse that has reached the body but not yet moved it

  Vec<Dim> linear_velocity() const { return velocity.template head<Dim>(); }
  Turn<Dim> angular_velocity() const { return velocity.template tail<turns<Dim>>(); }
  Vec<Dim> velocity_at(const Vec<Dim>& x) const {
    return linear_velocity() + velocity_about<Dim>(angular_velocity(), x - centre);
  }

  Vec<Dim> centre_at(double t) const { return centre + (t - time) * linear_velocity(); }
  AffineMap<Dim> at(double t) const;
  /// Advances the body to time t.
  void go_on(double t);
};

/// All bodies of a case.
template <int Dim>
struct BodyStates {
  std::vector<BodyState<Dim>> each;
  /// Matrix, row by row: the additional force on each degree of freedom of all bodies per acceleration of each, with
  /// the added mass of the water [kg, kg m, kg m^2]. Empty: not known.
  std::vector<double> inertia = {};
};

template <int Dim>
struct FloatingBody {
  /// Throws InputError, which names the body, for numbers of the wrong dimension.
  FloatingBody(const CaseSpec& spec, const BodyTable& table);

  std::string name;
  double mass;             ///< kg; in 2D per metre of width
  Turn<Dim> inertia;       ///< kg m^2; about the axes as drawn
  std::vector<int> free;   ///< indices of the free entries of a Twist
  BodyState<Dim> drawn;    ///< at the start
  std::vector<int> walls;  ///< indices into Boundary::walls
  // Entries for each degree of freedom, along and about the axes of the case.
  Twist<Dim> springs;            ///< N/m, N m/rad; towards the drawn position
  Twist<Dim> linear_damping;     ///< N s/m, N m s/rad
  Twist<Dim> quadratic_damping;  ///< N s^2/m^2, N m s^2/rad^2
  Twist<Dim> extra_mass;         ///< kg, kg m^2; without weight

  /// Force and moment that cause an acceleration of the body, without gyration.
  Twist<Dim> force_of(const BodyState<Dim>& state, const Twist<Dim>& acceleration) const;
  /// Mass, or the mean moment of inertia, for each entry of a Twist: a scale for comparisons.
  Twist<Dim> scale() const;
  /// Force and moment of dampers against a velocity, over that velocity. A quadratic damper has the factor of the
  /// velocity of `state`, so that no damping is too strong for the step.
  Twist<Dim> damping(const BodyState<Dim>& state) const;
  /// Force and moment of weight, gyration, springs and dampers.
  Twist<Dim> load(const BodyState<Dim>& state, const Vec<Dim>& gravity) const;

 private:
  Mat<Dim == 2 ? 1 : 3> inertia_of(const BodyState<Dim>& state) const;
};

template <int Dim>
std::vector<FloatingBody<Dim>> make_bodies(const CaseSpec& spec);

/// The index of the body for each of `walls` walls, or -1.
template <int Dim>
std::vector<int> bodies_of_walls(const std::vector<FloatingBody<Dim>>& bodies, std::size_t walls) {
  std::vector<int> body_of_wall(walls, -1);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (const int wall : bodies[b].walls) body_of_wall[wall] = static_cast<int>(b);
  }
  return body_of_wall;
}

/// Throws InputError, which names the line, for numbers of the wrong dimension.
template <int Dim>
std::vector<Mooring<Dim>> make_moorings(const CaseSpec& spec);

}  // namespace tailwater
