#include <span>

#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

constexpr std::size_t max_reported = 10;  // points in random order make millions

/// Calls report(place, face) where two faces of one wall cross, `max_reported` times at most.
template <class Report>
void find_crossings(std::span<const WallFace<2>> faces, double tolerance, Report&& report) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const WallFace<2>& a = faces[i];
      const WallFace<2>& b = faces[j];
      if (a.wall != b.wall || !crosses(a, b.corners[0], b.corners[1], tolerance) ||
          !crosses(b, a.corners[0], a.corners[1], tolerance)) {
        continue;
      }
      report(meet(a, b.corners[0], b.corners[1]), a);
      if (++found >= max_reported) return;
    }
  }
}

/// The edges of a polygon of water.
std::vector<WallFace<2>> outline_faces_of(const FluidTable& block, const CaseLabel& label) {
  std::vector<WallFace<2>> edges;
  for (std::size_t k = 0; k < block.points.size(); ++k) {
    const auto from = to_vec<2>(block.points[k], label, "points");
    const auto to = to_vec<2>(block.points[(k + 1) % block.points.size()], label, "points");
    const Vec<2> along = to - from;
    if (along.isZero(0.0)) continue;
    edges.push_back({{from, to}, Vec<2>(-along[1], along[0]) / along.norm()});
  }
  return edges;
}

}  // namespace

Findings check_self_crossing(const CaseSpec& spec, const Boundary<2>& boundary) {
  Findings findings;
  const double tolerance = corner_tolerance * spec.particles.spacing;
  find_crossings(boundary.faces, tolerance, [&](const Vec<2>& at, const WallFace<2>& face) {
    findings.push_back(Finding::error("wall-crosses-itself",
                                      {"{} crosses itself at {}", wall_label(boundary, face.wall), place(at)},
                                      {"correct the order of its points"}));
  });
  for (std::size_t b = 0; b < spec.fluid.size(); ++b) {
    if (spec.fluid[b].shape != BlockShape::polygon) continue;
    const CaseLabel label = fluid_label(spec, b);
    find_crossings(outline_faces_of(spec.fluid[b], label), tolerance,
                   [&](const Vec<2>& at, const WallFace<2>& /*edge*/) {
                     findings.push_back(Finding::error("fluid-crosses-itself",
                                                       {"the outline of {} crosses itself at {}", label, place(at)},
                                                       {"correct the order of its points"}));
                   });
  }
  return findings;
}

}  // namespace tailwater
