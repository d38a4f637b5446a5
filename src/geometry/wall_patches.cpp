#include "geometry/wall_patches.h"

#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "geometry/from_spec.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

/// Relative rounding of an edge that is as long as the longest. A wall that has moved has as many patches as drawn.
constexpr double same_length = 1e-6;

template <int Dim>
void add_pieces(const WallPatch<Dim>& patch, const Boundary<Dim>& boundary, double longest,
                const FractionAt<Dim>& fraction_at, std::vector<WallPatch<Dim>>& pieces) {
  double length = (1.0 + same_length) * longest * (fraction_at ? fraction_at(patch.centre(boundary)) : 1.0);
  std::array<int, 2> edge{-1, -1};
  for (int a = 0; a < Dim; ++a) {
    for (int b = a + 1; b < Dim; ++b) {
      const double found = (patch.corner(boundary, a) - patch.corner(boundary, b)).norm();
      if (found <= length) continue;
      length = found;
      edge = {a, b};
    }
  }
  if (edge[0] < 0) {
    pieces.push_back(patch);
    return;
  }
  std::array<double, Dim> middle;
  for (int k = 0; k < Dim; ++k) middle[k] = 0.5 * (patch.corners[edge[0]][k] + patch.corners[edge[1]][k]);
  for (const int end : edge) {
    WallPatch<Dim> half = patch;
    half.corners[end] = middle;
    half.measure *= 0.5;
    add_pieces(half, boundary, longest, fraction_at, pieces);
  }
}

/// Throws CaseError for faces that make more than the most patches. Halves of a face have at least half of an edge's
/// length, so there are about as many as patches of `longest` cover it.
template <int Dim>
void require_few_patches(const Boundary<Dim>& boundary, double longest) {
  double patches = 0.0;
  std::vector<double> of_wall(boundary.walls.size(), 0.0);
  for (const WallFace<Dim>& face : boundary.faces) {
    const double of_face = std::max(1.0, face.measure() / std::pow(longest, Dim - 1));
    patches += of_face;
    of_wall[face.wall] += of_face;
  }
  if (patches <= max_wall_patches) return;
  const auto largest = std::ranges::max_element(of_wall);
  const auto wall = static_cast<int>(largest - of_wall.begin());
  Box<Dim> box;
  for (const WallFace<Dim>& face : boundary.faces) {
    if (face.wall == wall) box.extend(face.box());
  }
  throw CaseError("too-many-wall-patches",
                  {"{}, which reaches from {} to {}, has {:.3g} patches of {:.3g}, in which forces on walls are "
                   "computed, and a case has at most {:.3g}",
                   wall_label(boundary, wall), place<Dim>(box.min()), place<Dim>(box.max()), *largest,
                   Amount{longest, "m"}, max_wall_patches},
                  {"draw the wall no longer than the water can come, or use a larger spacing"});
}

}  // namespace

template <int Dim>
std::vector<WallPatch<Dim>> pieces_of(const WallPatch<Dim>& patch, const Boundary<Dim>& boundary, double longest) {
  std::vector<WallPatch<Dim>> pieces;
  add_pieces<Dim>(patch, boundary, longest, {}, pieces);
  return pieces;
}

template <int Dim>
std::vector<WallPatch<Dim>> make_wall_patches(const Boundary<Dim>& boundary, double longest,
                                              const FractionAt<Dim>& fraction_at) {
  require_few_patches(boundary, longest);
  std::vector<WallPatch<Dim>> patches;
  for (std::size_t f = 0; f < boundary.faces.size(); ++f) {
    WallPatch<Dim> whole{static_cast<int>(f), {}, boundary.faces[f].measure()};
    for (int c = 0; c < Dim; ++c) whole.corners[c][c] = 1.0;
    add_pieces(whole, boundary, longest, fraction_at, patches);
  }
  return patches;
}

TAILWATER_IN_2D_AND_3D(make_wall_patches);
TAILWATER_IN_2D_AND_3D(pieces_of);

}  // namespace tailwater
