// Walls that move as rigid bodies, on a prescribed path or with the water: the place and velocity of each at a given
// time.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/vec.h"
#include "case/spec.h"
#include "case/time_function.h"
#include "geometry/boundary.h"
#include "motion/affine_map.h"
#include "motion/floating_body.h"
#include "motion/gate_law.h"
#include "motion/motion_state.h"
#include "motion/spline.h"
#include "motion/wave_maker.h"
#include "sampling/wall_particles.h"

namespace tailwater {

template <int Dim>
WallFace<Dim> moved(const AffineMap<Dim>& motion, WallFace<Dim> face);

/// Displacement and rotation of a wall.
template <int Dim>
struct Placement {
  Vec<Dim> displacement = Vec<Dim>::Zero();  ///< m
  double angle = 0.0;                        ///< rad
};

/// A motion given in the case by numbers or by expressions of t.
template <int Dim>
class WrittenMotion {
 public:
  WrittenMotion(const CaseSpec& spec, const WallTable& table, const CaseLabel& owner);
  Placement<Dim> at(double time) const;

 private:
  std::vector<TimeFunction> displacement_;
  TimeFunction rotation_;
};

/// A motion from a file: the spline through its samples.
template <int Dim>
class MotionOfFile {
 public:
  explicit MotionOfFile(const TimeSeries& series);
  Placement<Dim> at(double time) const;

 private:
  std::array<std::optional<Spline>, Dim> displacement_;
  std::optional<Spline> angle_;
};

/// Motion of a gate along a straight line.
template <int Dim>
class MotionOfGate {
 public:
  MotionOfGate(const CaseSpec& spec, const GateTable& gate);
  Placement<Dim> at(double time) const { return {law_.displacement(time) * direction_, 0.0}; }

 private:
  Vec<Dim> direction_;
  GateLaw law_;
};

/// Motion of a wave maker: that of its own waves, and the displacement by which it absorbs other waves.
template <int Dim>
class MotionOfMaker {
 public:
  MotionOfMaker(const CaseSpec& spec, const WaveMakerTable& maker) : plate_(spec, maker) {}
  Placement<Dim> at(double time, const MakerState& state) const;
  const WavePlate<Dim>& plate() const { return plate_; }

 private:
  WavePlate<Dim> plate_;
};

/// A motion given by a program that uses this one as a library.
template <int Dim>
struct GivenMotion {
  std::function<Placement<Dim>(double time)> path;

  Placement<Dim> at(double time) const { return path(time); }
};

/// The path of one wall, from its table in the case file.
template <int Dim>
class WallPath {
 public:
  /// Throws CaseError for components or a pivot of the wrong dimension.
  WallPath(const CaseSpec& spec, const WallTable& table, const CaseLabel& owner);

  /// Replaces the motion; the pivot and the axis stay.
  void follow(GivenMotion<Dim> given) { motion_ = std::move(given); }

  /// The motion from the wall as drawn to its position at `time` [s] >= 0. It may be infinite or not a number. `maker`
  /// is the state of a wave maker.
  AffineMap<Dim> at(double time, const MakerState& maker = {}) const;
  AffineMap<Dim> at(const Placement<Dim>& placement) const;

  /// Maps x to the mean velocity [m/s], between two times [s], of the point that is drawn at x.
  AffineMap<Dim> mean_velocity(double from, double to) const;

 private:
  using Motion =
      std::variant<WrittenMotion<Dim>, MotionOfFile<Dim>, MotionOfGate<Dim>, MotionOfMaker<Dim>, GivenMotion<Dim>>;
  static Motion make_motion(const CaseSpec& spec, const WallTable& table, const CaseLabel& owner);

  Motion motion_;
  Vec<Dim> pivot_;
  Vec<3> axis_ = Vec<3>::UnitZ();  ///< 3D; axis of the wall's rotation
};

/// The state at the start: no wave maker has absorbed waves yet, and the bodies are where they are drawn.
template <int Dim>
MotionState<Dim> initial_motion(const CaseSpec& spec);

/// All moving walls of a case, as drawn.
template <int Dim>
class WallMotion {
 public:
  /// For a moving wall that slides along a periodic direction, adds its image one period back to the faces. Wall and
  /// image together always cover the domain.
  WallMotion(const CaseSpec& spec, Boundary<Dim>& boundary, const WallParticles<Dim>& particles);

  struct MovingWall {
    int wall;  ///< index into Boundary::walls
    WallPath<Dim> path;
    Vec<Dim> period = Vec<Dim>::Zero();  ///< m; 0 in directions that are not periodic, or without motion of the wall
    int maker = -1;                      ///< index into CaseSpec::wave_makers; -1: no wave maker
    int body = -1;                       ///< index into CaseSpec::bodies; -1: no body

    /// The motion from the wall as drawn to its position at `time` [s].
    AffineMap<Dim> at(double time, const MotionState<Dim>& state) const;
    /// The placement one or more periods back, so that the wall and its image cover the domain.
    AffineMap<Dim> in_period(AffineMap<Dim> placement) const;
    /// Maps x, as drawn, to the mean velocity [m/s] between two times [s].
    AffineMap<Dim> mean_velocity(double from, double to, const MotionState<Dim>& state) const;
  };
  const std::vector<MovingWall>& moving() const { return moving_; }
  /// Whether walls move that belong to no body.
  bool has_paths() const {
    return std::ranges::any_of(moving_, [](const MovingWall& moving) { return moving.body < 0; });
  }

  /// Replaces the path of `moving()[which]`, which belongs to no body. Throws InputError, with the wall's `label`, if
  /// the new path begins farther than `off` [m] from the wall's position at `time` [s].
  void steer(std::size_t which, GivenMotion<Dim> given, double time, const MotionState<Dim>& state, double off,
             const std::string& label);

  /// Moves the faces and the particles of moving walls to their places at `time`.
  void place(double time, const MotionState<Dim>& state, Boundary<Dim>& boundary, WallParticles<Dim>& particles) const;

  /// Sets the entries of the particles of moving walls to their mean velocity [m/s] between two times [s].
  void get_mean_velocity(double from, double to, const MotionState<Dim>& state, std::span<Vec<Dim>> velocity) const;
  /// Sets the entries of the particles of moving walls to their velocity [m/s] at `time` [s].
  void get_velocity(double time, const MotionState<Dim>& state, std::span<Vec<Dim>> velocity) const;

  /// The largest distance [m] that a corner of a wall moves between two times [s].
  double largest_displacement(double from, double to, const MotionState<Dim>& state) const;

 private:
  double farthest_corner(int wall, const AffineMap<Dim>& before, const AffineMap<Dim>& after) const;

  /// A particle of a moving wall, as drawn.
  struct DrawnParticle {
    std::size_t row;  ///< of the table of wall particles
    int wall;
    Vec<Dim> position;
    Vec<Dim> normal;
    Mat<Dim> blocked;
    Mat<Dim> beyond_edges;
  };

  std::vector<MovingWall> moving_;
  std::vector<WallFace<Dim>> drawn_faces_;  ///< none if no wall moves
  std::vector<DrawnParticle> drawn_particles_;
};

}  // namespace tailwater
