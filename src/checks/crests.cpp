#include <algorithm>
#include <optional>

#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/images.h"
#include "geometry/opening.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

/// A face whose normal has a smaller cosine to the vertical is a side and carries no water.
constexpr double min_upward_cosine = 0.01;

constexpr double at_opening = 0.1;  // dx, between the end of a polyline and an inlet or outlet that closes it

/// Height of the higher end of a polyline that ends on a rise; none if both ends are level, or stand at open ends or
/// periodic boundaries.
std::optional<double> rim_height(const std::vector<Vec<2>>& points, const std::vector<Opening<2>>& open_ends,
                                 const PeriodicDomain<2>& domain, double spacing, const Vec<2>& up) {
  std::optional<double> rim;
  const auto is_open = [&](const Vec<2>& x) {
    return is_in_periodic_plane<2>(domain, x, at_opening * spacing) ||
           std::ranges::any_of(open_ends, [&](const Opening<2>& end) {
             const double distance = std::min((x - end.corner).norm(), (x - end.corner - end.edges[0]).norm());
             return distance <= at_opening * spacing;
           });
  };
  const auto look_at = [&](const Vec<2>& end, const Vec<2>& next) {
    if (is_open(end)) return;
    if (up.dot(end) > up.dot(next)) rim = rim ? std::max(*rim, up.dot(end)) : up.dot(end);
  };
  look_at(points.front(), points[1]);
  look_at(points.back(), points[points.size() - 2]);
  return rim;
}

}  // namespace

Findings check_crests(const CaseSpec& spec, const Boundary<2>& boundary) {
  const Vec<2> gravity = gravity_of<2>(spec);
  if (gravity.norm() == 0.0) return {};
  const Vec<2> up = -gravity.normalized();
  const double tolerance = corner_tolerance * spec.particles.spacing;
  const std::vector<Opening<2>> open_ends = make_open_ends<2>(spec);
  for (std::size_t w = 0; w < spec.walls.size(); ++w) {
    if (spec.walls[w].shape != WallShape::polyline) continue;
    const CaseLabel label = wall_label(boundary, static_cast<int>(w));
    std::vector<Vec<2>> points;
    for (const Coordinates& point : spec.walls[w].points) points.push_back(to_vec<2>(point, label, "points"));
    const std::optional<double> rim = rim_height(points, open_ends, boundary.domain, spec.particles.spacing, up);
    if (!rim) continue;
    for (const WallFace<2>& face : boundary.faces) {
      if (face.wall != static_cast<int>(w) || up.dot(face.normal) < min_upward_cosine) continue;
      for (const Vec<2>& corner : face.corners) {
        const bool is_end =
            (corner - points.front()).norm() <= tolerance || (corner - points.back()).norm() <= tolerance;
        if (is_end || up.dot(corner) < *rim) continue;
        return {Finding::error("crest-above-ends",
                               {"{} has a crest at {}, {:.6g} higher than the higher of its ends: water would run over "
                                "the ends before it passes the crest",
                                label, place(corner), Amount{up.dot(corner) - *rim, "m"}},
                               {"raise the ends, or lower the crest"})};
      }
    }
  }
  return {};
}

}  // namespace tailwater
