#include "walls/wetted_patches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/for_each.h"
#include "geometry/facing.h"

namespace tailwater {
namespace {

/// dx; edge of the pieces of a patch that another wall cuts.
constexpr double edge_of_wet_pieces = 0.25;

/// dx; a place that is less far behind a wall lies on it. Water has no access to a place that is so near to a wall that
/// faces it.
constexpr double reach_of_cover = 0.05;

/// dx; edge of the pieces of a patch that a wall cuts which is no hull.
constexpr double edge_of_cut_pieces = 0.125;

/// dx; from a place of a wall into the space in front of it, so that it is beside the face of a wall that ends there,
/// and so that its own wall hides nothing.
constexpr double margin_on_wall = 0.01;
constexpr double margin_of_view = 0.1;

/// dx; no place of a patch is farther from its centre.
constexpr double radius_of_patches = 0.9;

constexpr double without_limit = std::numeric_limits<double>::infinity();

/// Fraction of a patch that is less than the rounding of its pieces.
constexpr double no_share = 1e-9;

}  // namespace

template <int Dim>
WettedPatches<Dim>::WettedPatches(const CaseSpec& spec, const Boundary<Dim>& boundary,
                                  std::vector<double> relative_spacing, double reach)
    : domain_(boundary.domain),
      spacing_(spec.particles.spacing),
      relative_spacing_(std::move(relative_spacing)),
      reach_(reach),
      is_hull_(boundary.walls.size(), 0) {
  Others rest{-1, std::vector<std::uint8_t>(boundary.walls.size(), 0)};
  for (std::size_t w = 0; w < spec.walls.size(); ++w) {
    if (spec.walls[w].drive.by == Drive::By::body || boundary.walls[w].is_plate) continue;
    if (!is_hull(spec.walls[w])) {
      rest.walls[w] = 1;
      continue;
    }
    is_hull_[w] = 1;
    others_.push_back({static_cast<int>(w), std::vector<std::uint8_t>(boundary.walls.size(), 0)});
    others_.back().walls[w] = 1;
  }
  open_others_.resize(boundary.walls.size());
  std::vector<std::uint8_t> are_open = rest.walls;
  for (std::size_t w = 0; w < are_open.size(); ++w)
    are_open[w] = are_open[w] != 0 && !boundary.walls[w].moves() ? 1 : 0;
  for (std::size_t w = 0; w < are_open.size(); ++w) {
    if (are_open[w] == 0) continue;
    open_others_[w] = are_open;
    open_others_[w][w] = 0;
  }
  if (!others_.empty()) others_.push_back(std::move(rest));
}

/// Finds the parts behind other walls of patches on walls at rest that are no hulls.
template <int Dim>
void WettedPatches<Dim>::find_behind_open(const Boundary<Dim>& boundary, std::span<const WallPatch<Dim>> patches) {
  is_behind_open_.assign(patches.size(), 0);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const WallFace<Dim>& face = boundary.faces[patches[k].face];
    const std::vector<std::uint8_t>& others = open_others_[face.wall];
    if (face.is_image || std::ranges::find(others, 1) == others.end()) continue;
    const double spacing = relative_spacing_[k] * spacing_;
    const auto height = [&](const Vec<Dim>& x) {
      const Vec<Dim> raised = x + margin_on_wall * spacing * face.normal;  // a wall that ends here has a side there
      const NearestWall<Dim> wall = nearest_among<Dim>(boundary, others, raised, without_limit);
      return wall.face < 0 ? without_limit : wall.signed_distance;
    };
    int behind = height(patches[k].centre(boundary)) < 0.0 ? 1 : 0;  // of the centre and the corners
    for (int c = 0; c < Dim; ++c) behind += height(patches[k].corner(boundary, c)) < 0.0 ? 1 : 0;
    if (behind == Dim + 1) is_behind_open_[k] = 1;
    if (behind == 0 || behind == Dim + 1) continue;
    double least = without_limit;
    Vec<Dim> farthest_behind;
    double largest = 0.0;
    Vec<Dim> farthest_in_front;
    OpenPart front{Vec<Dim>::Zero(), 0.0};
    double share_in_front = 0.0;  // of pieces whose centre is
    for (const WallPatch<Dim>& piece : pieces_of(patches[k], boundary, edge_of_cut_pieces * spacing)) {
      const Vec<Dim> x = piece.centre(boundary);
      const double height_of_piece = height(x);
      if (height_of_piece < least) {
        least = height_of_piece;
        farthest_behind = x;
      }
      if (height_of_piece > largest) {
        largest = height_of_piece;
        farthest_in_front = x;
      }
      const double edge = std::pow(piece.measure, 1.0 / (Dim - 1));
      const double share = std::clamp(0.5 + height_of_piece / edge, 0.0, 1.0) * piece.measure / patches[k].measure;
      front.share += share;
      if (height_of_piece <= 0.0) continue;
      share_in_front += share;
      front.centre += share / share_in_front * (x - front.centre);
    }
    if (largest == 0.0) {  // only an edge is in front, by rounding
      is_behind_open_[k] = 1;
      continue;
    }
    const Vec<Dim> forward = margin_of_view * spacing * face.normal;
    const bool is_cut = !sees(boundary, face.wall, farthest_in_front + forward, farthest_behind + forward);
    if (is_cut && front.share < 1.0 - no_share) beside_open_[k] = front;
  }
}

