// The stages of a step that do not involve the pressure: (F...) Farzin et al. (2014), (B...) Farmani et al. (2020).
// Each does one thing. It takes what it needs and returns what later stages need, so the signatures show the order. The
// stages of the pressure are in pressure/stages.h; explicit_projection.cpp, two_projections.cpp and two_step.cpp in
// schemes put all of them in order. Verbs are collective; a result about the whole flow is the same on all ranks.
#pragma once

#include "flow/flow.h"
#include "flow/measure.h"
#include "flow/step.h"
#include "walls/wall_contact.h"
#include "walls/wall_friction.h"

namespace tailwater {

/// Finds neighbours, ghosts, kernel values and `flow.surroundings` at the present positions.
template <int Dim>
void locate(Flow<Dim>& flow, SurfaceMarks marks = SurfaceMarks::found);

/// Wraps the particles into a periodic domain and returns r^n, u^n and their energy. Lists reach only a skin beyond the
/// domain, so no particle may stay outside for more than a step.
template <int Dim>
StepStart<Dim> save_step_start(Flow<Dim>& flow);

/// Makes particles of the walls that water may reach in the coming step and that are none yet. Indices stay, behind the
/// owned particles there may be more; then lists and ghosts are forgotten. Collective.
template <int Dim>
void gather_walls(Flow<Dim>& flow);

/// The same, and takes the walls away that the water has left. Indices change; call between steps only.
template <int Dim>
void regather_walls(Flow<Dim>& flow);

/// How moving walls are driven in a step of dt from a velocity [m/s] of each row: to their mean velocity over the step,
/// so that the water leaves exactly the space they sweep. With `displacement = "mean-velocity"`: to their velocity at
/// its end.
template <int Dim>
WallDrive<Dim> drive_walls(const Flow<Dim>& flow, const std::vector<Vec<Dim>>& from, double dt);

/// The same, to the velocity at the end of the step.
template <int Dim>
WallDrive<Dim> drive_walls_to_end(const Flow<Dim>& flow, const std::vector<Vec<Dim>>& from, double dt);

/// Moves the faces and particles of moving walls to their places at `time`.
template <int Dim>
void place_walls(Flow<Dim>& flow, double time);

/// How the walls move in a step of dt from the state's time.
template <int Dim>
WallDisplacements<Dim> displacements_of_walls(const Flow<Dim>& flow, double dt);

/// Sets the wall entries of `velocity` to the velocity that the walls show to the water, and brings ghosts up to date.
/// `V` is the walls' own velocity, one entry per row of their table.
template <int Dim>
void set_wall_velocities(const Flow<Dim>& flow, std::span<const Vec<Dim>> V, std::vector<Vec<Dim>>& velocity);

/// With `divergence_free = "midway"`: shows curved and rotating walls as they are at mid-step (walls/turning_walls.h),
/// in a step of dt from `start`. Sets the wall entries of `velocity`, which `set_wall_velocities` has set, and the
/// flow's `turning`.
template <int Dim>
void set_wall_velocities_at_mid_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt,
                                     std::vector<Vec<Dim>>& velocity);

/// Gives each owned particle its role in this step. Call once per step, at the positions where it starts, before all
/// that goes by roles.
template <int Dim>
void assign_roles(Flow<Dim>& flow);

/// Lets parts replace particles by others of the same water; indices change then. Call between steps only, before
/// `remove_outflow`, and not at steps at which particles are sorted. Collective.
template <int Dim>
void adapt(Flow<Dim>& flow);

/// Removes the particles that parts take out. Returns whether this rank had any; if so, its indices have changed and
/// its lists are gone. Call between steps only. Collective.
template <int Dim>
bool remove_outflow(Flow<Dim>& flow);

/// Adds the particles that parts bring in. Returns whether there were any, on any rank; if so, lists are gone. Call
/// between steps only, after `remove_outflow`. Collective.
template <int Dim>
bool add_inflow(Flow<Dim>& flow);

/// Sorts the particles of this rank in the order that suits the pressure solver: in slabs where it sweeps through the
/// rows of the matrix, along a Z curve where a multigrid takes them by cells (docs/theory/neighbours.md). Indices
/// change; call between steps only.
template <int Dim>
void sort_particles(Flow<Dim>& flow);

/// Hands particles to the ranks that own their places and sorts those of each rank for the cache. Cuts space again when
/// work is shared too unevenly. Indices change; call between steps only.
template <int Dim>
Repartition repartition(Flow<Dim>& flow);

/// (F14), (F21), (B11), (B12): u_star = u^n + dt (nu lap u + div tau/rho), with derivatives of the present velocity at
/// the present positions.
///
/// The papers' predictors include dt g. Here u_star includes it only where the wall model says so (wall_model.h).
/// Otherwise `correct` adds dt g, and the pressure is the same: a uniform vector has no divergence, and the wall rows
/// prescribe grad p . n = rho g . n. The divergence of u_star is then small, so fewer digits cancel.
template <int Dim>
Prediction<Dim> predict(Flow<Dim>& flow, const StepStart<Dim>& start, const WallDrive<Dim>& drive, double dt);

/// (B13): r = r^n + dt u_star; walls move too. The two-step scheme poses its pressure equation there. `move` starts
/// from r^n again.
template <int Dim>
void drift(Flow<Dim>& flow, const StepStart<Dim>& start, const Prediction<Dim>& predicted, double dt);

/// r = r^n + dt u, or as published (F17), (F25), (B19): r = r^n + dt/2 (u^n + u). Walls move too. Particles are kept in
/// front of walls; returns how many would have passed one.
template <int Dim>
std::size_t move(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// (F28)-(F32), or after Lind et al. (2012). Needs `locate` at the present positions.
template <int Dim>
Interventions shift(Flow<Dim>& flow, double dt);

/// The largest rate [m/s] at which two neighbours in the water come nearer to each other, or less where none comes so
/// near in a step that it matters. Needs `locate` at the present positions and the velocities of ghosts. Collective.
template <int Dim>
double largest_approach(Flow<Dim>& flow);

/// What the parts ask of the next time step. Collective.
template <int Dim>
StepLimits step_limits(const Flow<Dim>& flow);

/// The largest step [s] that the water allows at its present velocities, with the speeds and viscosities of the parts,
/// whatever the walls do.
template <int Dim>
double step_of_water(const Flow<Dim>& flow, const StepLimits& limits);

/// The largest allowed step [s] for the present velocities and the motion of the walls.
template <int Dim>
double next_time_step(const Flow<Dim>& flow);

}  // namespace tailwater
