// Laws of viscosity. Of a shear rate s = sqrt(2 D:D) [1/s], where D is the symmetric part of the velocity gradient, the
// shear stress is t = mu(s) s with the dynamic viscosity [Pa s]
//
//   newtonian          mu
//   power-law          K s^(n-1)
//   bingham            t_y/s + mu
//   herschel-bulkley   t_y/s + K s^(n-1)
//   carreau            mu_inf + (mu - mu_inf) (1 + (lambda s)^2)^((n-1)/2)
//
// Where s vanishes, the terms t_y/s and, for n < 1, K s^(n-1) would be infinite; neither exceeds the viscosity at rest.
// Flow above the yield stress thus keeps its exact law, and below it the liquid creeps at t/mu_rest
// (docs/theory/rheology.md).
#pragma once

#include <string_view>

#include "case/spec.h"

namespace tailwater {

/// Dynamic viscosity [Pa s] at a shear rate [1/s].
double viscosity_at(const LiquidTable& liquid, double shear_rate);

/// Largest dynamic viscosity [Pa s] that a liquid which does not thicken has: that at rest.
double viscosity_at_rest(const LiquidTable& liquid);

/// Whether the viscosity varies with the shear rate.
bool varies_with_shear(const LiquidTable& liquid);

/// The viscosity at rest where the case gives none [Pa s].
double default_rest_viscosity(const LiquidTable& liquid);

/// The kinematic viscosity [m^2/s] that stands for the liquid where one number must: that at high shear rates, and 0
/// for a power law, which has none.
double kinematic_viscosity(const LiquidTable& liquid);

/// The liquid of a case, of several that of its first block; null: water.
const LiquidTable* liquid_of(const CaseSpec& spec);

/// Whether blocks of the case are of different liquids.
bool has_several_liquids(const CaseSpec& spec);

/// Index into CaseSpec::liquids of a name that is there.
int index_of_liquid(const CaseSpec& spec, std::string_view name);

}  // namespace tailwater