template <int Dim>
void WettedPatches<Dim>::place(const Boundary<Dim>& boundary, std::span<const WallPatch<Dim>> patches) {
  if (is_behind_open_.empty()) find_behind_open(boundary, patches);
  for (Others& other : others_) {
    other.around = {};
    for (const WallFace<Dim>& face : boundary.faces) {
      if (other.walls[face.wall] != 0) other.around.extend(face.box());
    }
    other.around.widen(other.hull < 0 ? 2.0 * reach_ : longest_patch_edge * spacing_);
  }
  centres_.resize(patches.size());
  share_.assign(patches.size(), 1.0);
  for_each(patches.size(), [&](std::size_t k) { find_part(boundary, patches[k], k); });
  grid_ = CellGrid<Dim>(centres_, reach_);
  around_ = {};
  for (const Vec<Dim>& centre : centres_) around_.extend(centre);
  around_.widen(reach_);
  if (take_covered(boundary, patches)) grid_ = CellGrid<Dim>(centres_, reach_);
  parts_.clear();
  for (const std::int32_t k : grid_.order()) {
    const Vec<Dim>& normal = boundary.faces[patches[k].face].normal;
    parts_.push_back({centres_[k], normal, share_[k] * patches[k].measure, k});
  }
}

/// Whether the places that wall lies on belong to it rather than to the other one: a hull stands on a wall that is
/// none, because all of its bottom is covered.
template <int Dim>
bool WettedPatches<Dim>::lies_on(int wall, int other) const {
  return std::pair(is_hull_[other], wall) < std::pair(is_hull_[wall], other);
}

/// By wall, whether some of it may lie on another one.
template <int Dim>
std::vector<std::uint8_t> WettedPatches<Dim>::find_covered_walls(const Boundary<Dim>& boundary) const {
  std::vector<Box<Dim>> boxes(boundary.walls.size());
  for (const WallFace<Dim>& face : boundary.faces) {
    if (!face.is_image) boxes[face.wall].extend(face.box());
  }
  std::vector<std::uint8_t> is_covered(boxes.size(), 0);
  for (int wall = 0; wall < std::ssize(boxes); ++wall) {
    if (boxes[wall].isEmpty()) continue;
    Box<Dim> around = boxes[wall];
    around.widen(reach_of_cover * spacing_);
    for (int other = 0; other < std::ssize(boxes); ++other) {
      if (boxes[other].isEmpty() || !lies_on(wall, other)) continue;
      if (around.intersects(boxes[other])) is_covered[wall] = 1;
      visit_images<Dim>(domain_, boxes[other], around, [&](const Vec<Dim>& /*by*/) { is_covered[wall] = 1; });
    }
  }
  return is_covered;
}

