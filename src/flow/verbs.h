// The verbs of a step that have nothing to do with pressure: (F...) Farzin et al. (2014), (B...) Farmani et al. (2020).
// Each does one thing; what it takes is what it needs, and what it returns is what later verbs need, so the signatures
// tell the order. The verbs of the pressure are in pressure/verbs.h; explicit_projection.cpp, implicit_projection.cpp
// and two_step.cpp in schemes put all of them in order. On several ranks all call them together; what they return of
// the whole flow is the same on all.
#pragma once

#include "flow/flow.h"
#include "flow/measure.h"
#include "flow/step.h"
#include "walls/wall_contact.h"

namespace tailwater {

/// Finds neighbours, ghosts, kernel values and `flow.here` at the present positions. With `keep_marks` the surface
/// marks stay as they are (later passes of the implicit iteration freeze them).
template <int Dim>
void locate(Flow<Dim>& flow, bool keep_marks = false);

/// Wraps the particles into a periodic domain and keeps r^n, u^n and their energy: lists reach only a skin beyond the
/// domain, so no particle may stay outside for more than a step.
template <int Dim>
StepStart<Dim> remember(Flow<Dim>& flow);

/// Where moving walls are driven in a step of dt from `start`: to their mean velocity over the step, so that what they
/// sweep is what the water leaves; with `displacement = "mean-velocity"` to that at its end.
template <int Dim>
WallDrive<Dim> drive_walls(const Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// The same to the velocity at the end of the step.
template <int Dim>
WallDrive<Dim> drive_walls_to_end(const Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// Puts moving walls, faces and particles, where they are at `time`.
template <int Dim>
void place_walls(Flow<Dim>& flow, double time);

/// How the walls move in a step of dt from the state's time.
template <int Dim>
WallWays<Dim> ways_of_walls(const Flow<Dim>& flow, double dt);

/// Sets the wall entries of `velocity` to what the walls, moving at `V` by row of their table, show to the water, and
/// brings ghosts up to date.
template <int Dim>
void show_walls(const Flow<Dim>& flow, std::span<const Vec<Dim>> V, std::vector<Vec<Dim>>& velocity);

/// Finds what holds at the open ends in this step: which particles are in an end stretch, their velocity, the level
/// beyond. Call once per step, at the positions where it starts.
template <int Dim>
void hold_open_ends(Flow<Dim>& flow, double dt);

/// Takes out and books the particles that have passed an outlet. Returns whether this rank had any; then its indices
/// have changed and its lists are gone. Call between steps only.
template <int Dim>
bool let_go(Flow<Dim>& flow);

/// Hands particles to the ranks that own their places, which are chosen anew when work is shared too unevenly, and
/// sorts those of each rank for the cache: indices change. Call between steps only.
template <int Dim>
Sharing share_out(Flow<Dim>& flow);

/// (F14), (F21), (B11), (B12): u_star = u^n + dt (nu lap u + div tau/rho), derivatives of the present velocity at the
/// present positions.
///
/// The papers' predictors hold dt g. Here u_star does so only where the wall model says so (wall_model.h): a uniform
/// vector has no divergence, and the rows of the other wall models ask for grad p . n = rho g . n, so the pressure is
/// the same, and `correct` adds dt g. The divergence of u_star is then small, so less cancels.
template <int Dim>
Prediction<Dim> predict(Flow<Dim>& flow, const StepStart<Dim>& start, const WallDrive<Dim>& drive, double dt);

/// (B13): r = r^n + dt u_star, where the pressure equation of the two-step scheme is posed; walls move too. `move`
/// starts from r^n again.
template <int Dim>
void drift(Flow<Dim>& flow, const StepStart<Dim>& start, const Prediction<Dim>& predicted, double dt);

/// r = r^n + dt u, or as published (F17), (F25), (B19): r = r^n + dt/2 (u^n + u); walls move too, and nobody passes
/// one. Returns how many particles would have.
template <int Dim>
std::size_t move(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// (F28)-(F32), or after Lind et al. (2012). Needs `locate` at the present positions.
template <int Dim>
Interventions shift(Flow<Dim>& flow, double dt);

/// The largest allowed step [s] for the present velocities and the walls' ways.
template <int Dim>
double next_time_step(const Flow<Dim>& flow);

}  // namespace tailwater
