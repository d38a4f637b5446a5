// A part of a flow: one feature, such as open ends, floating bodies or enclosed air, with its setup, its state and its
// work fields of a step. The stages call the parts of a flow in the order of the list and know nothing else of them.
// A run without a feature does not construct its part.
//
// The functions below stand in the order in which a run calls them. Each does nothing unless a part overrides it. Each
// is called once per loop, never per particle, and on all ranks, so that it may be collective.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "base/box.h"
#include "base/json.h"
#include "base/vec.h"
#include "flow/role.h"
#include "flow/step.h"

namespace tailwater {

struct CaseSpec;
struct SolveReport;
struct WaterAmount;
template <int Dim>
struct Boundary;
template <int Dim>
struct Flow;
template <int Dim>
struct FrictionWall;
template <int Dim>
struct Setup;

/// What a part asks of the time step.
struct StepLimits {
  double speed = 0.0;                                     ///< m/s; the largest that it gives the water in the step
  double viscosity = 0.0;                                 ///< m^2/s; the largest that it adds to the water's
  double step = std::numeric_limits<double>::infinity();  ///< s; no step is longer, whatever the water does

  void include(const StepLimits& other);
};

/// How the indices of owned particles have changed.
enum class Reordering {
  sorted,  ///< all of them; particles may have gone to other ranks
  removed  ///< some particles were taken out, the others keep their order
};

/// Which of the projections of a step: the one that finds its velocity, or a second one, where the particles arrived.
enum class Projection { of_step, again };

/// A number of one step, for a column of steps.csv.
struct StepColumn {
  const char* name;
  double value;
};

/// Unknowns that are solved for together with the pressure.
class CoupledUnknowns {
 public:
  virtual ~CoupledUnknowns() = default;
  /// Solves the flow's pressure rows and the unknowns to a tolerance, for a guess. Collective.
  virtual SolveReport solve_roughly(double tolerance) = 0;
  /// The same until pressure and unknowns agree. Collective.
  virtual SolveReport solve(double tolerance) = 0;
  /// Called when the pressure is final. Collective.
  virtual void finish() {}
};

template <int Dim>
class Part {
 public:
  virtual ~Part() = default;

  // A run.

  /// Its name in checkpoints.
  virtual std::string_view name() const = 0;
  /// Whether water can leave or enter the domain through it, so that rows of the pressure change between steps.
  virtual bool is_open() const { return false; }
  /// Whether it changes rows of the pressure between a second projection and the next step.
  virtual bool changes_rows() const { return is_open(); }
  /// Whether it needs the forces of friction and of the last guard on the walls.
  virtual bool needs_wall_forces() const { return false; }
  /// Extends the box around the case [m] by what the part has of it, where it is now.
  virtual void extend_box(Box<Dim>& box) const;
  /// Called when the particles of the start are there. Throws InputError.
  virtual void begin(Flow<Dim>& flow);
  /// All that it needs to go on in a resumed run; the same on all ranks.
  virtual Json save() const;
  /// Goes on from there. Returns whether it is of the same case; throws Json::exception where it is of none.
  virtual bool restore(const Json& saved);

  // Between steps.

  /// Replaces particles by others of the same water. The pairs are those of the particles where they are now, except on
  /// ranks where is_located or has_pairs is false.
  virtual void adapt(Flow<Dim>& flow);
  /// Marks the owned particles that leave the flow, of those not marked yet, and counts them.
  virtual void take_out(const Flow<Dim>& flow, std::span<std::uint8_t> leaves);
  /// Adds particles. Returns whether there were any, on any rank.
  virtual bool bring_in(Flow<Dim>& flow);
  virtual void reordered(Reordering how);
  /// At the present velocities.
  virtual StepLimits step_limits(const Flow<Dim>& flow) const;

  // The beginning of a step.

  /// Sets the role of the owned particles that are not solved for, since the part gives them velocity and pressure.
  virtual void claim(const Flow<Dim>& flow, std::span<Role> role);
  /// At the positions where a step of `dt` begins; dt is 0 where only the pressure of the start is wanted.
  virtual void begin_step(Flow<Dim>& flow, double dt);

  /// Called when particles have moved, before their neighbours are found.
  virtual void arrive(Flow<Dim>& flow);

  // The prediction.

  /// Called before the velocity is predicted, and before a second projection. The part may change the velocity of owned
  /// particles, which it changes back in `correct`, `stay` or `project_again`.
  virtual void begin_projection(Flow<Dim>& flow, Projection projection, double dt);

