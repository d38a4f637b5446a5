#include "case/rheology.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"

namespace tailwater {

namespace {

/// A layer of the height H of the fluid, whose stress rises from 0 at its surface to the yield stress on its bed,
/// creeps at t_y H/(2 mu_rest): no layer that should be at rest is faster.
void check_creep_of(const LiquidTable& liquid, const CaseSpec& spec, double height, Findings& findings) {
  if (liquid.yield_stress == 0.0) return;
  const double speed = liquid.yield_stress * height / (2.0 * viscosity_at_rest(liquid));
  const CaseLabel key = CaseLabel("liquid", liquid.name).with_key("rest_viscosity");
  const double least = spec.time.end_at_rest;
  if (least > 0.0 && speed > least) {
    findings.push_back(Finding::warning(
        "creep-prevents-rest",
        {"{} = {:.4g}: below its yield stress the liquid creeps at up to {:.2g} m/s, so the run may not end at rest "
         "(time.end_at_rest = {:.2g} m/s)",
         key, Amount{liquid.rest_viscosity, "Pa s"}, speed, least},
        {"give a viscosity of at least {:.2g} Pa s, or a larger time.end_at_rest",
         2.0 * liquid.rest_viscosity * speed / least}));
    return;
  }
  const double way = speed * spec.time.end;
  if (least > 0.0 || way <= spec.particles.spacing) return;
  findings.push_back(Finding::warning(
      "creep-below-yield-stress",
      {"{} = {:.4g}: below its yield stress the liquid creeps at up to {:.2g} m/s, which is {:.2g} m until the end of "
       "the run",
       key, Amount{liquid.rest_viscosity, "Pa s"}, speed, way},
      {"give a viscosity of at least {:.2g} Pa s, or let the run end at rest (time.end_at_rest)",
       2.0 * liquid.rest_viscosity * way / spec.particles.spacing}));
}

}  // namespace

template <int Dim>
Findings check_creep(const CaseSpec& spec, const FluidParticles<Dim>& fluid) {
  Findings findings;
  const LiquidTable* const liquid = liquid_of(spec);
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  if (liquid == nullptr || gravity.norm() == 0.0 || fluid.all == 0) return findings;
  const double height = fluid.extent_along(gravity.normalized()) + spec.particles.spacing;
  for (const LiquidTable& each : spec.liquids) check_creep_of(each, spec, height, findings);
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_creep);

}  // namespace tailwater
