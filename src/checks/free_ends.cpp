#include <algorithm>

#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"

namespace tailwater {

Findings check_free_ends(const CaseSpec& spec, const Boundary<2>& drawn) {
  const double dx = spec.particles.spacing;
  Findings findings;
  for (const WallFace<2>& face : drawn.faces) {
    if (drawn.walls[face.wall].moves()) continue;
    for (const Vec<2>& end : face.corners) {
      int moving = -1;
      bool goes_on = false;
      for (const WallFace<2>& other : drawn.faces) {
        const bool is_here = std::ranges::any_of(
            other.corners, [&](const Vec<2>& x) { return (x - end).norm() <= corner_tolerance * dx; });
        if (&other == &face || !is_here) continue;
        if (drawn.walls[other.wall].moves()) {
          moving = other.wall;
        } else {
          goes_on = true;
        }
      }
      if (moving < 0 || goes_on) continue;
      findings.push_back(Finding::warning(
          "wall-ends-at-moving-wall",
          {"{} ends at {}, where the moving {} begins: once that wall has moved, a gap is left at this end",
           wall_label(drawn, face.wall), place(end), wall_label(drawn, moving)},
          {"extend the resting wall by {:.6g} m or more", dummy_layers(spec) * dx}));
    }
  }
  return findings;
}

}  // namespace tailwater