  /// Adds to the viscosity [m^2/s] of all particles.
  virtual void add_viscosity(const Flow<Dim>& flow, std::span<double> viscosity) const;
  /// Called with the walls that rub each owned particle, which have friction, and the gradient of the present velocity.
  virtual void follow_friction(Flow<Dim>& flow, std::span<const FrictionWall<Dim>> walls,
                               std::span<const Mat<Dim>> velocity_gradient, double dt);
  /// Adds to the rate [1/s] at which owned particles lose the velocity with which the step starts. `rate` is empty
  /// until a part adds to it. The step ends with (u + dt a)/(1 + rate dt), which is stable for any rate.
  virtual void add_damping_rate(const Flow<Dim>& flow, const StepStart<Dim>& start, std::vector<double>& rate) const;
  /// Adds rate times target [m/s^2] where a damping rate approaches a target velocity instead of rest: that of the time
  /// at which the step starts, so that a flow that is the target stays so. `drive` is empty until a part adds to it.
  /// The step ends with (u + dt a + dt drive)/(1 + rate dt).
  virtual void add_relaxation(const Flow<Dim>& flow, const StepStart<Dim>& start, std::vector<Vec<Dim>>& drive) const;
  /// Adds to the acceleration [m/s^2] of owned particles.
  virtual void add_acceleration(const Flow<Dim>& flow, std::span<Vec<Dim>> acceleration) const;

  /// Changes the velocity [m/s] that owned particles have after a step of this acceleration [m/s^2] without pressure.
  virtual void change_prediction(const Flow<Dim>& flow, std::span<const Vec<Dim>> acceleration, double dt,
                                 std::span<Vec<Dim>> predicted);

  // The pressure.

  /// Changes the divergence [1/s] at which the projection of a step aims, for which the gradient of the velocity was
  /// used.
  virtual void change_target(const Flow<Dim>& flow, std::span<const Mat<Dim>> velocity_gradient, double dt,
                             std::span<double> target) const;
  /// Writes the rows of the particles that it claims. Those of other water have been written and may be changed.
  virtual void write_rows(Flow<Dim>& flow);
  /// Called when all rows have weights and sources, with the predicted velocity. May overwrite the sources and must put
  /// them back. Returns the iterations of its own solves.
  virtual int pose(Flow<Dim>& flow, std::span<const Vec<Dim>> predicted, double dt);
  /// Adds to the tension [Pa] that particles keep near the surface, ghosts too. `tension` is empty until a part adds.
  virtual void add_allowed_tension(const Flow<Dim>& flow, std::vector<double>& tension) const;
  /// The unknowns that it solves for with the pressure in this step; null: none. `drive` may follow them.
  virtual std::unique_ptr<CoupledUnknowns> couple(Flow<Dim>& flow, const PosedEquation& equation,
                                                  WallDrive<Dim>& drive);
  /// Called when the rows have been solved.
  virtual void finish_solve(Flow<Dim>& flow, double dt);
  /// Adds to the pressure [Pa] of owned particles what the part made of it in the last solve, beside the rows. Returns
  /// whether there was anything, on all ranks alike.
  virtual bool add_pressure(std::span<double> pressure) const;
  /// Takes that out.
  virtual void subtract_pressure(std::span<double> pressure) const;

  // The correction, and the end of a step.

  /// Called when the pressure has corrected the velocity, before anything moves.
  virtual void correct(Flow<Dim>& flow, double dt);
  /// Takes what pushes walls without the water out of a pressure [Pa], ghosts too.
  virtual void subtract_from_walls(const Flow<Dim>& flow, std::vector<double>& pressure) const;
  /// Adds its work [J] on this rank's water in a step of dt; `on_walls` is the pressure that pushes walls through
  /// water. Called when the pressure has corrected the velocity, and again, with what walls and ends work set to 0,
  /// after a second projection.
  virtual void add_work(const Flow<Dim>& flow, const std::vector<double>& on_walls, double dt, Works& works) const;
  /// Called when a second projection has added `correction` [Pa] to the pressure, where the particles arrived.
  virtual void project_again(Flow<Dim>& flow, const std::vector<double>& correction, double dt);
  /// Called after the pressure of the start was found: nothing has moved.
  virtual void stay(Flow<Dim>& flow);
  /// Called when particles and walls have arrived, before the time advances.
  virtual void finish_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

  // Results, the same on all ranks.

  /// Its columns of steps.csv, which are always the same, with their values in the last step.
  virtual std::vector<StepColumn> step_columns() const;
  /// Adds its blocks to summary.json.
  virtual void add_to_summary(const Flow<Dim>& flow, Json& summary) const;
  /// Adds the water that it took out and brought in since the start.
  virtual void add_passed_water(WaterAmount& departed, WaterAmount& arrived) const;
  /// Warns, once in a run, of what it does not do as the case prescribes. Called after each step of a run that writes
  /// a folder; only the root's warnings are shown.
  virtual void warn(const Flow<Dim>& flow);
  /// Warns at the end of such a run.
  virtual void warn_at_end(const Flow<Dim>& flow) const;
};

/// Makes a part of a case; null if the case has nothing of it. Throws InputError.
template <int Dim>
using PartMaker = std::unique_ptr<Part<Dim>> (*)(const CaseSpec& spec, const Setup<Dim>& setup,
                                                 const Boundary<Dim>& boundary);

}  // namespace tailwater
