// Liquids of tests, and cases filled with them.
#pragma once

#include "case/rheology.h"

namespace tailwater {

inline LiquidTable newtonian(double viscosity) {
  LiquidTable liquid;
  liquid.name = "liquid";
  liquid.viscosity = viscosity;
  return liquid;
}

inline LiquidTable bingham(double viscosity, double yield_stress) {
  LiquidTable liquid = newtonian(viscosity);
  liquid.rheology = Rheology::bingham;
  liquid.yield_stress = yield_stress;
  liquid.rest_viscosity = default_rest_viscosity(liquid);
  return liquid;
}

inline LiquidTable herschel_bulkley(double consistency, double index, double yield_stress) {
  LiquidTable liquid;
  liquid.name = "liquid";
  liquid.rheology = yield_stress > 0.0 ? Rheology::herschel_bulkley : Rheology::power_law;
  liquid.consistency = consistency;
  liquid.index = index;
  liquid.yield_stress = yield_stress;
  liquid.rest_viscosity = default_rest_viscosity(liquid);
  return liquid;
}

inline void fill_with(CaseSpec& spec, const LiquidTable& liquid) {
  spec.liquids = {liquid};
  for (FluidTable& block : spec.fluid) block.liquid = liquid.name;
}

}  // namespace tailwater
