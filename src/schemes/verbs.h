// The verbs of a step, shared by the schemes: (F...) Farzin et al. (2014), (B...) Farmani et al. (2020). Each does one
// thing to the flow; explicit_projection.cpp, implicit_projection.cpp and two_step.cpp say in which order. On several
// ranks all call them together; what they return is the same on all.
//
// Gravity: the papers' predictors hold dt g, here u_star does not unless the walls are a row with dummies. A uniform
// vector has no divergence and the other wall rows ask for grad p . n = rho g . n, so the pressure is the same; the
// corrector adds dt g. It also keeps gravity from being counted twice at the walls (method.md 3) and the divergence of
// u_star small, so less cancels.
#pragma once

#include "closures/wall_contact.h"
#include "schemes/flow.h"

namespace tailwater {

/// Neighbours, ghosts, kernel values, concentration, wet walls, tensors and surface marks at the present positions.
/// With `keep_marks` the surface marks stay as they are (later passes of the implicit iteration freeze them).
template <int Dim>
void locate(Flow<Dim>& flow, bool keep_marks = false);

/// Wraps the particles into a periodic domain and keeps r^n, u^n and their energy: lists reach only a skin beyond the
/// domain, so no particle may stay outside for more than a step.
template <int Dim>
void remember(Flow<Dim>& flow);

/// Sums over this rank's fluid.
struct FluidSums {
  double mass = 0.0;            ///< kg (per metre of width in 2D)
  double kinetic_energy = 0.0;  ///< J
  double energy = 0.0;          ///< J; kinetic and potential
};

template <int Dim>
FluidSums fluid_sums_of_rank(const Flow<Dim>& flow);

/// Moving walls: the velocity that the projection gives the fluid beside them, and the acceleration of dt that leads
/// there. It is their mean velocity over the step, so that what they sweep is what the water leaves; with
/// `displacement = "mean-velocity"` that at its end. Needs `remember`.
template <int Dim>
void drive_walls(Flow<Dim>& flow, double dt);

/// The same with the velocity at the end of the step.
template <int Dim>
void drive_walls_to_end(Flow<Dim>& flow, double dt);

/// Moving walls, faces and particles, where they are at `time`.
template <int Dim>
void place_walls(Flow<Dim>& flow, double time);

/// How the walls move in a step of dt from flow.time.
template <int Dim>
WallWays<Dim> ways_of_walls(const Flow<Dim>& flow, double dt);

/// What holds at the open ends in this step: which particles are in an end stretch, their velocity, the level beyond.
/// Call once per step, at the positions where it starts.
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
template <int Dim>
void predict(Flow<Dim>& flow, double dt);

/// (B13): r = r^n + dt u_star, where the pressure equation of the two-step scheme is posed; walls move too. `move`
/// starts from r^n again.
template <int Dim>
void drift(Flow<Dim>& flow, double dt);

/// What the pressure equation shall leave of div u at its positions. Nothing as published (F18); with
/// `divergence_free = "midway"` the divergence dt/2 tr(grad u . grad u) that the same motion loses on the first half of
/// its way, so that the velocity is divergence-free there: second order in time, where (F18) loses the energy
/// dt |grad p|^2/rho per unit volume and time (docs/theory/robustness.md). Needs `predict`.
template <int Dim>
void aim(Flow<Dim>& flow, double dt);

/// The matrix of the pressure equation, one row per particle: fluid, surface, wall; of the right-hand sides only those
/// that no source decides.
template <int Dim>
void assemble_weights(Flow<Dim>& flow, Interventions& interventions);

/// (F15), (F22): lap p = rho/dt div u_star, or (B17): lap p = (rho_0 - rho)/dt^2; matrix and sources. Needs `aim`.
template <int Dim>
void assemble(Flow<Dim>& flow, double dt, Interventions& interventions);

/// Work [J] of the pressure on the expansion that the density source asks for: the energy it takes to lift water that
/// had come too close; 0 for sources without a share of the density error. Needs the pressure of this step and `locate`
/// at the positions of its equation.
template <int Dim>
double density_source_work(const Flow<Dim>& flow, double dt);

/// Work [J] of the pressure of moving walls on this rank's water in a step of dt. Needs the pressure of this step and
/// the walls' velocity that `correct` left.
template <int Dim>
double wall_work(const Flow<Dim>& flow, double dt);

/// Books the works of a step on this rank's water: of the density source, of moving walls, and of viscosity and
/// friction (what they dissipate, below 0, unless moving walls drag the water). Call after `correct`, before anything
/// moves.
template <int Dim>
void book_work(const Flow<Dim>& flow, double dt, StepReport& report);

/// Books the energy of the step, adds up the works of all ranks in `report`, and sets which share of the density source
/// the energy leaves to the next step: lifting water that had come too close costs what the scheme must have dissipated
/// before. The share of what expands falls from 1 to 0 while the energy rises to `energy_slack` above its least, the
/// work of walls apart; rises are slowly forgotten (docs/theory/robustness.md).
template <int Dim>
void balance_energy(Flow<Dim>& flow, StepReport& report);

/// Solves for the pressure, starting from the last one. Near the surface nothing holds the particles together, so
/// p_i >= 0 there is part of the equation: where a rough solution pulls, the diagonal of row i is divided by `interior`
/// (0 in the outermost rows, 1 inside; a dummy's by 0), and the system is solved again. With an M-matrix this can only
/// raise pressures, so no new row begins to pull (docs/theory/robustness.md); what does all the same is cut and
/// counted.
template <int Dim>
SolveReport solve(Flow<Dim>& flow, Interventions& interventions);

/// What follows a change of the fluid's pressure: dummies and ghosts are brought up to date.
template <int Dim>
void finish_pressure(Flow<Dim>& flow);

/// (F16), (F24), (B16), (B18): u = u_star + dt (g - grad p/rho).
template <int Dim>
void correct(Flow<Dim>& flow, double dt);

/// The scheme's pressure gradient of any field at fluid particle i.
template <int Dim>
Vec<Dim> gradient_at(const Flow<Dim>& flow, std::size_t i, const std::vector<double>& pressure);

/// A second projection, at the present positions: takes div u out of the velocity as far as `corrections` reach, and
/// adds what does it to the pressure, without suction near the surface (but for what lengths and mixing of corrections
/// bring back). The particles stay. Needs `locate`. Reports its one solve.
template <int Dim>
SolveReport reproject(Flow<Dim>& flow, double dt, Interventions& interventions);

/// r = r^n + dt u, or as published (F17), (F25), (B19): r = r^n + dt/2 (u^n + u); walls move too, and nobody passes
/// one.
template <int Dim>
void move(Flow<Dim>& flow, double dt, Interventions& interventions);

/// (F28)-(F32), or after Lind et al. (2012). Needs `locate` at the present positions.
template <int Dim>
void shift(Flow<Dim>& flow, double dt, Interventions& interventions);

/// Sets flow.divergence at the present positions and returns its rms over bulk fluid particles [1/s].
template <int Dim>
double bulk_divergence(Flow<Dim>& flow);

/// Reports the divergence at the present positions, and what the move since the last `bulk_divergence` made of it.
template <int Dim>
void measure_after_move(Flow<Dim>& flow, StepReport& report);

/// The fluid's largest speed [m/s].
template <int Dim>
double largest_speed(const Flow<Dim>& flow);

/// The largest allowed step [s] for the present velocities and the walls' ways.
template <int Dim>
double next_time_step(const Flow<Dim>& flow);

}  // namespace tailwater
