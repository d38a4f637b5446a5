#include "case/rheology.h"

#include <algorithm>
#include <cmath>

namespace tailwater {
namespace {

/// Viscosity at rest over that of flow where yield stress and viscous stress are alike: a plug then creeps at a
/// thousandth of the shear rate there.
constexpr double rest_over_flow = 1000.0;

/// Shear rates [1/s] below this are 0 for a law with an infinite viscosity there.
constexpr double no_shear = 1e-100;

/// K s^(n-1), without the infinite viscosity at rest of a liquid that thins.
double power_law(const LiquidTable& liquid, double shear_rate) {
  if (liquid.index == 1.0) return liquid.consistency;
  if (liquid.index < 1.0 && shear_rate < no_shear) return liquid.rest_viscosity;
  const double viscosity = liquid.consistency * std::pow(shear_rate, liquid.index - 1.0);
  return liquid.index < 1.0 ? std::min(viscosity, liquid.rest_viscosity) : viscosity;
}

double yield_part(const LiquidTable& liquid, double shear_rate) {
  if (liquid.yield_stress == 0.0) return 0.0;
  const bool flows = liquid.rest_viscosity * shear_rate > liquid.yield_stress;
  return flows ? liquid.yield_stress / shear_rate : liquid.rest_viscosity;
}

}  // namespace

double viscosity_at(const LiquidTable& liquid, double shear_rate) {
  switch (liquid.rheology) {
    case Rheology::newtonian:
      return liquid.viscosity;
    case Rheology::power_law:
      return power_law(liquid, shear_rate);
    case Rheology::bingham:
      return yield_part(liquid, shear_rate) + liquid.viscosity;
    case Rheology::herschel_bulkley:
      return yield_part(liquid, shear_rate) + power_law(liquid, shear_rate);
    case Rheology::carreau:
      break;
  }
  const double slowed = 1.0 + std::pow(liquid.relaxation_time * shear_rate, 2.0);
  return liquid.high_shear_viscosity +
         (liquid.viscosity - liquid.high_shear_viscosity) * std::pow(slowed, 0.5 * (liquid.index - 1.0));
}

double viscosity_at_rest(const LiquidTable& liquid) { return viscosity_at(liquid, 0.0); }

bool varies_with_shear(const LiquidTable& liquid) { return liquid.rheology != Rheology::newtonian; }

double default_rest_viscosity(const LiquidTable& liquid) {
  const bool is_bingham = liquid.rheology == Rheology::bingham;
  const double consistency = is_bingham ? liquid.viscosity : liquid.consistency;
  if (liquid.yield_stress == 0.0 || consistency == 0.0) return rest_over_flow * std::max(consistency, 1.0);
  const double index = is_bingham ? 1.0 : liquid.index;
  return rest_over_flow * liquid.yield_stress / std::pow(liquid.yield_stress / consistency, 1.0 / index);
}

double kinematic_viscosity(const LiquidTable& liquid) {
  switch (liquid.rheology) {
    case Rheology::newtonian:
    case Rheology::bingham:
      return liquid.viscosity / liquid.density;
    case Rheology::carreau:
      return liquid.high_shear_viscosity / liquid.density;
    case Rheology::power_law:
    case Rheology::herschel_bulkley:
      break;
  }
  return 0.0;
}

const LiquidTable* liquid_of(const CaseSpec& spec) {
  if (spec.fluid.empty() || spec.fluid[0].liquid.empty()) return nullptr;
  const auto liquid = std::ranges::find(spec.liquids, spec.fluid[0].liquid, &LiquidTable::name);
  return liquid == spec.liquids.end() ? nullptr : &*liquid;
}

bool has_several_liquids(const CaseSpec& spec) {
  return std::ranges::any_of(spec.fluid, [&](const FluidTable& block) { return block.liquid != spec.fluid[0].liquid; });
}

int index_of_liquid(const CaseSpec& spec, std::string_view name) {
  return static_cast<int>(std::ranges::find(spec.liquids, name, &LiquidTable::name) - spec.liquids.begin());
}

}  // namespace tailwater
