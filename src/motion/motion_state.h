// State of the walls that do not move on a prescribed path alone: wave makers that absorb, and bodies that float.
#pragma once

#include <vector>

#include "base/vec.h"
#include "motion/affine_map.h"

namespace tailwater {

/// Displacement by which an absorbing plate has given way, and its rate.
struct MakerState {
  double correction = 0.0;  ///< m; at `time`
  double rate = 0.0;        ///< m/s
  double time = 0.0;        ///< s

  double at(double t) const { return correction + rate * (t - time); }
};

/// Axes about which a body can turn: one in 2D.
template <int Dim>
inline constexpr int turns = Dim == 2 ? 1 : 3;

template <int Dim>
using Turn = Vec<turns<Dim>>;

/// Motion or load of a rigid body: first the entries along the axes, then those about the axes. A velocity [m/s,
/// rad/s], an acceleration, or a force with its moment [N, N m].
template <int Dim>
using Twist = Vec<Dim + turns<Dim>>;

/// omega x arm
template <int Dim>
Vec<Dim> velocity_about(const Turn<Dim>& omega, const Vec<Dim>& arm) {
  if constexpr (Dim == 2) {
    return {-omega[0] * arm[1], omega[0] * arm[0]};
  } else {
    return omega.cross(arm);
  }
}

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

/// State on which the motion of walls depends besides time, in the order of the tables.
template <int Dim>
struct MotionState {
  std::vector<MakerState> wave_makers;
  BodyStates<Dim> bodies;
};

}  // namespace tailwater
