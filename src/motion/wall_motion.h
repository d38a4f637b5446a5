// Walls that move as rigid bodies, on a prescribed path or with the water: the place and velocity of each at a given
// time.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/vec.h"
#include "case/expression.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "motion/affine_map.h"
#include "motion/floating_body.h"
#include "motion/gate_law.h"
#include "motion/spline.h"
#include "motion/wave_maker.h"
#include "sampling/wall_particles.h"

namespace tailwater {

template <int Dim>
WallFace<Dim> moved(const AffineMap<Dim>& motion, WallFace<Dim> face);

/// How far a wall has moved and turned.
template <int Dim>
struct Placement {
  Vec<Dim> displacement = Vec<Dim>::Zero();  ///< m
  double angle = 0.0;                        ///< rad
};

/// A motion written in the case: numbers, or expressions of t.
template <int Dim>
class WrittenMotion {
 public:
  WrittenMotion(const CaseSpec& spec, const WallTable& table, const CaseLabel& owner);
  Placement<Dim> at(double time) const;

 private:
  struct Component {
    double number = 0.0;
    mutable std::vector<Formula> formula;  ///< at most one; mutable because evaluating writes the time into it
    double at(double time) const;
  };
  static Component make_component(const CaseSpec& spec, const Varying& value);

  std::vector<Component> displacement_;
  Component rotation_;
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

/// A gate's motion along a straight line.
template <int Dim>
class MotionOfGate {
 public:
  MotionOfGate(const CaseSpec& spec, const GateTable& gate);
  Placement<Dim> at(double time) const { return {law_.displacement(time) * direction_, 0.0}; }

 private:
  Vec<Dim> direction_;
  GateLaw law_;
};

/// A wave maker's motion: that of its own waves, and how far it has given way to others.
template <int Dim>
class MotionOfMaker {
 public:
  MotionOfMaker(const CaseSpec& spec, const WaveMakerTable& maker) : plate_(spec, maker) {}
  Placement<Dim> at(double time, const MakerState& state) const;
  const WavePlate<Dim>& plate() const { return plate_; }

 private:
  WavePlate<Dim> plate_;
};

/// A motion that a program gives which uses this one as a library.
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

  /// Takes the place of the motion; the pivot and the axis stay.
  void follow(GivenMotion<Dim> given) { motion_ = std::move(given); }

  /// The motion from where the wall is drawn to where it is at `time` [s] >= 0. It may be infinite or not a number.
  /// `maker` is the state of a wave maker.
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
  Vec<3> axis_ = Vec<3>::UnitZ();  ///< 3D; about which the wall turns
};

/// What the motion of walls depends on beside the time, in the order of the tables.
template <int Dim>
struct MotionState {
  std::vector<MakerState> wave_makers;
  BodyStates<Dim> bodies;
};

/// At the start: no wave maker has given way, and the bodies are where they are drawn.
template <int Dim>
MotionState<Dim> initial_motion(const CaseSpec& spec);

/// All walls of a case that move, as they are drawn.
template <int Dim>
class WallMotion {
 public:
  /// For a moving wall that slides along a periodic direction, adds its image one period back to the faces, so that the
  /// two together always cover the domain.
  WallMotion(const CaseSpec& spec, Boundary<Dim>& boundary, const WallParticles<Dim>& particles);

  struct MovingWall {
    int wall;  ///< index into Boundary::walls
    WallPath<Dim> path;
    Vec<Dim> period = Vec<Dim>::Zero();  ///< m; 0 in directions that do not repeat, or in which it does not move
    int maker = -1;                      ///< index into CaseSpec::wave_makers; -1: it is none
    int body = -1;                       ///< index into CaseSpec::bodies; -1: it is of none

    /// From where it is drawn to where it is at `time` [s].
    AffineMap<Dim> at(double time, const MotionState<Dim>& state) const;
    /// The same place one or more periods back, so that the wall and its image cover the domain.
    AffineMap<Dim> in_period(AffineMap<Dim> placement) const;
    /// From where it is drawn to its mean velocity [m/s] between two times [s].
    AffineMap<Dim> mean_velocity(double from, double to, const MotionState<Dim>& state) const;
  };
  const std::vector<MovingWall>& moving() const { return moving_; }

  /// From now on `moving()[which]`, which is of no body, takes a path that is given. Throws InputError, with the wall's
  /// `label`, if that begins farther than `off` [m] from where the wall is at `time` [s].
  void steer(std::size_t which, GivenMotion<Dim> given, double time, const MotionState<Dim>& state, double off,
             const std::string& label);

  /// Moves the faces and the particles of moving walls to their places at `time`.
  void place(double time, const MotionState<Dim>& state, Boundary<Dim>& boundary, WallParticles<Dim>& particles) const;

  /// Sets the entries of the particles of moving walls to their mean velocity [m/s] between two times [s].
  void get_mean_velocity(double from, double to, const MotionState<Dim>& state, std::span<Vec<Dim>> velocity) const;
  /// The same at an instant.
  void get_velocity(double time, const MotionState<Dim>& state, std::span<Vec<Dim>> velocity) const;

  /// The largest distance [m] that a corner of a wall moves from one time to the other.
  double largest_displacement(double from, double to, const MotionState<Dim>& state) const;

 private:
  double farthest_corner(int wall, const AffineMap<Dim>& before, const AffineMap<Dim>& after) const;

  /// A particle of a moving wall.
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
