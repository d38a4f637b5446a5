#include <algorithm>
#include <optional>

#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"
#include "motion/wall_motion.h"

namespace tailwater {
namespace {

constexpr double near = 0.1;   ///< dx; places as near as this count as one
constexpr int instants = 500;  ///< of the run at which the places of walls are evaluated

/// The end of a resting wall on a corner of a moving one.
struct SharedEnd {
  const WallFace<2>& resting;
  Vec<2> at;
  int moving;
};

/// Follows shared ends as the walls move. Borrows the case and its walls.
class EndsInMotion {
 public:
  EndsInMotion(const CaseSpec& spec, const Boundary<2>& drawn)
      : spec_(spec),
        drawn_(drawn),
        rows_(dummy_layers(spec) * spec.particles.spacing),
        walls_(drawn),
        motion_(spec, walls_, {}),
        state_(initial_motion<2>(spec)) {}

  /// Whether the resting wall lies on the moving one there, so that no water reaches its end.
  bool is_covered(const SharedEnd& end) const {
    const double length = (end.resting.corners[1] - end.resting.corners[0]).norm();
    const Vec<2> inside = end.at - std::min(length, spec_.particles.spacing) * outwards(end);
    return std::ranges::any_of(drawn_.faces,
                               [&](const WallFace<2>& face) { return face.wall == end.moving && is_on(face, inside); });
  }

  /// The gap that opens at the end; none if a side of the moving wall closes the end at all times.
  std::optional<Finding> finding(const SharedEnd& end) const {
    const WallMotion<2>::MovingWall& mover =
        *std::ranges::find(motion_.moving(), end.moving, &WallMotion<2>::MovingWall::wall);
    const bool has_side = is_closed(end, {});
    bool stays_closed = true;
    Vec<2> deepest = Vec<2>::Zero();  // displacements of the corner
    double farthest = 0.0;
    double highest = 0.0;
    for (int k = 0; k <= instants; ++k) {
      const AffineMap<2> map = mover.at(spec_.time.end * k / instants, state_);
      stays_closed = stays_closed && is_closed(end, map);
      const Vec<2> way = map(end.at) - end.at;
      if (way.dot(end.resting.normal) < deepest.dot(end.resting.normal)) deepest = way;
      farthest = std::max(farthest, way.dot(outwards(end)));
      highest = std::max(highest, way.dot(end.resting.normal));
    }
    if (has_side && stays_closed) return std::nullopt;
    const CaseLabel resting = wall_label(drawn_, end.resting.wall);
    const CaseLabel moving = wall_label(drawn_, end.moving);
    if (-deepest.dot(end.resting.normal) > near * spec_.particles.spacing) {
      return Finding::warning("wall-moves-behind-end",
                              {"{} ends at {}, and the corner of the moving {} moves from there to {}: a gap is left",
                               resting, place(end.at), moving, place<2>(end.at + deepest)},
                              {"continue the resting wall from its end to {} or farther",
                               place<2>(end.at + deepest + rows_ * deepest.normalized())});
    }
    if (has_side) {
      return Finding::warning("moving-side-too-short",
                              {"{} ends at {}, where the moving {} rises by {:.3g} and its side does not close the end",
                               resting, place(end.at), moving, Amount{highest, "m"}},
                              {"draw the side of the moving wall {:.6g} m long or longer", highest + rows_});
    }
    return Finding::warning(
        "wall-ends-at-moving-wall",
        {"{} ends at {}, where the moving {} begins: once that wall has moved, a gap is left at this end", resting,
         place(end.at), moving},
        {"extend the resting wall by {:.6g} m or more", farthest + rows_});
  }

 private:
  bool is_on(const WallFace<2>& face, const Vec<2>& x) const {
    return (closest_point(face, x) - x).norm() <= near * spec_.particles.spacing;
  }

  /// The direction in which the resting wall would go on.
  static Vec<2> outwards(const SharedEnd& end) {
    return (end.at - (end.resting.corners[0] + end.resting.corners[1]) / 2.0).normalized();
  }

  /// Whether a face of the moving wall, at this place, passes the end and goes on behind the rows of the resting wall.
  bool is_closed(const SharedEnd& end, const AffineMap<2>& map) const {
    return std::ranges::any_of(drawn_.faces, [&](const WallFace<2>& drawn) {
      if (drawn.wall != end.moving) return false;
      const WallFace<2> face = moved(map, drawn);
      const auto is_behind = [&](const Vec<2>& x) {
        return end.resting.height(x) <= -rows_ + near * spec_.particles.spacing;
      };
      return is_on(face, end.at) && std::ranges::any_of(face.corners, is_behind);
    });
  }

  const CaseSpec& spec_;
  const Boundary<2>& drawn_;
  double rows_;        ///< m; depth of the rows of wall particles
  Boundary<2> walls_;  ///< with images of walls that slide along a period
  WallMotion<2> motion_;
  MotionState<2> state_;
};

/// The ends of resting walls on corners of moving ones where no other resting wall goes on.
std::vector<SharedEnd> shared_ends(const CaseSpec& spec, const Boundary<2>& drawn) {
  const double tolerance = corner_tolerance * spec.particles.spacing;
  std::vector<SharedEnd> ends;
  for (const WallFace<2>& face : drawn.faces) {
    if (drawn.walls[face.wall].moves()) continue;
    for (const Vec<2>& end : face.corners) {
      int moving = -1;
      bool goes_on = false;
      for (const WallFace<2>& other : drawn.faces) {
        const bool is_here =
            std::ranges::any_of(other.corners, [&](const Vec<2>& x) { return (x - end).norm() <= tolerance; });
        if (&other == &face || !is_here) continue;
        if (drawn.walls[other.wall].moves()) {
          moving = other.wall;
        } else {
          goes_on = true;
        }
      }
      if (moving >= 0 && !goes_on) ends.push_back({face, end, moving});
    }
  }
  return ends;
}

}  // namespace

Findings check_free_ends(const CaseSpec& spec, const Boundary<2>& drawn) {
  Findings findings;
  const std::vector<SharedEnd> ends = shared_ends(spec, drawn);
  if (ends.empty()) return findings;
  const EndsInMotion motion(spec, drawn);
  for (const SharedEnd& end : ends) {
    if (motion.is_covered(end)) continue;
    if (const auto found = motion.finding(end)) findings.push_back(*found);
  }
  return findings;
}

}  // namespace tailwater
