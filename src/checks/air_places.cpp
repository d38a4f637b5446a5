#include <limits>

#include "base/box.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"

namespace tailwater {

template <int Dim>
Findings check_air_places(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  Findings findings;
  const Box<Dim> box = box_around(boundary.faces);
  const double tolerance = 0.5 * spec.particles.spacing;
  const auto check = [&](const CaseLabel& owner, const Coordinates& at) {
    const Vec<Dim> x = to_vec<Dim>(at, owner, "at");
    const NearestWall<Dim> wall = boundary.nearest(x, std::numeric_limits<double>::infinity());
    if (wall.face >= 0 && wall.signed_distance < -tolerance) {
      findings.push_back(Finding::error(
          "air-place-in-wall",
          {"{}: {} is in {}, {:.4g} behind its surface at {}", owner, place(x),
           wall_label(boundary, boundary.faces[wall.face].wall), Amount{-wall.signed_distance, "m"}, place(wall.point)},
          {"move it into the air, or onto the surface"}));
    } else if (wall.face < 0 || box.exteriorDistance(x) > tolerance) {
      findings.push_back(Finding::error("air-place-outside-walls",
                                        {"{}: {} is outside of all walls, where air is open", owner, place(x)},
                                        {"give a point in air that water and walls enclose"}));
    }
  };
  for (const PocketTable& pocket : spec.pockets) check(CaseLabel("pocket", pocket.name), pocket.at);
  for (const VentTable& vent : spec.vents) check(CaseLabel("vent", vent.name), vent.at);
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_air_places);

}  // namespace tailwater