/// Patches that face patch k and may lie on it, in the order of their faces.
template <int Dim>
std::vector<std::int32_t> WettedPatches<Dim>::patches_facing(const Boundary<Dim>& boundary,
                                                             std::span<const WallPatch<Dim>> patches,
                                                             std::int32_t k) const {
  const WallFace<Dim>& own = boundary.faces[patches[k].face];
  const double radius = radius_of_patches * spacing_;
  const double cover = reach_of_cover * spacing_;
  std::vector<std::int32_t> facing;
  visit_images_of(centres_[k], [&](const Vec<Dim>& x) {
    grid_.for_each_range_near(x, x, 2.0 * radius + cover, [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t n = begin; n < end; ++n) {
        const std::int32_t m = grid_.order()[n];
        const WallFace<Dim>& face = boundary.faces[patches[m].face];
        if (!lies_on(own.wall, face.wall) || !face_each_other<Dim>(own.normal, face.normal)) continue;
        if (std::abs(face.height(x)) < radius + cover) facing.push_back(m);
      }
    });
  });
  std::ranges::sort(facing);
  return facing;
}

/// The patch on which a place lies, and the image of the place there; -1 if it lies on none.
template <int Dim>
std::pair<std::int32_t, Vec<Dim>> WettedPatches<Dim>::patch_under(const Boundary<Dim>& boundary,
                                                                  std::span<const WallPatch<Dim>> patches,
                                                                  const std::vector<std::int32_t>& facing,
                                                                  const Vec<Dim>& place) const {
  std::pair<std::int32_t, Vec<Dim>> nearest{-1, place};
  double least = std::numeric_limits<double>::infinity();
  visit_images_of(place, [&](const Vec<Dim>& x) {
    int looked_at = -1;
    bool is_on_face = false;
    for (const std::int32_t m : facing) {
      const int f = patches[m].face;
      if (f != looked_at) is_on_face = (closest_point(boundary.faces[f], x) - x).norm() < reach_of_cover * spacing_;
      looked_at = f;
      const double distance = (patches[m].centre(boundary) - x).norm();
      if (!is_on_face || share_[m] == 0.0 || distance >= least) continue;
      least = distance;
      nearest = {m, x};
    }
  });
  return nearest;
}

/// m; of a place on a hull above the hulls before it that face the same way there, and above all hulls that it is
/// behind. Infinite if there are none. Where hulls overlap, the wall below them is covered once.
template <int Dim>
double WettedPatches<Dim>::height_above_other_hulls(const Boundary<Dim>& boundary, const WallFace<Dim>& face,
                                                    const Vec<Dim>& x) const {
  double least = without_limit;
  for (const Others& other : others_) {
    if (other.hull < 0 || other.hull == face.wall || is_hull_[face.wall] == 0) continue;
    const NearestWall<Dim> wall = nearest(boundary, other, x);
    if (wall.face < 0) continue;
    const bool is_behind = wall.signed_distance < -reach_of_cover * spacing_;
    const bool is_alike = boundary.faces[wall.face].normal.dot(face.normal) > 1.0 - corner_tolerance;
    if (is_behind || (other.hull < face.wall && is_alike)) least = std::min(least, wall.signed_distance);
  }
  return least;
}

/// Takes what lies on another wall, such as the bottom of a block that stands on a bed, from the patches of both walls.
/// Returns whether a centre has moved.
template <int Dim>
bool WettedPatches<Dim>::take_covered(const Boundary<Dim>& boundary, std::span<const WallPatch<Dim>> patches) {
  bool has_moved = false;
  // Takes up to `measure` around x from patch k, and returns the rest.
  const auto take = [&](std::int32_t k, const Vec<Dim>& x, double measure) {
    const double before = share_[k];
    share_[k] -= measure / patches[k].measure;
    if (share_[k] < no_share) {
      const double excess = std::max(0.0, -share_[k] - no_share) * patches[k].measure;
      share_[k] = 0.0;
      return excess;
    }
    const Vec<Dim> centre = centres_[k] + (before / share_[k] - 1.0) * (centres_[k] - x);
    if ((centre - patches[k].centre(boundary)).norm() < radius_of_patches * spacing_) centres_[k] = centre;
    has_moved = true;
    return 0.0;
  };
  const std::vector<std::uint8_t> is_covered = find_covered_walls(boundary);
  for (std::int32_t k = 0; k < std::ssize(patches); ++k) {  // in order: several take from one patch
    if (share_[k] == 0.0 || is_covered[boundary.faces[patches[k].face].wall] == 0) continue;
    const std::vector<std::int32_t> facing = patches_facing(boundary, patches, k);
    if (facing.empty()) continue;
    for (const WallPatch<Dim>& piece :
         pieces_of(patches[k], boundary, edge_of_wet_pieces * relative_spacing_[k] * spacing_)) {
      const Vec<Dim> place = piece.centre(boundary);
      const double height = height_above_other_hulls(boundary, boundary.faces[patches[k].face], place);
      if (height < -reach_of_cover * spacing_) continue;  // left out already
      if (height <= reach_of_cover * spacing_) {
        take(k, place, piece.measure);
        continue;
      }
      double rest = piece.measure;
      while (rest > 0.0) {
        const auto [under, image] = patch_under(boundary, patches, facing, place);
        if (under < 0) break;
        rest = take(under, image, rest);
      }
      if (rest < piece.measure) take(k, place, piece.measure);
    }
  }
  return has_moved;
}

