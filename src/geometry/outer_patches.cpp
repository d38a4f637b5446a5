#include "geometry/outer_patches.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "base/box.h"
#include "geometry/facing.h"
#include "geometry/some_walls.h"

namespace tailwater {
namespace {

/// dx; edge of the pieces of a patch that another wall cuts.
constexpr double edge_of_pieces = 0.125;

/// Which places of a wall are drawn again, or hidden, by another wall of the same body.
template <int Dim>
class WallsOfBodies {
 public:
  WallsOfBodies(const CaseSpec& spec, const Boundary<Dim>& boundary)
      : boundary_(boundary), touch_(reach_of_touch * spec.particles.spacing), boxes_(boundary.walls.size()) {
    for (const WallFace<Dim>& face : boundary.faces) {
      if (!face.is_image && !boundary.walls[face.wall].is_plate) boxes_[face.wall].extend(face.box());
    }
    for (std::size_t w = 0; w < boundary.walls.size(); ++w) {
      if (!boxes_[w].isEmpty()) boxes_[w].widen(touch_);
      const bool floats = w < spec.walls.size() && spec.walls[w].drive.by == Drive::By::body;
      is_floating_hull_.push_back(floats && is_hull(spec.walls[w]) ? 1 : 0);
      alone_.emplace_back(boundary.walls.size(), 0);
      alone_.back()[w] = 1;
    }
  }

  /// The other walls that take a part of a patch with this box.
  std::vector<int> others_at(const WallFace<Dim>& face, const Box<Dim>& box) const {
    std::vector<int> found;
    if (face.is_image || boundary_.walls[face.wall].is_plate) return found;
    const double radius = 0.5 * (box.max() - box.min()).norm() + touch_;
    for (int w = 0; w < std::ssize(boxes_); ++w) {
      const bool is_of_same_body = boundary_.walls[w].body == boundary_.walls[face.wall].body;
      if (w == face.wall || !is_of_same_body || boxes_[w].isEmpty() || !boxes_[w].intersects(box)) continue;
      const NearestWall<Dim> wall = nearest(w, face, 0.5 * (box.min() + box.max()), radius);
      if (wall.face >= 0 && wall.signed_distance < radius) found.push_back(w);
    }
    return found;
  }

  /// Whether another wall takes the place x of a face.
  bool is_taken(const WallFace<Dim>& face, const std::vector<int>& others, const Vec<Dim>& x) const {
    return std::ranges::any_of(others, [&](int other) {
      const NearestWall<Dim> wall = nearest(other, face, x, touch_);
      if (wall.face < 0 || wall.signed_distance > touch_) return false;
      if (wall.signed_distance < -touch_) return true;
      const Vec<Dim>& normal = boundary_.faces[wall.face].normal;
      if (normal.dot(face.normal) > 1.0 - corner_tolerance) return other < face.wall;
      const bool is_inside = wall.signed_distance < -corner_tolerance * touch_;
      return are_hulls(face.wall, other) && (is_inside || face_each_other<Dim>(normal, face.normal));
    });
  }

 private:
  bool are_hulls(int wall, int other) const { return is_floating_hull_[wall] != 0 && is_floating_hull_[other] != 0; }

  /// The place of another wall nearest to x. A place inside a hull may be far from its surface.
  NearestWall<Dim> nearest(int other, const WallFace<Dim>& face, const Vec<Dim>& x, double reach) const {
    return nearest_among<Dim>(boundary_, alone_[other], x,
                              are_hulls(face.wall, other) ? std::numeric_limits<double>::infinity() : reach);
  }

  const Boundary<Dim>& boundary_;
  double touch_;                                  ///< m
  std::vector<Box<Dim>> boxes_;                   ///< by wall, with what touches it; empty for plates
  std::vector<std::uint8_t> is_floating_hull_;    ///< by wall
  std::vector<std::vector<std::uint8_t>> alone_;  ///< for each wall, which walls it is
};

}  // namespace

template <int Dim>
std::vector<WallPatch<Dim>> outer_patches(const CaseSpec& spec, const Boundary<Dim>& boundary,
                                          const std::vector<WallPatch<Dim>>& patches) {
  const WallsOfBodies<Dim> walls(spec, boundary);
  std::vector<WallPatch<Dim>> outer;
  outer.reserve(patches.size());
  for (const WallPatch<Dim>& patch : patches) {
    const WallFace<Dim>& face = boundary.faces[patch.face];
    Box<Dim> box;
    for (int c = 0; c < Dim; ++c) box.extend(patch.corner(boundary, c));
    const std::vector<int> others = walls.others_at(face, box);
    if (others.empty()) {
      outer.push_back(patch);
      continue;
    }
    const std::vector<WallPatch<Dim>> pieces = pieces_of(patch, boundary, edge_of_pieces * spec.particles.spacing);
    std::vector<WallPatch<Dim>> kept;
    for (const WallPatch<Dim>& piece : pieces) {
      if (!walls.is_taken(face, others, piece.centre(boundary))) kept.push_back(piece);
    }
    if (kept.size() == pieces.size()) kept.assign(1, patch);
    outer.insert(outer.end(), kept.begin(), kept.end());
  }
  return outer;
}

TAILWATER_IN_2D_AND_3D(outer_patches);

}  // namespace tailwater
