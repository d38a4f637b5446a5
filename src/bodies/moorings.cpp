#include "bodies/moorings.h"

#include "motion/floating_body.h"

namespace tailwater {

template <int Dim>
std::vector<OneSidedForce> find_moorings(const std::vector<Mooring<Dim>>& moorings,
                                         const std::vector<BodyState<Dim>>& bodies, std::span<const Freedom> freedoms) {
  std::vector<OneSidedForce> lines;
  for (const Mooring<Dim>& mooring : moorings) {
    const BodyState<Dim>& body = bodies[mooring.body];
    const Vec<Dim> at = body.placement(mooring.at);
    const bool is_tied = mooring.to_body >= 0;
    const Vec<Dim> anchor = is_tied ? bodies[mooring.to_body].placement(mooring.anchor) : mooring.anchor;
    const double length = (anchor - at).norm();
    const double stretch = length - mooring.length;
    if (stretch <= 0.0) continue;
    const Vec<Dim> pull = (anchor - at) / length;
    Vec<Dim> velocity = body.velocity_at(at);
    if (is_tied) velocity -= bodies[mooring.to_body].velocity_at(anchor);
    lines.push_back({.direction = on_body<Dim>(freedoms, bodies, mooring.body, at, pull) -
                                  on_body<Dim>(freedoms, bodies, mooring.to_body, anchor, pull),
                     .speed = pull.dot(velocity),
                     .damping = mooring.damping,
                     .load = mooring.stiffness * stretch});
  }
  return lines;
}

TAILWATER_IN_2D_AND_3D(find_moorings);

}  // namespace tailwater
