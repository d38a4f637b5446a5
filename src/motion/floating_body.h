// Rigid bodies that float: their properties.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "base/vec.h"
#include "geometry/rotation.h"
#include "motion/affine_map.h"
#include "motion/motion_state.h"

namespace tailwater {

struct BodyTable;
struct CaseSpec;

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

/// rad/s; angular velocity of a rigid wall whose velocity is a function of the place.
template <int Dim>
Turn<Dim> angular_velocity_of(const AffineMap<Dim>& velocity) {
  const Mat<Dim>& spin = velocity.linear;
  if constexpr (Dim == 2) {
    return Turn<2>(spin(1, 0));
  } else {
    return {spin(2, 1), spin(0, 2), spin(1, 0)};
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

/// Longest step over 1/frequency of a line or spring with its load: its force is that of the start of the step.
inline constexpr double longest_step_of_springs = 0.5;

/// Largest angular frequency [1/s] of a line with the bodies at its ends as drawn; 0 if none of them gives way to it.
template <int Dim>
double frequency_of(const Mooring<Dim>& mooring, const std::vector<FloatingBody<Dim>>& bodies);

}  // namespace tailwater
