// The stages of the pressure: (F...) Farzin et al. (2014), (B...) Farmani et al. (2020). As in flow/stages.h the
// signatures follow the order of calls: target, assemble, solve, correct, balance; a second projection at the new
// positions of the particles.
#pragma once

#include <span>
#include <vector>

#include "flow/stages.h"

namespace tailwater {

/// Target of div u [1/s], owned: the divergence that the pressure equation shall leave at its positions. Zero as
/// published (F18); with `divergence_free = "midway"` the divergence dt/2 tr(grad u . grad u) that the same motion
/// loses on the first half of its displacement. The velocity is then divergence-free at that point: second order in
/// time, where (F18) loses the energy dt |grad p|^2/rho per unit volume and time (docs/theory/robustness.md). Takes the
/// gradient of u^n, which no later stage needs, and frees it before the matrix is made.
template <int Dim>
std::vector<double> target_divergence(const Flow<Dim>& flow, std::vector<Mat<Dim>> velocity_gradient, double dt);

/// Writes the matrix of the pressure equation, one row per particle (fluid, surface, wall), and those right-hand sides
/// that do not depend on a source. If there is a matrix of these positions, writes only the latter. Returns the number
/// of rows that fell back to two-point weights.
template <int Dim>
std::size_t assemble_weights(Flow<Dim>& flow, const WallDrive<Dim>& drive);

/// (F15), (F22): lap p = rho/dt (div u_star - target), or (B17): lap p = (rho_0 - rho)/dt^2; matrix and sources.
template <int Dim>
PosedEquation assemble(Flow<Dim>& flow, const Prediction<Dim>& predicted, std::span<const double> target,
                       const WallDrive<Dim>& drive, double dt);

/// Solves for the pressure, starting from the last one, together with the unknowns of parts, which `drive` may follow.
/// Near the surface no force holds the particles together, so p_i >= 0 there is part of the equation. Where a rough
/// solution has tension, the diagonal of row i is divided by `interior` (0 in the outermost rows, 1 inside), or by 0
/// for a wall. The system is then solved again. With an M-matrix this can only raise pressures, so no new row gets
/// tension (docs/theory/robustness.md). The matrix is discarded.
template <int Dim>
PressureReport solve(Flow<Dim>& flow, const PosedEquation& equation, WallDrive<Dim>& drive);

/// Updates walls and ghosts after a change of the water's pressure, and sets the walls' `acceleration`. `allowed` is
/// the tension [Pa] that particles keep in full (tension.h).
template <int Dim>
void finish_pressure(Flow<Dim>& flow, const WallDrive<Dim>& drive, const std::vector<double>& allowed);

/// Adds the pressure that parts make in addition to the rows, and updates ghosts.
template <int Dim>
void add_pressure_of_parts(Flow<Dim>& flow);

/// (F16), (F24), (B16), (B18): u = u_star + dt (g - grad p/rho). The walls move as they are driven.
template <int Dim>
void correct(Flow<Dim>& flow, const Prediction<Dim>& predicted, const WallDrive<Dim>& drive, double dt);

/// Adds the forces of the pressure to those on the walls in this step, if a probe needs them. Collective.
template <int Dim>
void find_wall_forces(Flow<Dim>& flow);

/// Adds those of the pairs of a pressure field [Pa] that is up to date on ghosts.
template <int Dim>
void add_wall_forces(Flow<Dim>& flow, const std::vector<double>& pressure);

struct SecondProjection {
  PressureReport report;
  std::vector<double> correction;  ///< Pa; its change of the pressure, up to date on ghosts
};

/// Projects the velocity a second time, at the present positions: removes div u, and adds the correction to the
/// pressure, without tension near the surface. The particles stay.
template <int Dim>
SecondProjection reproject(Flow<Dim>& flow, const WallDrive<Dim>& drive, double dt);

/// Works of a step on this rank's water. Call after `correct`, before anything moves.
template <int Dim>
Works work_of_step(const Flow<Dim>& flow, const StepStart<Dim>& start, const Prediction<Dim>& predicted,
                   const PosedEquation& equation, double dt);

/// Works [J] on this rank's water, in a step of dt, of the pressure of moving walls and of the parts; the others are 0.
/// Needs the pressure of this step and the velocity of walls after `correct`. `from` is the velocity [m/s] of each row
/// of moving walls before the step, with its direction at the present place of the row.
template <int Dim>
Works work_of_boundaries(const Flow<Dim>& flow, std::span<const Vec<Dim>> from, double dt);

/// Sums the works of all ranks in `report`, balances the energy of the step, and sets the fraction of the density
/// source for the next step. Lifting water whose particles had come too close needs energy that the scheme must have
/// dissipated before. The fraction falls from 1 to 0 while the energy rises to `energy_slack` above its minimum, the
/// work of walls and open ends apart; rises are slowly forgotten (docs/theory/robustness.md).
template <int Dim>
void balance_energy(Flow<Dim>& flow, const StepStart<Dim>& start, StepReport& report);

}  // namespace tailwater
