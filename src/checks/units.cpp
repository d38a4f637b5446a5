#include "checks/checks.h"
#include "geometry/from_spec.h"

namespace tailwater {
namespace {

bool is_between(double value, double low, double high) { return low <= value && value <= high; }

Finding other_unit(const char* key, double value, const char* unit, const char* other_unit, const char* hint) {
  return Finding::warning(
      "value-of-other-unit",
      {"{} = {:.4g} looks like a value in {}", CaseLabel("physics").with_key(key), Amount{value, unit}, other_unit},
      {"{}", hint});
}

}  // namespace

template <int Dim>
Findings check_units(const CaseSpec& spec) {
  Findings findings;
  const double density = spec.physics.density;
  const double gravity = gravity_of<Dim>(spec).norm();
  if (density < 10.0 && is_between(gravity, 9.0, 11.0)) {
    findings.push_back(other_unit("density", density, "kg/m^3", "kg/l", "give it in kg/m^3: water has 1000"));
  }
  if (is_between(gravity, 900.0, 1100.0)) {
    findings.push_back(other_unit("gravity", gravity, "m/s^2", "cm/s^2", "give it in m/s^2: on Earth it is 9.81"));
  }
  if (is_between(spec.physics.viscosity, 0.5, 2.0) && density >= 100.0) {
    findings.push_back(
        other_unit("viscosity", spec.physics.viscosity, "m^2/s", "mm^2/s", "give it in m^2/s: water has 1e-6"));
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_units);

}  // namespace tailwater
