#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"

namespace tailwater {

Findings check_self_crossing(const CaseSpec& spec, const Boundary<2>& boundary) {
  Findings findings;
  constexpr std::size_t most = 10;  // points in random order make millions
  const double tolerance = corner_tolerance * spec.particles.spacing;
  for (std::size_t i = 0; i < boundary.faces.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const WallFace<2>& a = boundary.faces[i];
      const WallFace<2>& b = boundary.faces[j];
      if (a.wall == b.wall && crosses(a, b.corners[0], b.corners[1], tolerance) &&
          crosses(b, a.corners[0], a.corners[1], tolerance)) {
        findings.push_back(Finding::error(
            "wall-crosses-itself",
            {"{} crosses itself at {}", wall_label(boundary, a.wall), place(meet(a, b.corners[0], b.corners[1]))},
            {"correct the order of its points"}));
        if (findings.size() >= most) return findings;
      }
    }
  }
  return findings;
}

}  // namespace tailwater
