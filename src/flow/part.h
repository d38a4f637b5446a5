// A part of a flow: one feature, such as open ends, floating bodies or enclosed air, with its setup, its state and its
// work fields of a step. The stages call the parts of a flow in the order of the list, only through this interface. A
// run without a feature does not construct its part.
//
// The functions below are listed in the order in which a run calls them. Each does nothing unless a part overrides it.
// Each is called once per loop, never per particle, and on all ranks, so that it may be collective.
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

/// Limits of the time step that a part requires.
struct StepLimits {
  double speed = 0.0;                                     ///< m/s; the largest that it gives the water in the step
  double viscosity = 0.0;                                 ///< m^2/s; the largest that it adds to the water's
  double step = std::numeric_limits<double>::infinity();  ///< s; upper limit of the step, independent of the water

  void include(const StepLimits& other);
};

/// Kind of a change of the indices of owned particles.
enum class Reordering {
  sorted,  ///< all indices; particles may have gone to other ranks
  removed  ///< some particles were removed, the others keep their order
};

/// Projections of a step: the one that computes its velocity, and a second one at the new positions.
enum class Projection { of_step, again };

/// Water that went from one place to another because particles were replaced by others.
template <int Dim>
struct MovedWater {
  Vec<Dim> from;
  Vec<Dim> to;
  double volume;  ///< m^Dim; of water
};

/// A number of one step, for a column of steps.csv.
struct StepColumn {
  const char* name;
  double value;
};

/// Unknowns that are solved for together with the pressure.
class CoupledUnknowns {
 public:
  virtual ~CoupledUnknowns() = default;
  /// Solves the flow's pressure rows and the unknowns to a tolerance, as an initial guess. Collective.
  virtual SolveReport solve_roughly(double tolerance) = 0;
  /// Solves them until pressure and unknowns agree. Collective.
  virtual SolveReport solve(double tolerance) = 0;
  /// Called when the pressure is final. Collective.
  virtual void finish() {}
};

template <int Dim>
class Part {
 public:
  virtual ~Part() = default;

  // The run as a whole.

  /// Name of the part in checkpoints.
  virtual std::string_view name() const = 0;
  /// Whether water can leave or enter the domain through the part, so that rows of the pressure change between steps.
  virtual bool is_open() const { return false; }
  /// Whether the part changes rows of the pressure between a second projection and the next step.
  virtual bool changes_rows() const { return is_open(); }
  /// Whether the part needs the forces of friction and of the last guard on the walls.
  virtual bool needs_wall_forces() const { return false; }
  /// Extends the box around the case [m] by the part's own geometry at its present position.
  virtual void extend_box(Box<Dim>& box) const;
  /// Called when the initial particles have been made. Throws InputError.
  virtual void begin(Flow<Dim>& flow);
  /// The part's state for a resumed run; the same on all ranks.
  virtual Json save() const;
  /// Continues from a saved state. Returns whether it belongs to the same case; throws Json::exception if it belongs to
  /// none.
  virtual bool restore(const Json& saved);

  // Between steps.

  /// Replaces particles by others of the same water. The pairs are those of the present positions, except on ranks
  /// where the surroundings are not current or has_pairs is false.
  virtual void adapt(Flow<Dim>& flow);
  /// Called when a part has replaced particles on any rank, with the water that this moved on this one. Collective.
  virtual void follow_moved_water(const Flow<Dim>& flow, std::span<const MovedWater<Dim>> moved);
  /// Marks the owned particles that leave the flow, unless they are marked already, and adds them to the part's
  /// records.
  virtual void take_out(const Flow<Dim>& flow, std::span<std::uint8_t> leaves);
  /// Adds particles. Returns whether any rank added some.
  virtual bool bring_in(Flow<Dim>& flow);
  virtual void reordered(Reordering how);
  /// Limits at the present velocities.
  virtual StepLimits step_limits(const Flow<Dim>& flow) const;

  /// m along the unit vector `down`; up to this place sums over pairs must have the whole pressure
  /// (flow/balanced_pressure.h).
  virtual double lowest_unbalanced(const Flow<Dim>& flow, const Vec<Dim>& down) const;

  // The beginning of a step.

  /// Sets the role of the owned particles whose velocity and pressure the part prescribes, so that they are not solved
  /// for.
  virtual void claim(const Flow<Dim>& flow, std::span<Role> role);
  /// Called at the positions where a step of `dt` begins; dt is 0 where only the initial pressure is computed.
  virtual void begin_step(Flow<Dim>& flow, double dt);

  /// Called when particles have moved, before the search for neighbours.
  virtual void arrive(Flow<Dim>& flow);

  // The prediction.

  /// Called before the velocity is predicted, and before a second projection. The part may change the velocity of owned
  /// particles; `correct`, `stay` or `project_again` must then change it back.
  virtual void begin_projection(Flow<Dim>& flow, Projection projection, double dt);

