// Corners of closed walls that are a little behind another wall. The nearest wall of a place beyond such a corner is
// the closed one, in front of which the place is, so water can pass between the two.
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "checks/checks.h"
#include "geometry/some_walls.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

/// dx; corners between these depths behind a wall let water pass.
constexpr double least_corner_depth = 1e-4;
constexpr double safe_corner_depth = 0.5;

}  // namespace

template <int Dim>
Findings check_shallow_corners(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  Findings findings;
  if constexpr (Dim == 2) {
    const double dx = spec.particles.spacing;
    std::set<std::pair<int, int>> reported;
    for (const WallFace<2>& face : boundary.faces) {
      const auto own = static_cast<std::size_t>(face.wall);
      if (face.is_image || own >= spec.walls.size() || !is_hull(spec.walls[own]) || boundary.walls[own].moves())
        continue;
      for (std::size_t other = 0; other < boundary.walls.size(); ++other) {
        if (other == own || boundary.walls[other].is_plate || boundary.walls[other].moves()) continue;
        std::vector<std::uint8_t> is_other(boundary.walls.size(), 0);
        is_other[other] = 1;
        const Vec<2>& corner = face.corners[0];
        const NearestWall<2> wall = nearest_among<2>(boundary, is_other, corner, safe_corner_depth * dx);
        if (wall.face < 0 || wall.signed_distance > -least_corner_depth * dx) continue;
        if (!reported.emplace(face.wall, static_cast<int>(other)).second) continue;
        findings.push_back(Finding::warning(
            "corner-just-behind-wall",
            {"{}: its corner at {} is {:.3g} behind {}, less than half a spacing; still water escapes at such corners",
             wall_label(boundary, face.wall), place(corner), Amount{-wall.signed_distance, "m"},
             wall_label(boundary, static_cast<int>(other))},
            {"end it on that wall, or at least {:.3g} m behind it", safe_corner_depth * dx}));
      }
    }
  }
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_shallow_corners);

}  // namespace tailwater
