#include <cmath>

#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/largest_speed.h"
#include "motion/channel_end.h"
#include "motion/floating_body.h"

namespace tailwater {
namespace {

/// Number of times at which an open end is evaluated.
constexpr int looks_at_end = 200;

template <int Dim>
void check_speed_of_end(const ChannelEnd<Dim>& end, double last, double spacing, Findings& findings) {
  for (int k = 0; k <= looks_at_end; ++k) {
    const double time = last * k / looks_at_end;
    const double speed = end.largest_speed(time, spacing);
    if (std::abs(speed) <= largest_speed_of_case) continue;
    findings.push_back(
        Finding::error("inflow-too-fast",
                       {"{}: at t = {:.6g} s water would enter at {:.4g}, but it is treated as incompressible, which "
                        "limits it to {:g} m/s",
                        end.opening.label(), time, Amount{speed, "m/s"}, largest_speed_of_case},
                       {"check the units, or make the opening larger"}));
    return;
  }
}

}  // namespace

template <int Dim>
Findings check_speeds(const CaseSpec& spec) {
  Findings findings;
  for (const FloatingBody<Dim>& body : make_bodies<Dim>(spec)) {
    const double speed = body.drawn.linear_velocity().norm();
    if (speed <= largest_speed_of_case) continue;
    findings.push_back(
        Finding::error("body-too-fast",
                       {"{} is {:.4g}, but water is treated as incompressible, which limits bodies to {:g} m/s",
                        CaseLabel("body", body.name).with_key("velocity"), Amount{speed, "m/s"}, largest_speed_of_case},
                       {"give a lower velocity"}));
  }
  for (const ChannelEnd<Dim>& end : make_channel_ends<Dim>(spec)) {
    if (end.flow.feeds()) check_speed_of_end(end, spec.time.end, spec.particles.spacing, findings);
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_speeds);

}  // namespace tailwater