  /// Adds to the viscosity [m^2/s] of all particles.
  virtual void add_viscosity(const Flow<Dim>& flow, std::span<double> viscosity) const;
  /// Called with the wall friction of each owned particle, and with the gradient of the present velocity.
  virtual void follow_friction(Flow<Dim>& flow, std::span<const FrictionWall<Dim>> walls,
                               std::span<const Mat<Dim>> velocity_gradient, double dt);
  /// Adds to the rate [1/s] at which owned particles lose the velocity with which the step starts. `rate` is empty
  /// until a part adds to it. The step ends with (u + dt a)/(1 + rate dt), which is stable for any rate.
  virtual void add_damping_rate(const Flow<Dim>& flow, const StepStart<Dim>& start, std::vector<double>& rate) const;
  /// Adds rate times target [m/s^2] where a damping rate leads to a target velocity instead of rest. The target is that
  /// at the start of the step, so that a flow equal to the target stays so. `drive` is empty until a part adds to it.
  /// The step ends with (u + dt a + dt drive)/(1 + rate dt).
  virtual void add_relaxation(const Flow<Dim>& flow, const StepStart<Dim>& start, std::vector<Vec<Dim>>& drive) const;
  /// Adds to the acceleration [m/s^2] of owned particles.
  virtual void add_acceleration(const Flow<Dim>& flow, std::span<Vec<Dim>> acceleration) const;

  /// Changes the velocity [m/s] of owned particles after a step with this acceleration [m/s^2] and without pressure.
  virtual void change_prediction(const Flow<Dim>& flow, std::span<const Vec<Dim>> acceleration, double dt,
                                 std::span<Vec<Dim>> predicted);

  // The pressure.

  /// Changes the target divergence [1/s] of the projection of a step, which was computed from the velocity gradient.
  virtual void change_target(const Flow<Dim>& flow, std::span<const Mat<Dim>> velocity_gradient, double dt,
                             std::span<double> target) const;
  /// Writes the rows of the particles that the part claims. Rows of other water have been written and may be changed.
  virtual void write_rows(Flow<Dim>& flow);
  /// Called when all rows have weights and sources, with the predicted velocity. May overwrite the sources and must
  /// restore them. Returns the iterations of its own solves.
  virtual int pose(Flow<Dim>& flow, std::span<const Vec<Dim>> predicted, double dt);
  /// Adds to the tension [Pa] that particles sustain near the surface, ghosts too. `tension` is empty until a part
  /// adds.
  virtual void add_allowed_tension(const Flow<Dim>& flow, std::vector<double>& tension) const;
  /// The unknowns that the part solves for with the pressure in this step; null: none. `drive` may follow them.
  virtual std::unique_ptr<CoupledUnknowns> couple(Flow<Dim>& flow, const PosedEquation& equation,
                                                  WallDrive<Dim>& drive);
  /// Called with the pressure [Pa] that owned particles would have if surfaces and walls held any tension, and with the
  /// tension that they keep in full (pressure/tension.h), before that limit is applied.
  virtual void see_tension(const Flow<Dim>& flow, std::span<const double> pressure, const std::vector<double>& allowed);
  /// Called when the rows have been solved.
  virtual void finish_solve(Flow<Dim>& flow, double dt);
  /// Adds the part's own contribution from the last solve to the pressure [Pa] of owned particles. Returns whether
  /// there was any, the same on all ranks.
  virtual bool add_pressure(std::span<double> pressure) const;
  /// Subtracts the contribution of `add_pressure`.
  virtual void subtract_pressure(std::span<double> pressure) const;

  // The correction, and the end of a step.

  /// Called when the pressure has corrected the velocity, before anything moves.
  virtual void correct(Flow<Dim>& flow, double dt);
  /// Subtracts the contribution that acts on walls directly, not through the water, from a pressure [Pa], ghosts too.
  virtual void subtract_from_walls(const Flow<Dim>& flow, std::vector<double>& pressure) const;
  /// Adds the part's work [J] on this rank's water in a step of dt; `on_walls` is the pressure that acts on walls
  /// through water. Called when the pressure has corrected the velocity. Called again after a second projection, with
  /// the works of walls and ends set to 0.
  virtual void add_work(const Flow<Dim>& flow, const std::vector<double>& on_walls, double dt, Works& works) const;
  /// Called when a second projection has added `correction` [Pa] to the pressure, where the particles arrived.
  virtual void project_again(Flow<Dim>& flow, const std::vector<double>& correction, double dt);
  /// Called after the initial pressure was computed: nothing has moved.
  virtual void stay(Flow<Dim>& flow);
  /// Called when particles and walls have arrived, before the time advances.
  virtual void finish_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

  // Results; the same on all ranks.

  /// The part's columns of steps.csv, always the same ones, with their values in the last step.
  virtual std::vector<StepColumn> step_columns() const;
  /// Adds the part's blocks to summary.json.
  virtual void add_to_summary(const Flow<Dim>& flow, Json& summary) const;
  /// Adds the water that the part has removed and added since the start.
  virtual void add_passed_water(WaterAmount& departed, WaterAmount& arrived) const;
  /// Warns, once in a run, where the part deviates from the case. Called after each step of a run that writes a folder;
  /// only the root's warnings are shown.
  virtual void warn(const Flow<Dim>& flow);
  /// Warns at the end of such a run.
  virtual void warn_at_end(const Flow<Dim>& flow) const;
};

/// Makes a part of a case; null if the case does not use the feature. Throws InputError.
template <int Dim>
using PartMaker = std::unique_ptr<Part<Dim>> (*)(const CaseSpec& spec, const Setup<Dim>& setup,
                                                 const Boundary<Dim>& boundary);

}  // namespace tailwater
