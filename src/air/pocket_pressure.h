// Pockets of enclosed air in the pressure equation (docs/theory/air.md). Beside a pocket missing neighbours count as
// air at its pressure P_k instead of 0. With chi_ik the fraction of pocket k in the air around particle i,
//
//   row i:       ... = source_i + a_i sum_k chi_ik P_k,    a_i closes the row (robust/rows.cpp)
//   water at i:  grad p_i - sum_k P_k chi_ik grad 1_i
//
// The pressure is linear in P,
//
//   p = p_w + sum_k P_k q_k,
//
// where p_w is the pressure of the water under air at 0, and q_k is the response to 1 Pa in pocket k, from 0 to 1 in
// space. With its force F_k = chi_k grad 1 - grad q_k on the water
//
//   pocket k:    dV_k/dt = sum_i w_i F_k,i . u_i + the power of its force on walls that move
//
// so the gas loses the energy that the water and the walls gain, for any q_k. Dummies have the mean chi of the water
// beside them. Tension is a negative p_w: a pressure below the one that the air alone makes. It is allowed up to the
// deficit of the latter (pressure/tension.h).
#pragma once

#include <Eigen/Core>

#include "air/enclosed_air.h"

namespace tailwater {

/// Determines the water and walls beside pockets and updates the responses q_k, with the matrix of the pressure
/// equation. Overwrites the right-hand sides of the matrix. Collective.
template <int Dim>
PocketStep<Dim> pose_pockets(Flow<Dim>& flow, EnclosedAir<Dim>& air, std::span<const Vec<Dim>> predicted, double dt);

/// The pressures [Pa] of the pockets in a step of dt that satisfy the equations of gas and water. p_w has been solved
/// for and is up to date on walls and ghosts, and walls move as at present. Collective.
template <int Dim>
std::vector<double> find_air_pressures(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, double dt);

/// The decrease [Pa] of the pressures (rows) per m^Dim that walls leave to the pockets (columns) in the step.
template <int Dim>
Eigen::MatrixXd stiffness_of_air(const EnclosedAir<Dim>& air, double dt);

/// Adds to `field` [Pa] of all particles the pressure that these pressures of the pockets make; needs responses that
/// are up to date on walls and ghosts.
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

/// m/s; the velocity, halfway through a step of dt, of all walls of a case that moves as one: a tank with its
/// partitions. 0 if walls rest or move differently.
template <int Dim>
AffineMap<Dim> common_velocity(const Flow<Dim>& flow, double dt);

/// m^Dim/s; growth of each of the pockets by walls that all have this velocity.
template <int Dim>
std::vector<double> growth_of_all_walls(const Flow<Dim>& flow, const PocketStep<Dim>& step,
                                        const AffineMap<Dim>& velocity, std::size_t pockets);

/// m^Dim/s; growth of each pocket in a step of dt from now on by moving walls, through the direct force of the air on
/// them. Driven walls count by their displacement, bodies by the mean of their velocities at both ends of the step.
template <int Dim>
std::vector<double> growth_at_walls(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, double dt);

/// m^Dim; volume that each inlet and outlet has brought since the start, up to the end of the step: 0 where the case
/// does not prescribe how much water passes.
template <int Dim>
std::vector<double> brought_by_ends(const Flow<Dim>& flow);

/// Computes the growth of each pocket by the water of driven open ends: the power of the pairs of that water and other
/// water, as for walls. For the reference pocket of a sealed space the growth is instead that of the space, less that
/// of the other pockets. Collective.
template <int Dim>
void find_inflow(const Flow<Dim>& flow, EnclosedAir<Dim>& air, double dt);

/// growth_at_walls and the growth through the water, by walls and open ends.
template <int Dim>
std::vector<double> growth_by_walls(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, double dt);

/// Subtracts the pressures of the pockets [Pa] from `field` [Pa] by the fractions of the particles. The pairs of water
/// and walls make the force of the remainder on moving walls; the direct force of the air is on the step's `walls`.
/// Ghosts are up to date afterwards. Collective.
template <int Dim>
void subtract_seen_air(const Flow<Dim>& flow, const EnclosedAir<Dim>& air, std::span<const double> pressures,
                       std::vector<double>& field);

/// Pa; pressure of the air at a piece of a wall.
template <int Dim>
double pressure_at(const PocketWall<Dim>& wall, std::span<const double> air);

}  // namespace tailwater
