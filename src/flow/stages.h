// The stages of a step that do not involve the pressure: (F...) Farzin et al. (2014), (B...) Farmani et al. (2020).
// Each does one thing. Its arguments are its input, and it returns the input of later stages, so the signatures show
// the order. The stages of the pressure are in pressure/stages.h; explicit_projection.cpp, two_projections.cpp and
// two_step.cpp in schemes call all stages in order. Stages are collective; a result about the whole flow is the same on
// all ranks.
#pragma once

#include "flow/flow.h"
#include "flow/measure.h"
#include "flow/step.h"
#include "walls/wall_contact.h"
#include "walls/wall_friction.h"

namespace tailwater {

struct Repartition;

/// Computes neighbours, ghosts, kernel sums and `flow.surroundings` at the present positions.
template <int Dim>
void locate(Flow<Dim>& flow, SurfaceMarks marks = SurfaceMarks::found);

/// Wraps the particles into a periodic domain and returns r^n, u^n and their energy. Lists reach only a skin beyond the
/// domain, so no particle may stay outside for more than a step.
template <int Dim>
StepStart<Dim> save_step_start(Flow<Dim>& flow);

/// Makes particles of those walls that water may reach in the coming step and that have none yet. Indices stay;
/// particles may be appended to the owned ones, and then lists and ghosts are discarded. Collective.
template <int Dim>
void gather_walls(Flow<Dim>& flow);

/// Does the same as gather_walls, and removes the walls that the water has left. Indices change; call between steps
/// only.
template <int Dim>
void regather_walls(Flow<Dim>& flow);

/// Drives moving walls in a step of dt from a velocity [m/s] of each row to their mean velocity over the step, so that
/// the water leaves exactly the volume that they sweep. With `displacement = "mean-velocity"`: to their velocity at its
/// end.
template <int Dim>
WallDrive<Dim> drive_walls(const Flow<Dim>& flow, const std::vector<Vec<Dim>>& from, double dt);

/// Drives moving walls to their velocity at the end of the step.
template <int Dim>
WallDrive<Dim> drive_walls_to_end(const Flow<Dim>& flow, const std::vector<Vec<Dim>>& from, double dt);

/// Moves the faces and particles of moving walls, and zones of refinement, to their places at `time`.
template <int Dim>
void place_walls(Flow<Dim>& flow, double time);

/// Displacements of the walls in a step of dt from the state's time.
template <int Dim>
WallDisplacements<Dim> displacements_of_walls(const Flow<Dim>& flow, double dt);

/// Sets the wall entries of `velocity` to the velocity that the walls show to the water, and brings ghosts up to date.
/// `V` is the walls' own velocity, one entry per row of their table.
template <int Dim>
void set_wall_velocities(const Flow<Dim>& flow, std::span<const Vec<Dim>> V, std::vector<Vec<Dim>>& velocity);

/// With `divergence_free = "midway"`: shows curved and rotating walls as they are at mid-step (walls/turning_walls.h),
/// in a step of dt from `start`. Changes the wall entries of `velocity` after `set_wall_velocities`, and sets the
/// walls' `turn_acceleration`.
template <int Dim>
void set_wall_velocities_at_mid_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt,
                                     std::vector<Vec<Dim>>& velocity);

/// Assigns each owned particle its role in this step. Call once per step, at the positions where it starts, before any
/// stage that depends on roles.
template <int Dim>
void assign_roles(Flow<Dim>& flow);

/// Lets parts replace particles by others of the same water; indices change then. Call between steps only, before
/// `remove_outflow`, and not at steps at which particles are sorted. Collective.
template <int Dim>
void adapt(Flow<Dim>& flow);

/// Removes the particles that parts take out. Returns whether this rank had any; if so, its indices have changed and
/// its lists are discarded. Call between steps only. Collective.
template <int Dim>
bool remove_outflow(Flow<Dim>& flow);

/// Adds the particles that parts bring in. Returns whether any rank added some; if so, lists are discarded. Call
/// between steps only, after `remove_outflow`. Collective.
template <int Dim>
bool add_inflow(Flow<Dim>& flow);

/// Sorts the particles of this rank in the order that suits the pressure solver: in slabs for a solver that sweeps
/// through the rows of the matrix, along a Z curve for a multigrid solver that groups them by cells
/// (docs/theory/neighbours.md). Indices change; call between steps only.
template <int Dim>
void sort_particles(Flow<Dim>& flow);

/// Moves particles to the ranks that own their places and sorts those of each rank for the cache. Divides space again
/// when the work is too unevenly distributed. Indices change; call between steps only.
template <int Dim>
Repartition repartition(Flow<Dim>& flow);

/// (F14), (F21), (B11), (B12): u_star = u^n + dt (nu lap u + div tau/rho), with derivatives of the present velocity at
/// the present positions.
///
/// The papers' predictors include dt g. Here u_star includes it only where the formulation requires it (formulation.h).
/// Otherwise `correct` adds dt g, and the pressure is the same: a uniform vector has no divergence, and the wall rows
/// prescribe grad p . n = rho g . n. The divergence of u_star is then small, so cancellation loses fewer digits.
template <int Dim>
Prediction<Dim> predict(Flow<Dim>& flow, const StepStart<Dim>& start, const WallDrive<Dim>& drive, double dt);

/// (B13): r = r^n + dt u_star; walls move too. The two-step scheme poses its pressure equation there. `move` starts
/// from r^n again.
template <int Dim>
void drift(Flow<Dim>& flow, const StepStart<Dim>& start, const Prediction<Dim>& predicted, double dt);

/// r = r^n + dt u, or as published (F17), (F25), (B19): r = r^n + dt/2 (u^n + u). Walls move too. Particles are kept in
/// front of walls; returns the number of those that would have passed one.
template <int Dim>
std::size_t move(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// (F28)-(F32), or after Lind et al. (2012). Needs `locate` at the present positions.
template <int Dim>
Interventions shift(Flow<Dim>& flow, double dt);

/// The largest rate [m/s] at which two neighbours in the water approach each other. May be too small where no approach
/// in a step is close enough to matter. Needs `locate` at the present positions and the velocities of ghosts.
/// Collective.
template <int Dim>
double largest_approach(Flow<Dim>& flow);

/// Limits of the parts for the next time step. Collective.
template <int Dim>
StepLimits step_limits(const Flow<Dim>& flow);

/// The largest step [s] that the water allows at its present velocities, with the speeds and viscosities of the parts,
/// without regard to walls.
template <int Dim>
double step_of_water(const Flow<Dim>& flow, const StepLimits& limits);

/// The largest allowed step [s] for the present velocities and the motion of the walls.
template <int Dim>
double next_time_step(const Flow<Dim>& flow);

}  // namespace tailwater
