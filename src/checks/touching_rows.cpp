#include <algorithm>

#include "case/formulation.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"
#include "sampling/wall_particles.h"

namespace tailwater {

template <int Dim>
Findings check_touching_rows(const CaseSpec& spec, const Boundary<Dim>& drawn) {
  if (!traits_of(spec).walls.on_wall) return {};
  const double dx = spec.particles.spacing;
  for (const WallFace<Dim>& face : drawn.faces) {
    for (const WallFace<Dim>& other : drawn.faces) {
      if (drawn.walls[face.wall].body == drawn.walls[other.wall].body) continue;
      for (const Vec<Dim>& corner : face.corners) {
        const double distance = (closest_point(other, corner) - corner).norm();
        if (distance > (1.0 - corner_tolerance) * dx) continue;
        // The message begins with the wall that moves.
        const auto [moving, near] = std::minmax(
            face.wall, other.wall, [&](int a, int b) { return drawn.walls[a].moves() && !drawn.walls[b].moves(); });
        return {
            Finding::error("moving-wall-touches-wall",
                           {"{} is {:.3g} from {} at {}, and the published formulation puts particles on both walls",
                            wall_label(drawn, moving), Amount{distance, "m"}, wall_label(drawn, near), place(corner)},
                           {"draw it {:.6g} m away, or choose scheme.formulation = \"robust\"", dx})};
      }
    }
  }
  return {};
}

TAILWATER_IN_2D_AND_3D(check_touching_rows);

}  // namespace tailwater
