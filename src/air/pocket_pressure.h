// Pockets of enclosed air in the pressure equation (docs/theory/air.md). Beside a pocket missing neighbours count as
// air at its pressure P_k instead of 0. With the share chi_ik of the air around particle i that is pocket k,
//
//   row i:       ... = source_i + a_i sum_k chi_ik P_k,    a_i closes the row (robust/rows.cpp)
//   water at i:  grad p_i - sum_k P_k chi_ik grad 1_i
//
// The pressure is linear in P,
//
//   p = p_w + sum_k P_k q_k,
//
// where p_w is what the water has under air at 0, and q_k answers to 1 Pa in pocket k, from 0 to 1 in space. With its
// force F_k = chi_k grad 1 - grad q_k on the water
//
//   pocket k:    dV_k/dt = sum_i w_i F_k,i . u_i + what it works on walls that move
//
// so the gas gives away what the water and the walls get, whatever q_k is. Dummies have the mean chi of the water
// beside them. Suction is that of p_w: what pulls is what is below the pressure that the air alone makes, by more than
// that has fallen itself.
#pragma once

#include "air/enclosed_air.h"

namespace tailwater {

/// Finds where water and walls look into pockets and brings the responses q_k up to date, with the matrix of the
/// pressure equation. Overwrites its sources meanwhile. Collective.
template <int Dim>
PocketStep<Dim> pose_pockets(Flow<Dim>& flow, EnclosedAir<Dim>& air, std::span<const Vec<Dim>> predicted, double dt);

/// The pressures [Pa] of the pockets in a step of dt with which gas and water agree, where p_w has been solved for and
/// is up to date on walls and ghosts, and walls move as they do now. Collective.
template <int Dim>
std::vector<double> find_air_pressures(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, double dt);

/// By how much [Pa] they (rows) fall for each m^Dim that walls leave the pockets (columns) in the step.
template <int Dim>
Eigen::MatrixXd stiffness_of_air(const EnclosedAir<Dim>& air, double dt);

/// Adds to `field` [Pa] of all particles what such pressures of the pockets make: up to date on walls and ghosts.
template <int Dim>
void add_air_of(const EnclosedAir<Dim>& air, std::span<const double> pressures, std::vector<double>& field);

/// The force of the pockets on the water during dt, after that of the water's pressure; the pockets grow with the mean
/// of the water's old and new velocity. Collective.
template <int Dim>
void push_by_pockets(Flow<Dim>& flow, EnclosedAir<Dim>& air, double dt);

/// The forces of 1 Pa in each pocket through the pairs of water and walls that move, with the responses as they are.
/// Collective.
template <int Dim>
std::vector<PocketPairs<Dim>> find_wall_pair_forces(const Flow<Dim>& flow, const EnclosedAir<Dim>& air,
                                                    std::span<const std::pair<std::size_t, PocketShare>> air_fractions);

/// m^Dim/s; by which walls that move make each pocket grow in a step of dt from now on, as far as the air pushes them
/// itself: those that are driven by their displacement, bodies by the mean of their velocities at both ends of the
/// step.
template <int Dim>
std::vector<double> growth_at_walls(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, double dt);

/// m^Dim; that each inlet and outlet has brought since the start, up to the end of the step: 0 where the case does not
/// say how much water passes.
template <int Dim>
std::vector<double> brought_by_ends(const Flow<Dim>& flow);

/// Finds by how much the water of open ends that the case drives makes each pocket grow: what the pairs of it and other
/// water work, as those of walls. The reference pocket of a sealed space has what comes into the space instead, less
/// that of the other pockets. Collective.
template <int Dim>
void find_inflow(const Flow<Dim>& flow, EnclosedAir<Dim>& air, double dt);

/// That at walls with the growth through the water, by walls and open ends.
template <int Dim>
std::vector<double> growth_by_walls(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, double dt);

/// Takes the pressures of the pockets [Pa] out of `field` [Pa] as far as particles see their air: of the rest the pairs
/// of water and walls make the force on walls that move, and the air's own is on the step's `walls`. Ghosts are up to
/// date then. Collective.
template <int Dim>
void subtract_seen_air(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, std::span<const double> pressures,
                       std::vector<double>& field);

/// Pa; of the air at a piece of a wall.
template <int Dim>
double pressure_at(const PocketWall<Dim>& wall, std::span<const double> air);

}  // namespace tailwater
