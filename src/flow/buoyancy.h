// Water that fills its walls: several liquids in a box, or any in a conduit between openings. No surface can rise or
// fall, so the weight of the lightest liquid moves nothing: a pressure rho_b g . x balances it everywhere, and only the
// difference of the densities and the pressure between the openings drive the flow. What scales with gravity therefore
// scales with the reduced gravity, at most g, with which the lightest liquid rises in the heaviest one,
//
//   g' = g (rho_heaviest/rho_b - 1),
//
// and the errors of sums over pairs with the pressure p - rho_b g . x - c instead of p. rho_b is the density of the
// lightest liquid times the fullness, which is 0 as soon as there is a free surface, and 0 for one liquid in a box. No
// pressure balances the weight along a periodic direction: here g is without it (Setup::gravity_across). Derivation:
// docs/theory/liquids.md.
#pragma once

#include <vector>

#include "closures/time_step.h"
#include "flow/flow.h"

namespace tailwater {

/// 1 where water fills its walls, 0 where as much as a particle is beside air, in between otherwise. 0 where open ends
/// or marks of the surface fix the pressure. Collective.
template <int Dim>
double find_fullness(const Flow<Dim>& flow);

/// 1 where water fills the space between walls and openings, as find_fullness without the exception of open ends.
/// Collective.
template <int Dim>
double find_fullness_between_openings(const Flow<Dim>& flow);

/// Whether the pressure of water that fills its walls counts relative to the balanced one. The steps of a thick liquid
/// in a conduit follow its weight, which limits the error of the implicit viscous force.
template <int Dim>
bool may_be_balanced(const Flow<Dim>& flow);

/// rho_b [kg/m^3], by the fullness at the end of the last step.
template <int Dim>
double balanced_density(const Flow<Dim>& flow);

/// The time-step rule of the case, with the reference speed of the reduced gravity.
template <int Dim>
TimeStepRule time_step_rule(const Flow<Dim>& flow);

/// Viscosity [m^2/s] of the noise dissipation at the case's spacing, by a time-step rule and the largest speed [m/s].
template <int Dim>
double noise_viscosity(const Setup<Dim>& setup, const TimeStepRule& rule, double speed);

/// p - rho_b g . x + c, whose minimum in the fluid is 0, of all particles [Pa]. `density` is rho_b, above 0.
/// Collective.
template <int Dim>
std::vector<double> without_balanced_pressure(const Flow<Dim>& flow, double density,
                                              const std::vector<double>& pressure);

/// rho_b g . x + c of owned particles [Pa], the pressure of the last step that balances the weight; empty where there
/// is none. Collective.
template <int Dim>
std::vector<double> balanced_pressure(const Flow<Dim>& flow);

}  // namespace tailwater