/// The wall of `others` nearest to x or to an image of it; none if they do not matter.
template <int Dim>
NearestWall<Dim> WettedPatches<Dim>::nearest(const Boundary<Dim>& boundary, const Others& others,
                                             const Vec<Dim>& x) const {
  NearestWall<Dim> nearest;
  const auto look_from = [&](const Vec<Dim>& from) {
    const NearestWall<Dim> seen = nearest_among<Dim>(boundary, others.walls, from, 2.0 * reach_);
    const bool is_nearer = nearest.face < 0 || std::abs(seen.signed_distance) < std::abs(nearest.signed_distance);
    if (seen.face >= 0 && is_nearer) nearest = seen;
  };
  if (others.around.contains(x)) look_from(x);
  visit_images<Dim>(domain_, Box<Dim>(x), others.around, [&](const Vec<Dim>& by) { look_from(x + by); });
  return nearest;
}

template <int Dim>
void WettedPatches<Dim>::find_part(const Boundary<Dim>& boundary, const WallPatch<Dim>& patch, std::size_t k) {
  const int wall = boundary.faces[patch.face].wall;
  const Vec<Dim> centre = patch.centre(boundary);
  centres_[k] = centre;
  if (boundary.faces[patch.face].is_image) {  // the face itself stands for it
    share_[k] = 0.0;
    return;
  }
  if (const auto cut = beside_open_.find(k); cut != beside_open_.end()) {
    share_[k] = cut->second.share;
    centres_[k] = cut->second.centre;
    return;
  }
  const double spacing = relative_spacing_[k] * spacing_;
  const double size = longest_patch_edge * spacing;
  std::vector<const Others*> cutting;
  for (const Others& other : others_) {
    const bool is_alone = other.hull < 0 ? is_hull_[wall] == 0 : other.hull == wall;
    if (is_alone) continue;
    const NearestWall<Dim> wall_there = nearest(boundary, other, centre);
    if (wall_there.face < 0 || wall_there.signed_distance > size) continue;
    if (wall_there.signed_distance < -size) share_[k] = 0.0;
    cutting.push_back(&other);
  }
  if (cutting.empty() || share_[k] == 0.0) return;
  const auto is_behind = [&](const Vec<Dim>& x) {
    return std::ranges::any_of(cutting, [&](const Others* other) {
      return nearest(boundary, *other, x).signed_distance < -reach_of_cover * spacing_;
    });
  };
  int behind = is_behind(centre) ? 1 : 0;  // of the centre and the corners
  for (int c = 0; c < Dim; ++c) behind += is_behind(patch.corner(boundary, c)) ? 1 : 0;
  if (behind == Dim + 1) share_[k] = 0.0;
  if (behind == 0 || behind == Dim + 1) return;
  double wet = 0.0;
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (const WallPatch<Dim>& piece : pieces_of(patch, boundary, edge_of_wet_pieces * spacing)) {
    const Vec<Dim> x = piece.centre(boundary);
    if (is_behind(x)) continue;
    wet += piece.measure;
    sum += piece.measure * x;
  }
  share_[k] = wet / patch.measure;
  if (wet > 0.0) centres_[k] = sum / wet;
}

template class WettedPatches<2>;
template class WettedPatches<3>;

}  // namespace tailwater
