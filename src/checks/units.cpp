#include "checks/checks.h"
#include "geometry/from_spec.h"

namespace tailwater {
namespace {

bool is_between(double value, double low, double high) { return low <= value && value <= high; }

Finding other_unit(const CaseLabel& key, double value, const char* unit, const char* other_unit, const char* hint) {
  return Finding::warning("value-of-other-unit",
                          {"{} = {:.4g} looks like a value in {}", key, Amount{value, unit}, other_unit}, {"{}", hint});
}

}  // namespace

template <int Dim>
Findings check_units(const CaseSpec& spec) {
  Findings findings;
  const CaseLabel physics("physics");
  const double gravity = gravity_of<Dim>(spec).norm();
  const auto check_density = [&](double density, const CaseLabel& owner) {
    constexpr double densest = 3e4;  // kg/m^3; no matter on Earth is denser
    if (is_between(density, 10.0, densest) || !is_between(gravity, 9.0, 11.0)) return;
    findings.push_back(other_unit(owner.with_key("density"), density, "kg/m^3", density < densest ? "kg/l" : "g/m^3",
                                  "give it in kg/m^3: water has 1000"));
  };
  const auto check_gravity = [&](double low, double high, const char* unit) {
    if (!is_between(gravity, low, high)) return;
    findings.push_back(
        other_unit(physics.with_key("gravity"), gravity, "m/s^2", unit, "give it in m/s^2: on Earth it is 9.81"));
  };
  const auto check_pressure = [&](double low, double high, const char* unit) {
    if (!is_between(spec.air.pressure, low, high)) return;
    findings.push_back(other_unit(CaseLabel("air").with_key("pressure"), spec.air.pressure, "Pa", unit,
                                  "give it in Pa: the atmosphere has 101325"));
  };
  check_gravity(31.0, 33.0, "ft/s^2");
  check_gravity(900.0, 1100.0, "cm/s^2");
  check_gravity(9000.0, 11000.0, "mm/s^2");
  check_pressure(0.9, 1.1, "bar");
  check_pressure(90.0, 110.0, "kPa");
  check_pressure(900.0, 1100.0, "hPa");
  for (const LiquidTable& liquid : spec.liquids) {
    const CaseLabel owner("liquid", liquid.name);
    check_density(liquid.density, owner);
    if (is_between(liquid.viscosity, 1e-7, 1e-5)) {  // that of water is 1e-3
      findings.push_back(other_unit(owner.with_key("viscosity"), liquid.viscosity, "Pa s", "m^2/s",
                                    "give the dynamic viscosity, in Pa s: water has 0.001"));
    }
  }
  if (!spec.liquids.empty()) return findings;
  check_density(spec.physics.density, physics);
  const double viscosity = spec.physics.viscosity;
  const auto check_viscosity = [&](double low, double high, const char* unit) {
    if (!is_between(viscosity, low, high) || spec.physics.density < 100.0) return;
    findings.push_back(other_unit(physics.with_key("viscosity"), viscosity, "m^2/s", unit,
                                  "give the kinematic viscosity, in m^2/s: water has 1e-6"));
  };
  check_viscosity(0.5, 2.0, "mm^2/s");
  check_viscosity(9e-4, 1.1e-3, "Pa s");
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_units);

}  // namespace tailwater
