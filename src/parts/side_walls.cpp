#include "parts/side_walls.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/finding.h"
#include "base/for_each.h"
#include "case/spec.h"
#include "closures/wall_law.h"
#include "flow/flow.h"

namespace tailwater {
namespace {

void require_wide_channel(const SideWallLaw& law, const TimeStepRule& rule) {
  if (rule.reference_speed == 0.0) return;
  const double step = rule.largest(0.0, 0.0);
  const double least = std::sqrt(12.0 * law.viscosity * step);  // 12 nu/b^2 dt = 1
  if (law.width >= least) return;
  throw CaseError("channel-too-narrow",
                  {"{} = {:.6g}: between side walls so near to each other water comes to rest within a time step of "
                   "{:.3g} s",
                   CaseLabel("physics").with_key("channel_width"), Amount{law.width, "m"}, step},
                  {"give at least {:.3g} m, or 0 for none", least});
}

}  // namespace

double SideWallLaw::rate(double speed) const {
  const double laminar = 12.0 * viscosity / width / width;
  if (speed == 0.0) return laminar;
  const double u_tau = WallLaw{viscosity, roughness}.turbulent_friction_velocity_of_mean(speed, 0.5 * width);
  return std::max(laminar, 2.0 * u_tau * u_tau / (width * speed));
}

template <int Dim>
void SideWalls<Dim>::add_damping_rate(const Flow<Dim>& flow, const StepStart<Dim>& start,
                                      std::vector<double>& rate) const {
  const Particles<Dim>& particles = flow.state.particles;
  rate.resize(particles.owned);
  for_each(particles.owned, [&](std::size_t i) {
    const bool is_in_case = particles.is_fluid(i) && !flow.walls.boundary.is_in_duct(particles.position[i]);
    if (is_in_case) rate[i] += law_.rate(start.velocity[i].norm());
  });
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_side_walls(const CaseSpec& spec, const Setup<Dim>& setup,
                                           const Boundary<Dim>& /*boundary*/) {
  if (spec.physics.channel_width == 0.0) return nullptr;
  const SideWallLaw law{.viscosity = spec.physics.viscosity,
                        .width = spec.physics.channel_width,
                        .roughness = spec.physics.channel_roughness};
  require_wide_channel(law, setup.time_step_rule);
  return std::make_unique<SideWalls<Dim>>(law);
}

template class SideWalls<2>;
template class SideWalls<3>;
TAILWATER_IN_2D_AND_3D(make_side_walls);

}  // namespace tailwater
